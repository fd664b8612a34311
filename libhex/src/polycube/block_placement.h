/// \file block_placement.h
/// Places the inner vertices of a block structure whose boundary is given.
#pragma once

#include <hex/volume/hex_mesh.h>

#include <vector>

namespace hex {

struct BlockQuality {
    double min_scaled_jacobian = 0.0;
    std::size_t inverted_corners = 0;  ///< determinant not above zero
    std::vector<std::int64_t> inverted_blocks;
};

/// Scaled Jacobian of a block at its corner k.
double corner_scaled_jacobian(const HexMesh& blocks, CellId c, std::size_t k);
/// What it would be with vertex v elsewhere.
double corner_scaled_jacobian(const HexMesh& blocks, CellId c, std::size_t k, VertexId v, const Vec3& place);
/// Whether corner k of a block is v or one of its neighbours: whether the scaled Jacobian there depends on v.
bool touches(const HexCell& block, std::size_t k, VertexId v);

BlockQuality block_quality(const HexMesh& blocks);

/// Inner vertices at the mean of their neighbours, then moved one by one to where the worst corner of the
/// blocks around is best. `free` marks inner vertices.
void place_inner_vertices(HexMesh& blocks, const std::vector<char>& free);

}  // namespace hex
