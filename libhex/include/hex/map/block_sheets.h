/// \file block_sheets.h
/// Sheets of a block structure: the sets of block edges that must be cut into equally many pieces.
#pragma once

#include <hex/volume/hex_mesh.h>
#include <hex/volume/topology.h>

#include <array>
#include <cstddef>
#include <vector>

namespace hex {

/// The classes of block edges under "opposite in a block" (the dual sheets of Murdoch, Benzley, Blacker,
/// Mitchell: The spatial twist continuum, Finite Elem. Anal. Des. 28 (1997) 137-149). A sheet may cross
/// itself.
struct BlockSheets {
    std::vector<std::size_t> sheet_of_edge;  ///< one an edge of the EdgeTable
    std::size_t count = 0;                   ///< sheets are numbered in the order of their first edges

    /// Sheet that cuts the axis u, v or w (0, 1, 2) of a block.
    std::size_t of_axis(const EdgeTable& edges, CellId block, std::size_t axis) const;
};

/// Local edges of a block along its axis u, v, w (0, 1, 2); the first starts at corner 0.
inline constexpr std::array<std::array<std::size_t, 4>, 3> edges_of_axis = {
    {{0, 2, 8, 10}, {3, 1, 11, 9}, {4, 5, 6, 7}}};

/// `edges` must be edge_table(blocks). Almost linear.
BlockSheets find_sheets(const HexMesh& blocks, const EdgeTable& edges);

}  // namespace hex
