/// \file feature_set.h
/// Sharp features of the boundary of a hexahedral mesh: which edges are sharp, and what that makes of each
/// vertex.
#pragma once

#include <hex/volume/topology.h>

#include <cstdint>
#include <span>
#include <vector>

namespace hex {

/// Where the sharp features of a mesh come from.
enum class FeatureSource {
    none,   ///< no sharp features
    angle,  ///< by the angle between boundary quads
    list,   ///< from a list of vertices
};

/// What its sharp edges make of a vertex.
enum class VertexFeature : std::uint8_t {
    interior,  ///< not on the boundary
    smooth,    ///< on the boundary, no sharp edge
    crease,    ///< exactly two sharp edges
    corner,    ///< one, or three and more, sharp edges
};

/// Sharp edges and the class of every vertex. Indices are those of the mesh and of its EdgeTable.
struct FeatureSet {
    std::vector<char> sharp_edge;       ///< one flag an edge of the EdgeTable
    std::vector<VertexFeature> vertex;  ///< one class a mesh vertex
    /// Number of edges whose flag is set. Linear in the number of edges.
    std::size_t sharp_edge_count() const;
};

/// No sharp features: every boundary vertex is smooth.
FeatureSet no_features(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary);

/// A boundary edge is sharp when the unit outward normals of its two boundary quads have a dot product below
/// `cosine` (0.8, about 37 degrees, by default in the paper). The normal of a quad is the direction of the
/// cross product of its diagonals, that is of its vector area: a warped quad has one normal whichever corner
/// is looked at. Edges of a quad without area are not sharp (it has no direction); an edge with more than two
/// boundary quads always is. Throws Error{usage} unless `cosine` is in [-1, 1].
FeatureSet features_by_angle(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                             double cosine);

/// 1 for each vertex that is listed, 0 for the others. Throws Error{bad_input} for an id out of range.
std::vector<char> flags_of_sharp(const HexMesh& mesh, std::span<const std::int64_t> vertices);

/// A boundary edge is sharp when both its ends are listed (sharp.txt). Listed vertices that are not on the
/// boundary are ignored; a listed vertex without sharp edge is smooth. Throws Error{bad_input} for an id out
/// of range.
FeatureSet features_from_vertices(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                                  std::span<const std::int64_t> vertices);

/// Classes of the vertices from given sharp edges. Used by the functions above, and by whoever makes sharp
/// edges otherwise.
FeatureSet classify(const EdgeTable& edges, const BoundaryQuads& boundary, std::vector<char> sharp_edge);

}  // namespace hex
