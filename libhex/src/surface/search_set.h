/// \file search_set.h
/// Triangles or segments with a tree in which the one closest to a point is found.
#pragma once

#include "surface/box_tree.h"

#include <hex/base/linear_algebra.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace hex {

/// The structure of CGAL's AABB tree. Exact up to rounding; O(log n) a query for points near the items.
/// Queries are thread-safe.
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
    /// Of a point that moves little by little: what was near it at the last search.
    class Memory {
        friend class ItemSearch;
        typename BoxTree<Corners>::Near near_;
        int hits_ = 0;  ///< searches that it has spared
        int rest_ = 0;  ///< searches before something is remembered again
        int last_rest_ = 0;
    };
    /// Closest point to p. The search starts from item `hint`, and is fastest when that is near the answer;
    /// without, a second tree, made when it is first needed, gives a good start.
    /// A memory, always of the same search, spares most of the work, and changes nothing.
    Answer closest(const Vec3& p, std::optional<std::uint32_t> hint = {}, Memory* memory = nullptr) const;
    /// Closest point to p, if it is nearer than `radius`. Much faster than `closest` from a bad start.
    std::optional<Answer> closest_within(const Vec3& p, double radius) const;

  private:
    void remember(const Vec3& p, const typename BoxTree<Corners>::Best& best, Memory& memory) const;

    struct Tree;
    std::unique_ptr<Tree> tree_;
};

using SearchTriangle = std::array<Vec3, 3>;
using SearchSegment = std::array<Vec3, 2>;
using TriangleSearch = ItemSearch<3>;
using SegmentSearch = ItemSearch<2>;

}  // namespace hex
