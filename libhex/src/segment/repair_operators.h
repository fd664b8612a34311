/// \file repair_operators.h
/// Changes of labels that may mend a place where a labelling is not that of a polycube. Each operator only
/// proposes; the repair (label_repair.h) evaluates the proposals and keeps the best.
#pragma once

#include "segment/label_surface.h"

#include <hex/segment/charts.h>

#include <string>
#include <utility>
#include <vector>

namespace hex {

/// New labels for some triangles, by one operator.
struct LabelChange {
    const char* repair = "";
    std::vector<std::pair<int, int>> labels;  ///< triangle, new label; only triangles that really change
};

/// Proposes changes of one labelling. `labels` and `charts` must outlive it; the charts may be older than
/// the labels, they only say where to look.
class RepairOperators {
  public:
    RepairOperators(const LabelSurface& surface, const std::vector<int>& labels, const LabelCharts& charts);

    /// merge-chart: the whole chart takes the label of a neighbour.
    void merge_chart(int chart, std::vector<LabelChange>& out) const;
    /// relabel-chart: the whole chart takes any other label.
    void relabel_chart(int chart, std::vector<LabelChange>& out) const;
    /// dissolve-chart: the neighbours grow into the chart, each triangle going to the cheapest that reaches
    /// it.
    void dissolve_chart(int chart, std::vector<LabelChange>& out) const;
    /// insert-chart: a strip of one to four triangles on one side of the boundary, or on both, takes a label
    /// that neither side has.
    void insert_chart(int boundary, std::vector<LabelChange>& out) const;
    /// grow-chart: the chart takes one to four rings of triangles around it from all its neighbours, or from
    /// one.
    void grow_chart(int chart, std::vector<LabelChange>& out) const;
    /// fill-corner: the triangles within zero to three rings of a vertex take one label.
    void fill_corner(int vertex, std::vector<LabelChange>& out) const;
    /// pull-chart: a path of triangles, the cheapest, connects the chart with another one of a label.
    void pull_chart(int chart, std::vector<LabelChange>& out) const;
    /// split-chart: the triangles of a chart that also agree with another label take it; or a smooth face of
    /// it does, bounded by creases.
    void split_chart(int chart, std::vector<LabelChange>& out) const;

    /// Completes the change to whole polygons, drops what is no change, keeps it when something is left.
    void finish(LabelChange change, std::vector<LabelChange>& out) const;

  private:
    void add(const char* repair, const std::vector<int>& triangles, int label,
             std::vector<LabelChange>& out) const;
    /// Rings of triangles, by vertices, around the seeds' triangles; `inside(t)` tells where to go.
    template <class Inside>
    std::vector<std::vector<int>> rings(const std::vector<int>& vertices, int count,
                                        const Inside& inside) const;
    std::vector<int> neighbour_charts(int chart) const;
    void pull_label(int chart, int label, std::vector<LabelChange>& out) const;

    const LabelSurface* surface_;
    const std::vector<int>* labels_;
    const LabelCharts* charts_;
};

}  // namespace hex
