/// \file box_tree.h
/// A binary tree of boxes around triangles or segments, laid out for searches that start near the answer: a
/// second layout of the tree that CGAL builds (search_set.h), with the same answers. Improvement asks for
/// millions of closest points, each near the one before; CGAL's own traversal, which takes no account of
/// that, made them about a third of its time.
#pragma once

#include "surface/nearest_point.h"

#include <hex/base/linear_algebra.h>

#include <array>
#include <cstdint>
#include <vector>

namespace hex {

[[gnu::flatten]] inline Vec3 nearest_point_of(const std::array<Vec3, 3>& triangle, const Vec3& p) {
    const auto& [a, b, c] = triangle;
    const NearestPoint found = nearest_on_triangle(p, a, b, c);
    return found.shares[0] * a + found.shares[1] * b + found.shares[2] * c;
}
[[gnu::flatten]] inline Vec3 nearest_point_of(const std::array<Vec3, 2>& segment, const Vec3& p) {
    const auto& [a, b] = segment;
    const NearestPoint found = nearest_on_segment(p, a, b);
    return found.shares[0] * a + found.shares[1] * b;
}

/// The items in the order of the tree: of n items the first n / 2 are on the left, down to pairs; three are
/// one and a pair. The boxes of four grandchildren, and those of the items of a leaf, stand side by side.
template <std::size_t Corners>
class BoxTree {
  public:
    using Item = std::array<Vec3, Corners>;
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// At least one item.
    explicit BoxTree(std::vector<Item> items);

    const std::vector<Item>& items() const { return items_; }

    struct Best {
        Vec3 point;
        double squared;                                             ///< distance to it
        std::uint32_t item = none;                                  ///< that has the point
        std::array<std::uint32_t, 3> farther = {none, none, none};  ///< items known to be farther
        bool knows(std::uint32_t other) const {
            return other == item || other == farther[0] || other == farther[1] || other == farther[2];
        }
    };
    /// Goes from left to right through what is as near as the best point so far: of points that are equally
    /// near the last is taken. An item is not looked at when its own box is clearly farther.
    void search(const Vec3& p, Best& best) const;

    /// Items near a point.
    struct Near {
        static constexpr std::size_t most = 16;
        Vec3 centre = Vec3::Zero();
        double clear = 0.0;  ///< all other items are at least so far from it
        struct Item {
            float distance;  ///< at least
            std::uint32_t item;
        };
        std::array<Item, most> items;  ///< nearest first
        std::size_t count = 0;
    };
    /// The items whose boxes are nearer than `radius`, at most so many.
    void list_near(const Vec3& p, double radius, Near& near) const;
    /// Whether `best`, at which a search would start, is what it would find, by what is known of the items
    /// near; false when that does not tell.
    bool is_found(const Vec3& p, const Best& best, const Near& near) const;

  private:
    /// Boxes side by side.
    struct Four {
        std::array<std::array<double, 4>, 3> low{};
        std::array<std::array<double, 4>, 3> high{};
        std::array<std::uint32_t, 4> content{};  ///< of a box in the tree: node or ~leaf; in a leaf: item
        std::uint32_t count = 0;
    };
    struct Box {
        Vec3 low, high;
    };
    Box box_of(std::size_t first, std::size_t count) const;
    static double squared_distance(const Box& box, const Vec3& p);
    static void put(Four& four, const Box& box, std::uint32_t content);
    std::uint32_t make_node(std::size_t first, std::size_t count);
    std::uint32_t make_leaf(std::size_t first, std::size_t count);
    void search_leaf(const Four& leaf, const Vec3& p, Best& best) const;

    std::vector<Item> items_;
    double rounding_ = 0.0;  ///< larger than any error of a computed point
    std::vector<Four> nodes_;
    std::vector<Four> leaves_;
};

}  // namespace hex
