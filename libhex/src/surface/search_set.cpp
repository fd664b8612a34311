#include "surface/search_set.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

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
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;

    Answer answer(const Found& found) const {
        return {{found.first.x(), found.first.y(), found.first.z()},
                static_cast<std::uint32_t>(found.second - items.begin())};
    }
};

template <std::size_t Corners>
ItemSearch<Corners>::ItemSearch(const std::vector<Item>& items) : tree_(std::make_unique<Tree>()) {
    tree_->items.reserve(items.size());
    for (const Item& item : items) tree_->items.push_back(to_cgal(item));
    tree_->tree.insert(tree_->items.begin(), tree_->items.end());
    tree_->tree.build();
}

template <std::size_t Corners>
ItemSearch<Corners>::~ItemSearch() = default;

template <std::size_t Corners>
typename ItemSearch<Corners>::Answer ItemSearch<Corners>::closest(const Vec3& p, std::uint32_t hint) const {
    const auto start = std::as_const(tree_->items).begin() + static_cast<std::ptrdiff_t>(hint);
    const Kernel::Point_3 query = to_cgal(p);
    const Kernel::Point_3 nearby = Kernel().construct_projected_point_3_object()(*start, query);
    return tree_->answer(tree_->tree.closest_point_and_primitive(query, std::pair(nearby, start)));
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
