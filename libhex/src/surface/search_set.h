/// \file search_set.h
/// Triangles or segments with a tree in which the one closest to a point is found.
#pragma once

#include <hex/base/linear_algebra.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace hex {

/// The structure of CGAL's AABB tree. Exact up to rounding; O(log n) a query for points near the items. Queries are
/// thread-safe.
template <std::size_t Corners>
class ItemSearch {
  public:
    using Item = std::array<Vec3, Corners>;
    /// At least one item; their numbers are the places in the vector.
    explicit ItemSearch(const std::vector<Item>& items);
    ~ItemSearch();
    ItemSearch(const ItemSearch&) = delete;
    ItemSearch& operator=(const ItemSearch&) = delete;

    struct Answer {
        Vec3 point;
        std::uint32_t item;
    };
    /// Closest point to p. The search starts from item `hint`, and is fastest when that is near the answer;
    /// without, a second tree, made when it is first needed, gives a good start.
    Answer closest(const Vec3& p, std::optional<std::uint32_t> hint = {}) const;
    /// Closest point to p, if it is nearer than `radius`. Much faster than `closest` from a bad start.
    std::optional<Answer> closest_within(const Vec3& p, double radius) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

using SearchTriangle = std::array<Vec3, 3>;
using SearchSegment = std::array<Vec3, 2>;
using TriangleSearch = ItemSearch<3>;
using SegmentSearch = ItemSearch<2>;

}  // namespace hex
