/// \file block_match.h
/// Which corner of the surface each boundary vertex of the blocks is, and which patch each boundary quad is.
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/surface/mesh_types.h>
#include <hex/surface/patch_layout.h>
#include <hex/volume/hex_mesh.h>
#include <hex/volume/topology.h>

#include <vector>

namespace hex {

/// What of the surface belongs to each vertex, edge and boundary quad of the blocks.
struct BlockMatch {
    /// Surface vertex of each boundary vertex of the blocks; -1 for the others.
    std::vector<int> surface_vertex;
    /// Patch of each boundary quad; a one-to-one correspondence.
    std::vector<int> patch_of_quad;
    /// Vertex 0 of quad q lies on corner `turn_of_quad[q]` (0..3) of its patch, and the others follow in the
    /// same sense.
    std::vector<int> turn_of_quad;
    /// For each edge of the blocks that lies on the boundary the surface vertices along it, from its smaller
    /// to its larger vertex; empty for the others.
    std::vector<Chain> chain_of_edge;
    /// Largest distance between a block vertex and its surface corner, in units of the diagonal of the
    /// surface.
    double largest_snap = 0.0;
    /// Warning `far-corner` (entity "block vertex") for those farther than asked.
    Diagnostics diagnostics;
};

/// Each boundary vertex of the blocks goes to the nearest corner of the surface (a CGAL k-d tree), then every
/// boundary quad must have the four corners of one patch, in the same sense, and every patch must be used.
///
/// `quads` and `edges` are those of `blocks`. `far` is the distance, in units of the diagonal, beyond which a
/// vertex is warned about. O((blocks + corners) log corners).
///
/// Throws Error{bad_input} naming blocks, patches (0-based, with part ids) and vertices (0-based) when there
/// are no blocks, a patch is not four-sided, two block vertices meet one corner, a quad is no patch, a patch
/// is no quad, blocks and surface are oriented against each other, or two patches reach a block edge along
/// different chains.
BlockMatch match_blocks(const TriangleMesh& surface, const PatchLayout& layout, const HexMesh& blocks,
                        const BoundaryQuads& quads, const EdgeTable& edges, double far);

}  // namespace hex
