/// \file large_polygon.h
/// Triangles of polygons with very many corners.
#pragma once

#include <hex/base/linear_algebra.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace hex::surface {

/// Polygons with more corners than this are split by triangles_of_large_polygon.
inline constexpr std::size_t large_polygon = 1000;

/// The corners of the triangles, as indices into `points`, oriented as the polygon is: the constrained
/// Delaunay triangulation of its projection along the axis nearest to its normal (Chew, *Constrained Delaunay
/// triangulations*, Algorithmica 4, 1989), O(n log n) where the sides do not cross many Delaunay triangles.
/// Always the same for the same points. Empty when the projection has no area, touches or crosses itself.
std::vector<std::array<std::size_t, 3>> triangles_of_large_polygon(std::span<const Vec3> points);

}  // namespace hex::surface
