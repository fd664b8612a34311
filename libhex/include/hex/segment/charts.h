/// \file charts.h
/// What a labelling makes of a surface: charts, the boundaries between them, the corners where those meet.
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/segment/segment.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <vector>

namespace hex {

/// A connected component, through shared edges, of triangles of equal label.
struct LabelChart {
    int label = 0;                 ///< 0..5 of all its triangles
    std::vector<int> triangles;    ///< ascending
    std::vector<int> boundaries;   ///< indices into LabelCharts::boundaries
    int euler_characteristic = 0;  ///< V - E + F; 1 for a disk
};

/// A maximal run of edges between the same two charts: from corner to corner, or closed.
struct LabelBoundary {
    std::array<int, 2> charts = {-1, -1};       ///< on the two sides, the smaller index first
    std::vector<int> vertices;                  ///< in order; the first again at the end when it is closed
    std::vector<std::array<int, 2>> triangles;  ///< beside each edge, in the order of `charts`
};

/// A vertex where at least three edges between different charts meet. (`find_patches` calls a corner what
/// at least three different patches share; the two differ only where a chart touches itself.)
struct LabelCorner {
    int vertex = 0;           ///< of the mesh
    int valence = 0;          ///< edges between different charts that end here
    std::vector<int> charts;  ///< the different ones around the vertex, ascending
};

/// The charts of a labelling. Charts and boundaries are known by their index in these lists, triangles and
/// vertices by that in the mesh.
struct LabelCharts {
    std::vector<LabelChart> charts;      ///< in the order of their first triangles
    std::vector<int> chart_of_triangle;  ///< one a triangle
    /// First those that end in corners, corner after corner; then the closed ones without a corner.
    std::vector<LabelBoundary> boundaries;
    std::vector<LabelCorner> corners;  ///< by ascending vertex
};

/// Finds charts, boundaries and corners. Linear in the number of triangles. Throws Error{bad_input} when
/// there is not one label 0..5 for each triangle.
LabelCharts find_charts(const TriangleMesh& mesh, const Segmentation& segmentation);

/// The paper's three conditions on a segmentation that shall become a polycube, by codes:
/// 1. opposite labels share no boundary: `opposite-labels-adjacent` (error; the triangles on both sides);
/// 2. a corner is shared by more than two charts: `corner-of-two-charts` (error; the vertex), and three
///    charts at a corner name three axes: `corner-repeats-axis` (error; the vertex);
/// 3. a chart has four boundaries: `chart-too-few-boundaries` (error; its triangles),
///    `chart-too-many-boundaries` and `chart-not-a-disk` (warnings; its corners, or one vertex of each
///    boundary).
/// An error must be repaired in the labels; a warning goes away when the charts are cut into patches. Corners
/// where more than three charts meet are allowed, and told as notes (`corner-valence`).
Diagnostics validate_charts(const LabelCharts& charts);

}  // namespace hex
