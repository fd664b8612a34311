/// \file chart_order.h
/// Whether the charts of a labelling can be given coordinates.
#pragma once

#include <vector>

namespace hex {

/// A polycube's boundary edge between two corners runs along one axis, between the two charts across that
/// axis that end it; the geometry tells which of these comes first. Charts can have coordinates only when
/// no edge ends at one chart twice and the orders make no cycle.
class ChartOrder {
  public:
    struct Arc {
        int before = 0;
        int after = 0;
        int boundary = -1;
    };

    void clear() { arcs_.clear(); }
    void add(const Arc& arc) { arcs_.push_back(arc); }

    /// Marks the arcs from a chart to itself and those in cycles, or between cycles. The others are dropped.
    /// What is left are conflicts; linear in the number of arcs, and in the greatest chart.
    const std::vector<Arc>& conflicts();

    /// After conflicts(): the charts concerned, an arc from a chart to itself counted twice; 0 when
    /// coordinates exist.
    int disorder() const { return disorder_; }

  private:
    std::vector<Arc> arcs_;
    std::vector<int> incoming_;
    std::vector<int> outgoing_;
    int disorder_ = 0;
};

}  // namespace hex
