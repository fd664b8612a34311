/// \file voxel_grid.h
/// An axis-aligned grid with uneven spacing, and how much of each of its cells is inside a closed surface.
#pragma once

#include <hex/base/linear_algebra.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace hex::voxels {

/// Numbers of a cell along x, y, z.
using Cell = std::array<int, 3>;

/// A grid with one layer of cells more on each side than the surface needs.
struct Grid {
    std::array<std::vector<double>, 3> planes;  ///< ascending
    std::array<int, 3> aligned = {0, 0, 0};     ///< planes that lie on flat faces of the surface

    int count(std::size_t axis) const { return static_cast<int>(planes[axis].size()) - 1; }
    std::size_t cell_count() const {
        return static_cast<std::size_t>(count(0)) * static_cast<std::size_t>(count(1)) *
               static_cast<std::size_t>(count(2));
    }
    std::size_t index(const Cell& c) const {
        return static_cast<std::size_t>(c[0]) +
               planes_less_one(0) *
                   (static_cast<std::size_t>(c[1]) + planes_less_one(1) * static_cast<std::size_t>(c[2]));
    }
    Cell cell(std::size_t index) const {
        return {static_cast<int>(index % planes_less_one(0)),
                static_cast<int>(index / planes_less_one(0) % planes_less_one(1)),
                static_cast<int>(index / planes_less_one(0) / planes_less_one(1))};
    }
    /// Grid nodes are numbered in the same way, with one more along each axis.
    std::size_t node_index(const Cell& n) const {
        return static_cast<std::size_t>(n[0]) +
               planes[0].size() *
                   (static_cast<std::size_t>(n[1]) + planes[1].size() * static_cast<std::size_t>(n[2]));
    }
    std::size_t node_count() const { return planes[0].size() * planes[1].size() * planes[2].size(); }
    Vec3 node(const Cell& n) const {
        return {planes[0][static_cast<std::size_t>(n[0])], planes[1][static_cast<std::size_t>(n[1])],
                planes[2][static_cast<std::size_t>(n[2])]};
    }
    /// The cell that a point within the grid lies in.
    Cell find(const Vec3& p) const;

  private:
    std::size_t planes_less_one(std::size_t axis) const { return planes[axis].size() - 1; }
};

/// Cells of about the given size over the bounding box of the surface.
Grid make_grid(const TriangleMesh& surface, double size);

/// Where the line along x through a point (y, z) meets a triangle, if it does. For a closed surface the
/// number of meetings is even: a line through an edge or a vertex is moved by infinitely little (exact
/// predicates).
std::optional<double> crossing(const std::array<Vec3, 3>& triangle, const Vec2& line);

/// Samples along an axis of each cell.
inline constexpr int samples_per_axis = 3;
inline constexpr int samples_per_cell = samples_per_axis * samples_per_axis * samples_per_axis;

/// Of the samples of each cell, how many are inside: see an odd number of triangles along +x. Exact but for
/// samples on the surface itself up to rounding.
std::vector<std::uint8_t> samples_inside(const Grid& grid, const TriangleMesh& surface);

}  // namespace hex::voxels
