/// \file chart_cutter.h
/// Cuts the triangles of a chart along lines given by their ends on its boundary, so that every part between
/// the lines is a union of triangles.
#pragma once

#include <hex/base/linear_algebra.h>

#include <array>
#include <vector>

namespace hex {

/// A line across the chart through nodes: its ends on the boundary, between them the crossings with other
/// lines. Two lines cross at most once. A line is straight and parallel to an axis of the plane.
struct CutLine {
    std::vector<int> nodes;  ///< indices into CutProblem::nodes
};

struct CutNode {
    Vec2 place = Vec2::Zero();  ///< in the plane
    int vertex = -1;            ///< vertex of the chart on its boundary; -1 for crossings
};

struct CutProblem {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<CutNode> nodes;
    std::vector<CutLine> lines;
};

struct CutResult {
    std::vector<Vec3> points;  ///< those of the problem first; new ones lie on inner edges of the chart
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> part;         ///< of each triangle, from 0
    std::vector<int> node_vertex;  ///< of each node
    int steps = 0;                 ///< lines that had to be cut one at a time
    bool direct = false;           ///< all lines at once, in the chart's own polygon
};

/// The chart is mapped harmonically onto its polygon (nodes at their places, boundary between them by
/// length). If no triangle flips, all lines are cut in this map. Otherwise a line is cut alone, straight in a
/// map of the region onto a disk (always one-to-one), or, where the region is no disk, along a shortest path
/// of edges, and the two halves are done in the same way. Cuts split edges; nearly met vertices are moved
/// onto the line, in the plane only.
///
/// Throws Error{no_result} when a line cannot be cut.
CutResult cut_chart(const CutProblem& problem);

/// Cuts a disk from an inner vertex to nodes on its rim, straight in a map onto a round disk. Every line has
/// two nodes: one on the rim and, the same for all, the inner one. Throws Error{no_result} when the triangles
/// form no disk or a line cannot be cut.
CutResult cut_star(const CutProblem& problem);

}  // namespace hex
