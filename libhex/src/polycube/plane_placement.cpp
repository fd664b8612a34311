#include "polycube/plane_placement.h"

#include <hex/base/components.h>
#include <hex/volume/hexahedron.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace hex {
namespace {

class PlanePlacer {
  public:
    PlanePlacer(const ChartGraph& graph, const BlockComplex& complex, double unit)
        : graph_(graph), complex_(complex), unit_(unit), planes_(3 * complex.positions.size()) {}

    std::vector<Vec3> place(const std::vector<double>& level) {
        join();
        add_gaps();
        add_sides();
        add_levels(level);
        descend();
        std::vector<Vec3> places(complex_.positions.size());
        for (std::size_t v = 0; v < places.size(); ++v)
            for (int a = 0; a < 3; ++a) places[v][a] = value_[planes_.root(slot(static_cast<int>(v), a))];
        return places;
    }

  private:
    /// weight (t_high - t_low - target)^2
    struct Spring {
        std::size_t low;
        std::size_t high;
        double target;
        double weight;
    };
    struct Anchor {
        double target;
        double weight;
    };

    static std::size_t slot(int vertex, int axis) { return 3 * at(vertex) + at(axis); }

    template <class Body>
    void for_each_edge(const Body& body) const {
        for (const auto& block : complex_.blocks)
            for (const auto& [a, b] : hexahedron::edge_corners) {
                const auto& one = hexahedron::corner_uvw[at(a)];
                const auto& two = hexahedron::corner_uvw[at(b)];
                int axis = 0;
                while (one[at(axis)] == two[at(axis)]) ++axis;
                const bool up = two[at(axis)] > one[at(axis)];
                body(block[at(up ? a : b)], block[at(up ? b : a)], axis);
            }
    }

    void join() {
        for_each_edge([&](int low, int high, int axis) {
            for (int other = 0; other < 3; ++other) {
                if (other == axis) continue;
                planes_.join(slot(low, other), slot(high, other));
            }
        });
        value_.resize(planes_.size());
        for (std::size_t v = 0; v < complex_.positions.size(); ++v)
            for (std::size_t a = 0; a < 3; ++a)
                value_[3 * v + a] = unit_ * complex_.planes[a][at(complex_.positions[v][a])];
    }

    void add_gaps() {
        above_.resize(planes_.size());
        below_.resize(planes_.size());
        for_each_edge([&](int low, int high, int axis) {
            const std::size_t a = planes_.root(slot(low, axis));
            const std::size_t b = planes_.root(slot(high, axis));
            above_[a].push_back(b);
            below_[b].push_back(a);
        });
        for (auto* rows : {&above_, &below_}) {
            for (auto& row : *rows) {
                std::sort(row.begin(), row.end());
                row.erase(std::unique(row.begin(), row.end()), row.end());
            }
        }
    }

    void add_sides() {
        springs_of_.resize(planes_.size());
        for (std::size_t s = 0; s < graph_.sides.size(); ++s) {
            const ChartSide& side = graph_.sides[s];
            const auto& nodes = complex_.side_nodes[s];
            int low = nodes.front().vertex;
            int high = nodes.back().vertex;
            if (side.direction < 0) std::swap(low, high);
            const double rise = std::abs(side.rise);
            springs_.push_back({planes_.root(slot(low, side.axis)), planes_.root(slot(high, side.axis)),
                                std::max(rise, 0.5 * (rise + side.length) * 0.8), 1.0});
            springs_of_[springs_.back().low].push_back(springs_.size() - 1);
            springs_of_[springs_.back().high].push_back(springs_.size() - 1);
        }
    }

    void add_levels(const std::vector<double>& level) {
        anchors_of_.resize(planes_.size());
        for (std::size_t c = 0; c < graph_.charts.size(); ++c) {
            const SideUse& use = graph_.charts[c].loops.front().front();
            const int vertex = complex_.side_nodes[at(use.side)].front().vertex;
            anchors_of_[planes_.root(slot(vertex, axis_of(graph_.charts[c].label)))].push_back(
                {level[c], 0.1});
        }
    }

    /// Each coordinate in turn goes to its minimum between its neighbours.
    void descend() {
        const double gap = 0.1 * unit_;
        // The integer polycube lies anywhere; bring it over the surface first.
        shift();
        for (int sweep = 0; sweep < 1000; ++sweep) {
            double moved = 0.0;
            for (std::size_t i = 0; i < planes_.size(); ++i) {
                if (!planes_.is_root(i)) continue;
                double sum = 0.0;
                double weight = 0.0;
                for (const std::size_t s : springs_of_[i]) {
                    const Spring& spring = springs_[s];
                    sum += spring.weight * (i == spring.high ? value_[spring.low] + spring.target
                                                             : value_[spring.high] - spring.target);
                    weight += spring.weight;
                }
                for (const Anchor& anchor : anchors_of_[i]) {
                    sum += anchor.weight * anchor.target;
                    weight += anchor.weight;
                }
                double lower = -std::numeric_limits<double>::infinity();
                double upper = std::numeric_limits<double>::infinity();
                for (const std::size_t b : below_[i]) lower = std::max(lower, value_[b] + gap);
                for (const std::size_t a : above_[i]) upper = std::min(upper, value_[a] - gap);
                double wanted = weight > 0.0 ? sum / weight : value_[i];
                // A plane without a chart lies halfway.
                if (weight == 0.0 && std::isfinite(lower) && std::isfinite(upper))
                    wanted = 0.5 * (lower + upper);
                wanted = std::min(std::max(wanted, lower), upper);
                moved = std::max(moved, std::abs(wanted - value_[i]));
                value_[i] = wanted;
            }
            if (moved < 1e-6 * unit_) break;
        }
    }

    void shift() {
        for (std::size_t a = 0; a < 3; ++a) {
            double sum = 0.0;
            double count = 0.0;
            for (std::size_t i = a; i < planes_.size(); i += 3)
                for (const Anchor& anchor : anchors_of_[i]) {
                    sum += anchor.target - value_[i];
                    count += 1.0;
                }
            if (count == 0.0) continue;
            for (std::size_t i = a; i < planes_.size(); i += 3) value_[i] += sum / count;
        }
    }

    const ChartGraph& graph_;
    const BlockComplex& complex_;
    double unit_;
    Components planes_;  ///< coordinates of block vertices that are one
    std::vector<double> value_;
    std::vector<std::vector<std::size_t>> above_;
    std::vector<std::vector<std::size_t>> below_;
    std::vector<Spring> springs_;
    std::vector<std::vector<std::size_t>> springs_of_;
    std::vector<std::vector<Anchor>> anchors_of_;
};

}  // namespace

std::vector<Vec3> place_planes(const ChartGraph& graph, const BlockComplex& complex,
                               const std::vector<double>& level, double unit) {
    return PlanePlacer(graph, complex, unit).place(level);
}

}  // namespace hex
