#include "surface/search_set.h"

#include "surface/nearest_point.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
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
Vec3 from_cgal(const Kernel::Point_3& p) {
    return {p.x(), p.y(), p.z()};
}

Vec3 nearest(const Vec3& p, const Kernel::Triangle_3& t) {
    const std::array<Vec3, 3> corners = {from_cgal(t[0]), from_cgal(t[1]), from_cgal(t[2])};
    const NearestPoint found = nearest_on_triangle(p, corners[0], corners[1], corners[2]);
    return found.shares[0] * corners[0] + found.shares[1] * corners[1] + found.shares[2] * corners[2];
}
Vec3 nearest(const Vec3& p, const Kernel::Segment_3& s) {
    const std::array<Vec3, 2> ends = {from_cgal(s[0]), from_cgal(s[1])};
    const NearestPoint found = nearest_on_segment(p, ends[0], ends[1]);
    return found.shares[0] * ends[0] + found.shares[1] * ends[1];
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

/// CGAL's traits with plainer arithmetic for what a query spends its time in: without these two the search
/// takes twice as long.
template <class Primitive>
struct Traits : CGAL::AABB_traits<Kernel, Primitive> {
    struct Closest_point {
        Kernel::Point_3 operator()(const Kernel::Point_3& p, const Primitive& item,
                                   const Kernel::Point_3& bound) const {
            const Vec3 query = from_cgal(p);
            const Vec3 found = nearest(query, item.datum());
            return (found - query).squaredNorm() <= (from_cgal(bound) - query).squaredNorm() ? to_cgal(found)
                                                                                             : bound;
        }
    };
    Closest_point closest_point_object() const { return {}; }

    struct Compare_distance {
        /// Whether the box is as near as the bound.
        CGAL::Comparison_result operator()(const Kernel::Point_3& p, const CGAL::Bbox_3& box,
                                           const Kernel::Point_3& bound) const {
            const auto outside = [](double low, double x, double high) {
                return std::max(std::max(low - x, x - high), 0.0);
            };
            const Vec3 off(outside(box.xmin(), p.x(), box.xmax()), outside(box.ymin(), p.y(), box.ymax()),
                           outside(box.zmin(), p.z(), box.zmax()));
            return off.squaredNorm() <= (from_cgal(bound) - from_cgal(p)).squaredNorm() ? CGAL::SMALLER
                                                                                        : CGAL::LARGER;
        }
    };
    Compare_distance compare_distance_object() const { return {}; }
};

}  // namespace

template <std::size_t Corners>
struct ItemSearch<Corners>::Tree {
    using CgalItem = std::conditional_t<Corners == 3, Kernel::Triangle_3, Kernel::Segment_3>;
    using Iterator = typename std::vector<CgalItem>::const_iterator;
    using Primitive =
        std::conditional_t<Corners == 3, CGAL::AABB_triangle_primitive<Kernel, Iterator, CGAL::Tag_false>,
                           CGAL::AABB_segment_primitive<Kernel, Iterator, CGAL::Tag_false>>;
    using Found = std::pair<Kernel::Point_3, Iterator>;

    std::vector<CgalItem> items;
    std::vector<std::array<std::uint32_t, Corners>> neighbours;
    CGAL::AABB_tree<Traits<Primitive>> tree;

    Answer answer(const Found& found) const {
        return {{found.first.x(), found.first.y(), found.first.z()},
                static_cast<std::uint32_t>(found.second - items.begin())};
    }
};

template <std::size_t Corners>
ItemSearch<Corners>::ItemSearch(const std::vector<Item>& items) : tree_(std::make_unique<Tree>()) {
    tree_->items.reserve(items.size());
    for (const Item& item : items) tree_->items.push_back(to_cgal(item));
    tree_->neighbours = find_neighbours(items);
    tree_->tree.insert(tree_->items.begin(), tree_->items.end());
    tree_->tree.build();
}

template <std::size_t Corners>
ItemSearch<Corners>::~ItemSearch() = default;

template <std::size_t Corners>
typename ItemSearch<Corners>::Answer ItemSearch<Corners>::closest(const Vec3& p,
                                                                  std::optional<std::uint32_t> hint) const {
    // From neighbour to neighbour while that leads closer; what is found bounds the search in the tree.
    constexpr int most_steps = 32;
    std::uint32_t item =
        hint ? *hint
             : static_cast<std::uint32_t>(tree_->tree.best_hint(to_cgal(p)).second - tree_->items.begin());
    Vec3 foot = nearest(p, tree_->items[item]);
    double least = (foot - p).squaredNorm();
    for (int step = 0; step < most_steps; ++step) {
        const std::uint32_t from = item;
        for (const std::uint32_t next : tree_->neighbours[from]) {
            const Vec3 candidate = nearest(p, tree_->items[next]);
            const double squared = (candidate - p).squaredNorm();
            if (!(squared < least)) continue;
            least = squared;
            foot = candidate;
            item = next;
        }
        if (item == from) break;
    }
    const auto start = std::as_const(tree_->items).begin() + static_cast<std::ptrdiff_t>(item);
    return tree_->answer(
        tree_->tree.closest_point_and_primitive(to_cgal(p), std::pair(to_cgal(foot), start)));
}

template <std::size_t Corners>
std::optional<typename ItemSearch<Corners>::Answer> ItemSearch<Corners>::closest_within(const Vec3& p,
                                                                                        double radius) const {
    const Kernel::Point_3 limit(p.x() + radius, p.y(), p.z());
    const auto found = tree_->tree.closest_point_and_primitive(
        to_cgal(p), std::pair(limit, std::as_const(tree_->items).begin()));
    if (found.first == limit) return {};
    return tree_->answer(found);
}

template class ItemSearch<3>;
template class ItemSearch<2>;

}  // namespace hex
