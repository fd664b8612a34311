#include "surface/search_set.h"

#include "surface/box_tree.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

namespace hex {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;

Kernel::Point_3 to_cgal(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}
Kernel::Triangle_3 to_cgal(const SearchTriangle& t) {
    return {to_cgal(t[0]), to_cgal(t[1]), to_cgal(t[2])};
}
Kernel::Segment_3 to_cgal(const SearchSegment& s) {
    return {to_cgal(s[0]), to_cgal(s[1])};
}

/// Across each side of an item the other one with that side (the ends of a segment are its sides); the item
/// itself where there is none, and one of them where there are several.
template <std::size_t Corners>
std::vector<std::array<std::uint32_t, Corners>> find_neighbours(
    const std::vector<std::array<Vec3, Corners>>& items) {
    struct Side {
        std::array<std::array<double, 3>, Corners - 1> points;
        std::uint32_t item;
        std::uint32_t number;
    };
    std::vector<Side> sides;
    sides.reserve(items.size() * Corners);
    std::vector<std::array<std::uint32_t, Corners>> neighbours(items.size());
    for (std::uint32_t t = 0; t < items.size(); ++t) {
        neighbours[t].fill(t);
        for (std::uint32_t i = 0; i < Corners; ++i) {
            Side side{{}, t, i};
            for (std::size_t k = 0; k + 1 < Corners; ++k) {
                const Vec3& p = items[t][(i + k) % Corners];
                side.points[k] = {p.x(), p.y(), p.z()};
            }
            std::sort(side.points.begin(), side.points.end());
            sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.points, a.item, a.number) < std::tie(b.points, b.item, b.number);
    });
    for (std::size_t i = 1; i < sides.size(); ++i) {
        const Side& a = sides[i - 1];
        const Side& b = sides[i];
        if (a.points != b.points) continue;
        neighbours[a.item][a.number] = b.item;
        neighbours[b.item][b.number] = a.item;
    }
    return neighbours;
}

/// Goes through a whole tree and lists the items from left to right.
template <class Node, class Primitive>
struct Listing {
    std::vector<typename Primitive::Id>& items;

    constexpr bool go_further() const { return true; }
    template <class Query>
    void intersection(const Query&, const Primitive& item) {
        items.push_back(item.id());
    }
    template <class Query>
    constexpr bool do_intersect(const Query&, const Node&) const {
        return true;
    }
};

}  // namespace

template <std::size_t Corners>
struct ItemSearch<Corners>::Tree {
    using CgalItem = std::conditional_t<Corners == 3, Kernel::Triangle_3, Kernel::Segment_3>;
    using Iterator = typename std::vector<CgalItem>::const_iterator;
    using Primitive =
        std::conditional_t<Corners == 3, CGAL::AABB_triangle_primitive<Kernel, Iterator, CGAL::Tag_false>,
                           CGAL::AABB_segment_primitive<Kernel, Iterator, CGAL::Tag_false>>;
    using Traits = CGAL::AABB_traits<Kernel, Primitive>;

    std::vector<CgalItem> items;
    CGAL::AABB_tree<Traits> tree;
    std::vector<std::uint32_t> number;                           ///< of the items in the order of the tree
    std::vector<std::uint32_t> place;                            ///< in that order, of each item
    std::vector<std::array<std::uint32_t, Corners>> neighbours;  ///< in that order
    std::optional<BoxTree<Corners>> boxes;                       ///< of the same structure

    Answer answer(const typename BoxTree<Corners>::Best& found) const {
        return {found.point, number[found.item]};
    }
    /// The items as they are in the tree from left to right.
    std::vector<Iterator> in_order() const {
        std::vector<Iterator> order;
        order.reserve(items.size());
        Listing<CGAL::AABB_node<Traits>, Primitive> listing{order};
        tree.traversal(Kernel::Point_3(), listing);
        return order;
    }
};

