/// \file mesh_defects.h
/// What is wrong with a hexahedral mesh whatever the shape of its elements is: nodes that are there twice or
/// for nothing, and a boundary that does not close.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/volume/hex_mesh.h>

#include <array>
#include <vector>

namespace hex {

/// What find_defects() found; all empty for a mesh without defects.
struct MeshDefects {
    /// Vertices that no hexahedron uses, ascending.
    std::vector<VertexId> unused;
    /// Used vertices at the place of an earlier one: {vertex, the first one there}, ascending.
    std::vector<std::array<VertexId, 2>> duplicates;
    /// Boundary edges where not exactly two boundary faces meet: {smaller, larger vertex}, ascending.
    std::vector<std::array<VertexId, 2>> open_edges;
    /// Vertices where hexahedra touch without a common face, ascending.
    std::vector<VertexId> pinched;
    /// Boundary faces that lie on another boundary face, because their vertices are there twice: the mesh has
    /// a crack. In order of the first.
    std::vector<std::array<HalfFaceId, 2>> cracks;
    /// The hexahedra hang together through faces in more than one piece.
    bool several_components = false;
    /// What inspect (hex/volume/topology.h) says.
    Diagnostics topology;

    /// The boundary closes: each of its edges has two faces, and there are no cracks.
    bool watertight() const { return open_edges.empty() && cracks.empty(); }
};

/// `tolerance` is the largest distance of two vertices at the same place, as a share of the diagonal of
/// the mesh, >= 0. O(n log n).
MeshDefects find_defects(const HexMesh& mesh, double tolerance = 1e-9, const Context& context = {});

}  // namespace hex
