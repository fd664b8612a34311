/// \file polygon_soup.h
/// A surface as a file holds it: points and polygons, nothing known yet about how they hang together.
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/base/linear_algebra.h>
#include <hex/surface/mesh_types.h>

#include <cstdint>
#include <span>
#include <vector>

namespace hex {

/// Points and polygons with part ids. Polygon f has the corners `corners[i]` for i in [`offsets[f]`,
/// `offsets[f + 1]`), counter-clockwise seen from outside. All corner indices are < points.size().
struct PolygonSoup {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> corners;
    std::vector<std::size_t> offsets = {0};
    /// One part id a polygon; 1 where the format has none.
    std::vector<int> parts;

    std::size_t size() const { return offsets.size() - 1; }
    std::span<const std::uint32_t> polygon(std::size_t f) const {
        return {corners.data() + offsets[f], offsets[f + 1] - offsets[f]};
    }
    void add_polygon(std::span<const std::uint32_t> polygon, int part = 1);
};

/// What a surface must be to be accepted.
struct SurfaceRequirements {
    bool closed = true;  ///< no boundary edge
};

/// Polygon mesh of a soup; vertex and face indices are kept.
/// Throws Error{bad_input} naming the place (0-based vertex and polygon ids) for: no faces, degenerate
/// polygons (a vertex twice), edges with more than two faces, neighbours oriented against each other, inner
/// vertices with two faces only, vertices where the surface only touches itself, and boundary edges when
/// `requirements.closed`.
PolyMesh make_poly_mesh(const PolygonSoup& soup, const SurfaceRequirements& requirements = {});

/// Triangles of a polygon mesh by CGAL's constrained hole-free triangulation of each face
/// (Polygon_mesh_processing). A triangle stays as it is; the triangles of one polygon are consecutive, in the
/// order of the polygons, and carry its `part` and its index as `source`. Throws Error{bad_input} naming a
/// polygon that cannot be triangulated.
TriangleMesh triangulate(const PolyMesh& mesh);

/// make_poly_mesh, then triangulate.
TriangleMesh make_triangle_mesh(const PolygonSoup& soup, const SurfaceRequirements& requirements = {});

/// The triangles back as a soup, with their parts.
PolygonSoup to_soup(const TriangleMesh& mesh);
PolygonSoup to_soup(const PolyMesh& mesh);

/// The connected component of each triangle, through shared edges, numbered in the order of their first
/// triangles; `count` becomes the number of them.
std::vector<std::uint32_t> components_of(const TriangleMesh& mesh, std::uint32_t& count);

/// Signed volume enclosed by a closed surface; positive when it is oriented outwards.
double enclosed_volume(const TriangleMesh& mesh);

/// Bounding box of the vertices that a face uses.
BoundingBox bounding_box(const TriangleMesh& mesh);

/// Warnings about a surface that is valid but may surprise: isolated vertices, zero-area triangles,
/// inside-out orientation, several components.
Diagnostics inspect(const TriangleMesh& mesh);

}  // namespace hex