template <std::size_t Corners>
ItemSearch<Corners>::ItemSearch(const std::vector<Item>& items) : tree_(std::make_unique<Tree>()) {
    tree_->items.reserve(items.size());
    for (const Item& item : items) tree_->items.push_back(to_cgal(item));
    tree_->tree.insert(tree_->items.begin(), tree_->items.end());
    tree_->tree.build();
    tree_->place.resize(items.size());
    std::vector<Item> ordered;
    ordered.reserve(items.size());
    for (const auto& item : tree_->in_order()) {
        const auto number = static_cast<std::uint32_t>(item - tree_->items.begin());
        tree_->place[number] = static_cast<std::uint32_t>(ordered.size());
        tree_->number.push_back(number);
        ordered.push_back(items[number]);
    }
    tree_->neighbours.resize(items.size());
    const auto neighbours = find_neighbours(items);
    for (std::size_t t = 0; t < items.size(); ++t)
        for (std::size_t i = 0; i < Corners; ++i)
            tree_->neighbours[tree_->place[t]][i] = tree_->place[neighbours[t][i]];
    tree_->boxes.emplace(std::move(ordered));
}

template <std::size_t Corners>
ItemSearch<Corners>::~ItemSearch() = default;

template <std::size_t Corners>
typename ItemSearch<Corners>::Answer ItemSearch<Corners>::closest(const Vec3& p,
                                                                  std::optional<std::uint32_t> hint,
                                                                  Memory* memory) const {
    // From neighbour to neighbour while that leads closer; what is found bounds the search in the tree.
    constexpr int most_steps = 32;
    constexpr std::uint32_t none = BoxTree<Corners>::none;
    const std::vector<Item>& items = tree_->boxes->items();
    const std::uint32_t start =
        hint ? *hint
             : static_cast<std::uint32_t>(tree_->tree.best_hint(to_cgal(p)).second - tree_->items.begin());
    typename BoxTree<Corners>::Best best;
    best.item = tree_->place[start];
    best.point = nearest_point_of(items[best.item], p);
    best.squared = (best.point - p).squaredNorm();
    std::uint32_t before = none;
    for (int step = 0; step < most_steps; ++step) {
        const std::uint32_t from = best.item;
        best.farther.fill(none);
        for (std::size_t i = 0; i < Corners; ++i) {
            const std::uint32_t next = tree_->neighbours[from][i];
            if (next == from) continue;
            if (next == before) {
                best.farther[i] = next;
                continue;
            }
            const Vec3 candidate = nearest_point_of(items[next], p);
            const double squared = (candidate - p).squaredNorm();
            if (squared > best.squared) best.farther[i] = next;
            if (!(squared < best.squared)) continue;
            best.squared = squared;
            best.point = candidate;
            best.item = next;
        }
        if (best.item == from) break;
        before = from;
    }
    if (memory != nullptr && tree_->boxes->is_found(p, best, memory->near_)) {
        ++memory->hits_;
        return tree_->answer(best);
    }
    tree_->boxes->search(p, best);
    if (memory != nullptr) remember(p, best, *memory);
    return tree_->answer(best);
}

template <std::size_t Corners>
void ItemSearch<Corners>::remember(const Vec3& p, const typename BoxTree<Corners>::Best& best,
                                   Memory& memory) const {
    if (memory.rest_ > 0) {
        --memory.rest_;
        return;
    }
    // Rarer where it is of no use.
    constexpr int most_rest = 15;
    memory.rest_ = memory.last_rest_ = memory.hits_ > 0 ? 0 : std::min(2 * memory.last_rest_ + 1, most_rest);
    memory.hits_ = 0;
    const Item& item = tree_->boxes->items()[best.item];
    double length = 0.0;
    for (std::size_t i = 0; i < Corners; ++i)
        length = std::max(length, (item[(i + 1) % Corners] - item[i]).norm());
    tree_->boxes->list_near(p, std::sqrt(best.squared) + length, memory.near_);
}

template <std::size_t Corners>
std::optional<typename ItemSearch<Corners>::Answer> ItemSearch<Corners>::closest_within(const Vec3& p,
                                                                                        double radius) const {
    typename BoxTree<Corners>::Best best;
    best.point = Vec3(p.x() + radius, p.y(), p.z());
    best.squared = (best.point - p).squaredNorm();
    tree_->boxes->search(p, best);
    if (best.item == BoxTree<Corners>::none) return {};
    return tree_->answer(best);
}

template class ItemSearch<3>;
template class ItemSearch<2>;

}  // namespace hex
