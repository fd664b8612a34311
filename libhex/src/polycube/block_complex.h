/// \file block_complex.h
/// The inside of an integer polycube: cells between the planes of its charts, and the fewest conforming
/// blocks.
#pragma once

#include "polycube/chart_graph.h"

#include <array>
#include <vector>

namespace hex {

/// Two charts that cannot both lie where their coordinates put them.
struct ChartConflict {
    int chart = 0;
    int other = 0;  ///< may be the same chart, when it is folded over itself
};

/// A straight line of block faces' edges across a chart, from boundary to boundary.
struct ChartSegment {
    int axis = 0;                      ///< it runs along this axis
    int plane = 0;                     ///< plane index on the chart's other axis
    std::array<int, 2> ends = {0, 0};  ///< plane indices along `axis`, ascending
    /// Block vertices at the ends.
    std::array<int, 2> vertices = {-1, -1};
    /// Block vertices where other segments cross it: plane index along `axis`, vertex.
    std::vector<std::array<int, 2>> crossings;
};

/// A block vertex on a side.
struct SideNode {
    int plane = 0;   ///< plane index along the side's axis
    int vertex = 0;  ///< block vertex
};

struct BlockComplex {
    /// Integer coordinates of the planes along each axis, ascending: those of the charts.
    std::array<std::vector<int>, 3> planes;
    std::vector<int> plane_of_chart;  ///< index in planes[axis of the chart]

    std::vector<ChartConflict> conflicts;  ///< when not empty, all below is meaningless

    std::size_t cells = 0;
    std::vector<std::array<int, 8>> blocks;           ///< block vertices in VTK order, axes u, v, w = x, y, z
    std::vector<std::array<int, 3>> positions;        ///< plane indices of each block vertex
    std::vector<std::vector<SideNode>> side_nodes;    ///< of each side, from its first to its last vertex
    std::vector<std::vector<ChartSegment>> segments;  ///< of each chart
};

/// Compresses the grid to the planes of the charts, fills the cells inside, and joins them to the blocks of
/// the base complex: the cells are parted only by the walls that continue charts from the concave edges into
/// the inside, straight on to the boundary.
BlockComplex build_blocks(const ChartGraph& graph, const std::vector<int>& coordinates);

}  // namespace hex
