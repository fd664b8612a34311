/// \file corner_sliding.h
/// Block vertices slide on the surface, and the block lines with them, until no block is inverted.
#pragma once

#include <hex/base/context.h>
#include <hex/volume/hex_mesh.h>

#include <array>
#include <vector>

namespace hex {

/// A surface cut into patches, and the blocks that fit it.
struct PatchedBlocks {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> patch;           ///< of each triangle
    std::vector<int> vertex_of_node;  ///< surface vertex of each block vertex; -1 inside
    HexMesh blocks;
};

/// Sweeps over the block vertices on the surface around which a block has a corner with a scaled Jacobian
/// below `target`: each moves to the vertex of the patches around it where the sum of
/// max(0, target - scaled Jacobian)^2 over the corners of the blocks around is least, and the lines from
/// there to its neighbours are cut anew (cut_star). A vertex on a sharp edge (cosine between normals below
/// 0.8) moves only when a block around it is inverted, and only to another on a sharp edge; the others keep
/// off sharp edges. Inner block vertices are placed again after each sweep. Returns the number of moves.
std::size_t slide_corners(PatchedBlocks& model, double target, int sweeps, const Context& context);

}  // namespace hex
