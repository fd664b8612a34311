/// \file subdivision.h
/// Catmull-Clark subdivision of hexahedral meshes as an operator: P(fine) = C P(coarse).
///
/// Sources: MacCracken, Joy: Free-form deformations with lattices of arbitrary topology, 1996; Bajaj,
/// Schaefer, Warren, Xu: A subdivision scheme for hexahedral meshes, 2002; Burkhart, Hamann, Umlauf:
/// Iso-geometric finite element analysis based on Catmull-Clark subdivision solids, 2010. With c the mean of
/// the cells, a of the faces, m of the edges around, all of the old mesh:
///  - body point: c; interior face: (c1 + c2 + 2 a) / 4; boundary face: a;
///  - interior edge with n faces: (c + 2 a + (n - 3) m) / n; smooth boundary: (mean of 2 a + m) / 2; sharp:
///  m;
///  - interior vertex v: (c + 3 a + 3 m + v) / 8; smooth boundary with n quads: (a + 2 m + (n - 3) v) / n;
///    crease: 3/4 v + 1/8 of its two neighbours; corner: v.
/// Rows sum to 1 and are non-negative for valence >= 3.
#pragma once

#include <spline/level_mesh.h>
#include <spline/sparse_rows.h>

#include <span>

namespace spline {

/// What a vertex of the finer mesh is the point of.
struct FineVertex {
    /// Of a cell, a face, an edge, or the old vertex itself.
    enum class Kind : std::uint8_t { body, face, edge, vertex } kind;  ///< what `index` counts
    std::uint32_t
        index;  ///< cell, face of the FaceTable, edge of the EdgeTable, or vertex of the coarse mesh
};

/// A finer level, and how its vertices follow from the coarse one.
struct Subdivision {
    LevelMesh fine;                  ///< positions are C P; boundary, patches and features are inherited
    std::vector<FineVertex> origin;  ///< of each fine vertex
    SparseRows coefficients;         ///< C: one row a fine vertex, columns are coarse vertices
};

/// Every cell into eight. Vertices: the old ones, then edges and faces in the order of their first appearance
/// (cell, then local edge or face), then bodies. Child c of cell e is cell 8 e + c; it keeps the axes of its
/// parent and has the parent's corner c at its own corner c.
Subdivision subdivide(const LevelMesh& coarse);

/// Only the children of `refined`, then of `buffer`, eight each, in that order. `buffer` must hold every
/// other cell that shares a vertex with a refined one; it makes the stencils around the refined cells
/// complete. Vertices are numbered as the published program does: for each of these cells, the body points of
/// it and of the cells around it, then the face points, then the edge points of what touches its vertices,
/// then its vertices, each where first met. Vertices that no child uses are part of the mesh.
///
/// Where the coarse mesh ends before the solid does, the stencil is not complete: there the point is the mean
/// of its face or edge, or the old vertex. No function of the spline lives there.
Subdivision subdivide(const LevelMesh& coarse, std::span<const hex::CellId> refined,
                      std::span<const hex::CellId> buffer);

}  // namespace spline
