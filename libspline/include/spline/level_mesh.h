/// \file level_mesh.h
/// The control mesh of one level of the hierarchy, and the classes of its vertices, edges and elements.
///
/// Level 0 is the input mesh. A finer level covers only what is needed of it, so where its mesh ends is not
/// where the solid ends: what lies on the boundary is inherited from level to level and never recomputed from
/// the number of cells.
#pragma once

#include <hex/feature/feature_set.h>
#include <hex/volume/hex_mesh.h>
#include <hex/volume/topology.h>

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace spline {

/// The unique faces of a mesh, in the order in which they first appear (cell, then local face).
struct FaceTable {
    std::vector<std::uint32_t> of_half_face;  ///< face of each half-face; twins have the same
    std::vector<hex::HalfFaceId> half_faces;  ///< the first of the one or two half-faces of each face
    /// Number of faces.
    std::size_t size() const { return half_faces.size(); }
};

/// Mesh, topology and features of one level; made by `coarsest_level` and `subdivide`.
struct LevelMesh {
    hex::HexMesh mesh;            ///< its positions are the control points P of the level
    hex::EdgeTable edges;         ///< of the mesh; `boundary` flags those on the solid's boundary only
    FaceTable faces;              ///< of the mesh
    hex::BoundaryQuads boundary;  ///< only quads of the solid's boundary
    hex::FeatureSet features;     ///< sharp edges and classes of vertices; finer levels inherit theirs
    /// Patch of each boundary quad: quads that hang together across smooth edges. Numbered in the order of
    /// the quads of level 0; a quad of a finer level is on its parent's.
    std::vector<std::int32_t> patch_of_quad;
    hex::CompressedRows<hex::CellId> stars;  ///< cells around each vertex, ascending
    /// One flag a vertex. Cells are missing around it: the mesh ends here, but not the solid. Never so at
    /// level 0, nor at a vertex of an element of the domain.
    std::vector<char> open_vertex;
    std::vector<char> open_edge;  ///< one flag an edge: likewise

    /// Inside the solid, all its cells are there, and they are not four.
    bool is_extraordinary(hex::EdgeId e) const {
        return open_edge[e.index()] == 0 && edges.is_extraordinary(e);
    }
};

/// Level 0. `features` must be that of the mesh; every vertex must be used by a cell.
LevelMesh coarsest_level(hex::HexMesh mesh, hex::EdgeTable edges, hex::BoundaryQuads boundary,
                         hex::FeatureSet features);

/// Numbers the faces of a mesh. An interior face has its number from both its cells.
FaceTable face_table(const hex::HexMesh& mesh);

/// One flag a vertex: the spline around it is a tensor product, so the functions of the elements whose eight
/// vertices are regular are exact combinations of the next level's (Wei, Zhang, Hughes 2017). That is:
/// - inside: no extraordinary edge;
/// - smooth boundary: 4 boundary quads, 4 cells, no extraordinary edge, each boundary edge without feature
///   and with 2 cells;
/// - crease: 4 boundary quads, 2 cells, the two sharp edges with 1 cell, the other boundary edges with 2;
/// - corner: 3 boundary quads, 1 cell, 3 sharp edges.
std::vector<char> regular_vertices(const LevelMesh& level);

/// What the paper calls the types of elements.
enum class ElementClass : std::uint8_t {
    boundary,   ///< has a vertex on the boundary
    irregular,  ///< inside, with a vertex on an extraordinary edge
    regular,    ///< the rest: plain tricubic B-splines
};
/// Class of each cell of a level.
std::vector<ElementClass> classify_elements(const LevelMesh& level);

/// Number of extraordinary edges by valence.
std::map<int, std::size_t> extraordinary_edges(const LevelMesh& level);

}  // namespace spline
