/// \file integer_polycube.h
/// One integer coordinate a chart: the polycube in the integers that a labelling describes.
#pragma once

#include "polycube/chart_graph.h"

namespace hex {

/// The coordinate of `low` must be smaller than that of `high`.
struct PlaneOrder {
    int low = 0;          ///< a chart
    int high = 0;         ///< a chart of the same axis
    double length = 0.0;  ///< how far apart they are in space
    double weight = 1.0;
    int side = -1;  ///< the side that asks for it, or none
};

/// The orders of the sides' ends.
std::vector<PlaneOrder> side_orders(const ChartGraph& graph);

/// Orders seen along rays from every triangle along the axis of its chart, through the inside and through the
/// outside, wherever the first chart hit faces the other way; the most frequent first.
std::vector<PlaneOrder> ray_orders(const TriangleMesh& mesh, const ChartGraph& graph);

/// A set of orders without a cycle.
class PlaneOrders {
  public:
    explicit PlaneOrders(const ChartGraph& graph);

    /// Adds an order unless it closes a cycle; `false` then.
    bool add(const PlaneOrder& order);
    /// The charts from `order.high` to `order.low` of the cycle that a refused order would close.
    std::vector<int> cycle(const PlaneOrder& order) const;

    const std::vector<PlaneOrder>& orders() const { return orders_; }

  private:
    const ChartGraph* graph_;
    std::vector<PlaneOrder> orders_;
    std::vector<std::vector<int>> above_;  ///< for each plane those directly above
};

/// Integer coordinates that keep all orders, with the smallest sum of weight |difference - length / unit|.
/// Every row has one +1 and one -1, so the linear relaxation is integral and the program is solved without
/// branching. Throws Error{no_result} when the solver fails.
std::vector<int> solve_coordinates(const ChartGraph& graph, const PlaneOrders& orders, double unit);

}  // namespace hex
