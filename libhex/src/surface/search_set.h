/// \file search_set.h
/// Triangles or segments with CGAL's search tree. Include only in .cpp files (CGAL is heavy).
#pragma once

#include <hex/base/linear_algebra.h>

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace hex {

using SearchKernel = CGAL::Simple_cartesian<double>;

/// Not movable: the tree points into `items`.
template <class Item, template <class, class, class> class Primitive>
class ItemSearch {
  public:
    explicit ItemSearch(std::vector<Item> items) : items_(std::move(items)) {
        tree_.insert(items_.begin(), items_.end());
        tree_.build();
    }
    ItemSearch(const ItemSearch&) = delete;
    ItemSearch& operator=(const ItemSearch&) = delete;

    struct Answer {
        Vec3 point;
        std::uint32_t item;
    };
    /// Closest point to p; the search starts from item `hint`.
    Answer closest(const Vec3& p, std::uint32_t hint) const {
        const Iterator start = items_.begin() + static_cast<std::ptrdiff_t>(hint);
        const SearchKernel::Point_3 query(p.x(), p.y(), p.z());
        const auto nearby = SearchKernel().construct_projected_point_3_object()(*start, query);
        const auto found = tree_.closest_point_and_primitive(query, std::pair(nearby, start));
        return {{found.first.x(), found.first.y(), found.first.z()},
                static_cast<std::uint32_t>(found.second - items_.begin())};
    }

    /// Closest point to p, if it is nearer than `radius`. Much faster than `closest` from a bad start.
    std::optional<Answer> closest_within(const Vec3& p, double radius) const {
        const SearchKernel::Point_3 query(p.x(), p.y(), p.z());
        const SearchKernel::Point_3 limit(p.x() + radius, p.y(), p.z());
        const auto found = tree_.closest_point_and_primitive(query, std::pair(limit, items_.begin()));
        if (found.first == limit) return {};
        return Answer{{found.first.x(), found.first.y(), found.first.z()},
                      static_cast<std::uint32_t>(found.second - items_.begin())};
    }

  private:
    using Iterator = typename std::vector<Item>::const_iterator;
    using Tree =
        CGAL::AABB_tree<CGAL::AABB_traits<SearchKernel, Primitive<SearchKernel, Iterator, CGAL::Tag_false>>>;
    std::vector<Item> items_;
    Tree tree_;
};
using TriangleSearch = ItemSearch<SearchKernel::Triangle_3, CGAL::AABB_triangle_primitive>;
using SegmentSearch = ItemSearch<SearchKernel::Segment_3, CGAL::AABB_segment_primitive>;

inline SearchKernel::Point_3 to_search_point(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

}  // namespace hex
