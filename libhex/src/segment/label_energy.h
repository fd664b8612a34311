/// \file label_energy.h
/// How good a labelling is: its faith to the normals, the length of its boundaries, and what keeps it from
/// being that of a polycube.
#pragma once

#include "segment/chart_order.h"
#include "segment/label_surface.h"

#include <vector>

namespace hex {

/// The parts of the energy.
struct LabelScore {
    double infidelity = 0.0;  ///< sum of the costs of the labels
    double cut = 0.0;         ///< sum of the weights of the edges between charts
    int opposite = 0;         ///< boundaries between opposite labels
    int missing_sides = 0;    ///< sum over the charts of the boundaries they lack to four
    int few_sided = 0;        ///< charts with fewer than four boundaries
    int crossings = 0;        ///< corners where more than three boundaries meet
    int turns = 0;            ///< places where a boundary turns back along its axis
    int disorder = 0;         ///< charts that can have no coordinates (chart_order.h)
    int closed = 0;           ///< boundaries without a corner
    int charts = 0;

    bool valid() const { return opposite == 0 && few_sided == 0; }
    /// How far it is from a valid one.
    double invalidity() const { return opposite + 0.5 * missing_sides; }
    /// What it costs, valid or not.
    double price() const {
        return infidelity + 0.005 * cut + 0.02 * crossings + 0.01 * disorder + 0.04 * closed +
               0.0005 * turns + 0.0005 * charts;
    }
    double energy(double weight_of_validity) const { return price() + weight_of_validity * invalidity(); }
};

/// Evaluates labellings of one surface; keeps its work space. One object for each thread.
class LabelEnergy {
  public:
    explicit LabelEnergy(const LabelSurface& surface);

    /// `labels` has one label 0..5 for each triangle. Linear in the number of triangles.
    LabelScore evaluate(const std::vector<int>& labels);

    /// Prepares for many labellings that differ from this one only in the triangles of `region` (ascending).
    /// Linear in the number of triangles.
    void prepare(const std::vector<int>& labels, const std::vector<int>& region);
    /// The score of one of those. Linear in the sizes of the region and of the boundaries.
    LabelScore evaluate_prepared(const std::vector<int>& labels);

  private:
    int find(int node);
    void add_boundary_edge(int edge, LabelScore& score);
    void walk(int vertex, int edge, const std::vector<int>& labels, LabelScore& score);

    const LabelSurface* surface_;
    // What prepare() leaves: outside the region, triangles of equal label hang together in pieces; a node is
    // a piece or a triangle of the region.
    std::vector<int> region_;
    std::vector<int> node_;         ///< of each triangle
    std::vector<int> inner_edges_;  ///< edges that touch the region
    std::vector<int> outer_edges_;  ///< boundary edges that do not
    int nodes_ = 0;
    double outer_infidelity_ = 0.0;

    /// The chart across the axis that meets a corner of three boundaries; -1 where there is none.
    int chart_across(int axis, int vertex, const std::vector<int>& labels);

    ChartOrder order_;
    std::vector<int> parent_;  ///< of nodes, in a union-find forest: charts
    std::vector<int> sides_;   ///< at the roots
    std::vector<int> stack_;
    std::vector<int> boundary_edges_;
    std::vector<char> visited_;
    std::vector<int> degree_;                   ///< boundary edges at each vertex
    std::vector<std::array<int, 2>> edges_at_;  ///< two of them
};

}  // namespace hex
