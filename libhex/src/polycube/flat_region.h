/// \file flat_region.h
/// A region of triangles flattened into the plane with its boundary fixed.
#pragma once

#include <hex/surface/mesh_types.h>

#include <vector>

namespace hex {

/// Places the vertices of `faces` that are not `fixed` by a discrete harmonic map: with cotangent weights,
/// and when a triangle comes out flipped (exact predicate) with mean-value, then with uniform weights. `uv`
/// and `fixed` are indexed by the vertices of the mesh; `uv` holds the boundary. Returns whether all
/// triangles are counter-clockwise.
///
/// With a convex boundary, and no inner edge that joins two vertices on one straight part of it, positive
/// weights always succeed but for rounding (Tutte 1963, Floater 2003); with another boundary they often do.
bool flatten_region(const TriangleMesh& mesh, const std::vector<TriangleMesh::FaceHandle>& faces,
                    const std::vector<char>& fixed, std::vector<Vec2>& uv);

/// The triangle is counter-clockwise in the plane, by an exact predicate.
bool counter_clockwise(const Vec2& a, const Vec2& b, const Vec2& c);

/// 1, 0 or -1 for c to the left of, on, or to the right of the line from a to b, by an exact predicate.
int side_of_line(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace hex
