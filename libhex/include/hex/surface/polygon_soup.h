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
    std::vector<Vec3> points;                ///< positions, in the unit of the file
    std::vector<std::uint32_t> corners;      ///< indices into `points`, polygon after polygon
    std::vector<std::size_t> offsets = {0};  ///< where each polygon starts in `corners`, and the end
    /// One part id a polygon; 1 where the format has none.
    std::vector<int> parts;

    /// Number of polygons.
    std::size_t size() const { return offsets.size() - 1; }
    /// Corners of polygon f, which must exist; valid until a polygon is added.
    std::span<const std::uint32_t> polygon(std::size_t f) const {
        return {corners.data() + offsets[f], offsets[f + 1] - offsets[f]};
    }
    /// Appends a polygon; its corners are not checked (make_poly_mesh() does that).
    void add_polygon(std::span<const std::uint32_t> polygon, int part = 1);
};

/// What a surface must be to be accepted.
struct SurfaceRequirements {
    bool closed = true;  ///< no boundary edge
};

/// Polygon mesh of a soup; vertex and face indices are kept.
/// Throws Error{bad_input} naming the place (0-based vertex and polygon ids) for: no faces, coordinates that
/// are not finite, degenerate polygons (fewer than three corners, a vertex twice, one that does not exist),
/// edges with more than two faces, neighbours oriented against each other, inner vertices with two faces
/// only, vertices where the surface only touches itself, and boundary edges when `requirements.closed`.
PolyMesh make_poly_mesh(const PolygonSoup& soup, const SurfaceRequirements& requirements = {});

/// Triangles of a polygon mesh by CGAL's constrained hole-free triangulation of each face
/// (Polygon_mesh_processing). A triangle stays as it is; the triangles of one polygon are consecutive, in the
/// order of the polygons, and carry its `part` and its index as `source`. Throws Error{bad_input} naming a
/// polygon that cannot be triangulated.
TriangleMesh triangulate(const PolyMesh& mesh);

/// make_poly_mesh, then triangulate.
TriangleMesh make_triangle_mesh(const PolygonSoup& soup, const SurfaceRequirements& requirements = {});

/// The triangles back as a soup, with their parts. Vertex and face indices are kept, isolated vertices
/// included.
PolygonSoup to_soup(const TriangleMesh& mesh);
/// The polygons back as a soup, in the same way.
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
