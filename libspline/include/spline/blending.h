/// \file blending.h
/// Blending functions on an unstructured hexahedral mesh: the extraction operator M with Q = M P, where P are
/// the control points of the mesh and Q the Bezier points of its elements.
///
/// One rule set serves every element, regular or not. Weights of a body point of a cell, next to its corner
/// c: 8/27 at c, 4/27 at the three neighbours, 2/27, 1/27. Weights of a point of a boundary quad, next to its
/// corner: 4/9, 2/9 twice, 1/9. Sources: Wei, Zhang, Hughes: Truncated hierarchical tricubic C0 spline
/// construction on unstructured hexahedral meshes, 2017; paper, Algorithms "Blending Functions".
///  - body point: the cell's;
///  - face point: mean over the two cells, or the boundary quad's;
///  - edge point: mean over all cells around, or the boundary quads around, or 2/3 and 1/3 of the ends of a
///    sharp edge;
///  - corner point: mean over all cells around; smooth boundary: over the boundary quads; crease: 2/3 of the
///    vertex and 1/6 of its two neighbours along the crease; corner: the vertex.
/// Every row is a convex combination: entries > 0, sum 1 (exactly so in the rational form).
#pragma once

#include <spline/level_mesh.h>
#include <spline/sparse_rows.h>

#include <array>

namespace spline {

/// Bezier points of a mesh, each once: points shared by elements have one number, so their rows are the same
/// from every side and the spline is continuous by construction.
///
/// Numbers: 8 a cell (body, by corner), then 4 a face (by corner of its first half-face), then 2 an edge (by
/// end), then 1 a vertex. The mesh must outlive the object.
class BlendingOperator {
  public:
    /// Only numbers the points; rows are made when asked for. Keeps a reference to `level`.
    explicit BlendingOperator(const LevelMesh& level);

    /// Number of Bezier points of the whole mesh: numbers of points are below this.
    std::size_t point_count() const { return vertex_points_ + level_.mesh.vertex_count(); }

    /// The 64 points of an element, point i + 4 j + 16 k at (i,j,k) along (u,v,w).
    std::array<std::uint32_t, 64> element_points(hex::CellId cell) const;

    /// Row of M for a point: fills `row` with numerators over the vertices of the mesh and returns the
    /// denominator. Must not be asked for points of open edges, faces or vertices.
    std::int64_t row(std::uint32_t point, RationalRowSum& row) const;

  private:
    void add_body_point(hex::CellId cell, hex::VertexId near, std::int64_t factor, RationalRowSum& row) const;
    void add_quad_point(const std::array<hex::VertexId, 4>& quad, hex::VertexId near,
                        RationalRowSum& row) const;
    std::int64_t face_row(std::size_t face, std::size_t corner, RationalRowSum& row) const;
    std::int64_t edge_row(hex::EdgeId edge, hex::VertexId near, RationalRowSum& row) const;
    std::int64_t vertex_row(hex::VertexId v, RationalRowSum& row) const;

    const LevelMesh& level_;
    std::size_t face_points_, edge_points_, vertex_points_;
};

}  // namespace spline
