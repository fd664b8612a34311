/// \file chart_graph.h
/// The combinatorics of a polycube that a labelling describes: charts, the sides where two of them meet, and
/// which charts end a side.
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/segment/segment.h>
#include <hex/surface/patch_layout.h>

#include <array>
#include <vector>

namespace hex {

/// An edge of the polycube: a chain of mesh edges between two charts of different axes. It runs along the
/// third axis, from the chart that faces along this axis at its one end to that at its other.
struct ChartSide {
    std::array<int, 2> charts = {-1, -1};  ///< [0] lies on the left when the chain is walked as stored
    Chain chain;
    int axis = 0;       ///< the direction of the side, 0..2
    int direction = 1;  ///< +1 when the coordinate along `axis` grows along the chain, else -1
    std::array<int, 2> ends = {-1, -1};  ///< charts of this axis at the first and at the last vertex
    double length = 0.0;                 ///< of the chain
    double rise = 0.0;                   ///< signed difference of the coordinate along `axis`
};

/// A side as a chart walks it, with the chart on the left.
struct SideUse {
    int side = 0;
    bool reversed = false;
};

struct GraphChart {
    int label = 0;
    std::vector<std::vector<SideUse>> loops;  ///< counter-clockwise seen from outside
};

struct ChartGraph {
    PatchLayout layout;  ///< of the labels: patch = chart
    std::vector<GraphChart> charts;
    std::vector<ChartSide> sides;
    /// Charts of one axis that meet at one corner, so that they have one coordinate; the first of each group
    /// of charts stands for all.
    std::vector<int> same_plane;
    /// Sides whose direction in space was overruled because their charts could not close with it.
    std::vector<int> turned_sides;
    /// Errors that leave no polycube: `chart-without-corners`, `opposite-labels-adjacent`,
    /// `side-without-end`, `chart-touches-itself`.
    Diagnostics violations;
};

inline int axis_of(int label) {
    return label / 2;
}
inline int sign_of(int label) {
    return label % 2 == 0 ? 1 : -1;
}
/// The axis that is neither a nor b.
inline int third_axis(int a, int b) {
    return 3 - a - b;
}
inline std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Builds the graph of a surface whose part ids are labels + 1.
ChartGraph build_chart_graph(const TriangleMesh& labelled);

}  // namespace hex
