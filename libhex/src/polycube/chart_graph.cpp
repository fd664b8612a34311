#include "polycube/chart_graph.h"

#include <hex/base/components.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>

namespace hex {
namespace {

class GraphBuilder {
  public:
    explicit GraphBuilder(const TriangleMesh& mesh) : mesh_(mesh) {}

    ChartGraph build() {
        graph_.layout = find_patches(mesh_);
        for (const Patch& patch : graph_.layout.patches) graph_.charts.push_back({patch.part - 1, {}});
        check_loops();
        if (!graph_.violations.empty()) return std::move(graph_);
        collect_charts_at_corners();
        collect_sides();
        join_planes();
        if (graph_.violations.empty()) turn_sides();
        return std::move(graph_);
    }

  private:
    void violate(const char* code, std::string message, std::vector<std::int64_t> charts) {
        graph_.violations.push_back({Severity::error, code, std::move(message), "chart", std::move(charts)});
    }

    std::string name(int chart) const {
        return "chart " + std::to_string(chart) + " (" + label_name(graph_.charts[at(chart)].label) + ")";
    }

    void check_loops() {
        for (std::size_t p = 0; p < graph_.layout.patches.size(); ++p) {
            const int chart = static_cast<int>(p);
            std::set<int> seen;
            bool twice = false;
            for (const auto& loop : graph_.layout.patches[p].loops) {
                if (loop.size() < 4)
                    violate("chart-without-corners",
                            name(chart) + " has a boundary with " +
                                std::to_string(loop.size() == 1 && loop[0].front() == loop[0].back()
                                                   ? std::size_t{0}
                                                   : loop.size()) +
                                " corners, fewer than four, at vertex " + std::to_string(loop[0].front()),
                            {chart});
                for (const Chain& chain : loop) {
                    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
                        twice = !seen.insert(chain[i]).second || twice;
                }
            }
            if (graph_.layout.patches[p].loops.empty())
                violate("chart-without-corners", name(chart) + " is a whole closed surface", {chart});
            if (twice)
                violate("chart-touches-itself", name(chart) + " passes a vertex of its boundary twice",
                        {chart});
        }
    }

    void collect_charts_at_corners() {
        for (const int corner : graph_.layout.corners) {
            auto& charts = charts_at_[corner];
            for (const auto f : mesh_.vf_range(mesh_.vertex_handle(static_cast<unsigned>(corner))))
                charts.push_back(graph_.layout.patch_of_triangle[at(f.idx())]);
            std::sort(charts.begin(), charts.end());
            charts.erase(std::unique(charts.begin(), charts.end()), charts.end());
        }
    }

    int end_chart(int corner, int axis) const {
        const auto found = charts_at_.find(corner);
        if (found == charts_at_.end()) return -1;
        for (const int chart : found->second)
            if (axis_of(graph_.charts[at(chart)].label) == axis) return chart;
        return -1;
    }

    void collect_sides() {
        // A chain and its reverse are one side: known by the mesh edge at its end with the smaller vertices.
        std::map<std::array<int, 2>, std::pair<int, bool>> side_at;  // directed first edge of the reverse
        for (std::size_t p = 0; p < graph_.layout.patches.size(); ++p) {
            for (const auto& loop : graph_.layout.patches[p].loops) {
                auto& uses = graph_.charts[p].loops.emplace_back();
                for (const Chain& chain : loop) {
                    const auto known = side_at.find({chain[0], chain[1]});
                    if (known != side_at.end()) {
                        graph_.sides[at(known->second.first)].charts[1] = static_cast<int>(p);
                        uses.push_back({known->second.first, true});
                        continue;
                    }
                    const int side = static_cast<int>(graph_.sides.size());
                    ChartSide& fresh = graph_.sides.emplace_back();
                    fresh.charts[0] = static_cast<int>(p);
                    fresh.chain = chain;
                    side_at[{chain.back(), chain[chain.size() - 2]}] = {side, true};
                    uses.push_back({side, false});
                }
            }
        }
        for (ChartSide& side : graph_.sides) measure(side);
    }

    void measure(ChartSide& side) {
        const int a = axis_of(graph_.charts[at(side.charts[0])].label);
        const int b = side.charts[1] < 0 ? a : axis_of(graph_.charts[at(side.charts[1])].label);
        if (a == b) {
            violate("opposite-labels-adjacent",
                    name(side.charts[0]) + " and " + name(std::max(side.charts[1], 0)) +
                        " face along one axis and share a side at vertex " +
                        std::to_string(side.chain.front()),
                    {side.charts[0], side.charts[1]});
            return;
        }
        side.axis = third_axis(a, b);
        const auto point = [&](int v) {
            return to_eigen(mesh_.point(mesh_.vertex_handle(static_cast<unsigned>(v))));
        };
        for (std::size_t i = 1; i < side.chain.size(); ++i)
            side.length += (point(side.chain[i]) - point(side.chain[i - 1])).norm();
        side.rise = (point(side.chain.back()) - point(side.chain.front()))[side.axis];
        side.direction = side.rise >= 0 ? 1 : -1;
        side.ends = {end_chart(side.chain.front(), side.axis), end_chart(side.chain.back(), side.axis)};
        for (std::size_t k = 0; k < 2; ++k) {
            if (side.ends[k] >= 0) continue;
            const int vertex = k == 0 ? side.chain.front() : side.chain.back();
            violate("side-without-end",
                    "at vertex " + std::to_string(vertex) + " no chart ends the side between " +
                        name(side.charts[0]) + " and " + name(side.charts[1]),
                    {side.charts[0], side.charts[1]});
        }
    }

    void join_planes() {
        Components planes(graph_.charts.size());
        for (const auto& [corner, charts] : charts_at_) {
            for (const int one : charts) {
                for (const int other : charts) {
                    if (axis_of(graph_.charts[at(one)].label) != axis_of(graph_.charts[at(other)].label))
                        continue;
                    planes.join(at(one), at(other));
                }
            }
        }
        for (std::size_t c = 0; c < graph_.charts.size(); ++c)
            graph_.same_plane.push_back(static_cast<int>(planes.root(c)));
    }

    /// Quarter turns to the left along a loop, seen from outside; a turn back counts as what makes up
    /// `wanted`.
    int missing_turns(const GraphChart& chart, const std::vector<SideUse>& loop, int wanted) const {
        int turns = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const SideUse& one = loop[i];
            const SideUse& next = loop[(i + 1) % loop.size()];
            const ChartSide& a = graph_.sides[at(one.side)];
            const ChartSide& b = graph_.sides[at(next.side)];
            const int da = a.direction * (one.reversed ? -1 : 1);
            const int db = b.direction * (next.reversed ? -1 : 1);
            if (a.axis == b.axis) {
                if (da != db) return 0;
                continue;
            }
            const int cyclic = (a.axis + 1) % 3 == b.axis ? 1 : -1;
            turns += da * db * cyclic * sign_of(chart.label);
        }
        return std::abs(turns - wanted);
    }

    int badness(int c) const {
        const GraphChart& chart = graph_.charts[at(c)];
        std::size_t outer = 0;
        double longest = -1.0;
        for (std::size_t l = 0; l < chart.loops.size(); ++l) {
            double length = 0.0;
            for (const SideUse& use : chart.loops[l]) length += graph_.sides[at(use.side)].length;
            if (length > longest) {
                longest = length;
                outer = l;
            }
        }
        int sum = 0;
        for (std::size_t l = 0; l < chart.loops.size(); ++l)
            sum += missing_turns(chart, chart.loops[l], l == outer ? 4 : -4);
        return sum;
    }

    /// A chart's boundary closes only if it turns once to the left in all (each hole once to the right).
    /// Where the directions in space do not give that, the sides that point least clearly are turned round.
    void turn_sides() {
        std::vector<int> bad(graph_.charts.size());
        for (std::size_t c = 0; c < bad.size(); ++c) bad[c] = badness(static_cast<int>(c));
        for (std::size_t round = 0; round < graph_.sides.size(); ++round) {
            int best = -1;
            int best_gain = 0;
            double best_cost = 0.0;
            for (std::size_t s = 0; s < graph_.sides.size(); ++s) {
                ChartSide& side = graph_.sides[s];
                const int now = bad[at(side.charts[0])] + bad[at(side.charts[1])];
                if (now == 0) continue;
                side.direction = -side.direction;
                const int gain = now - badness(side.charts[0]) - badness(side.charts[1]);
                side.direction = -side.direction;
                const double cost = std::abs(side.rise);
                if (gain > best_gain || (gain == best_gain && gain > 0 && cost < best_cost)) {
                    best = static_cast<int>(s);
                    best_gain = gain;
                    best_cost = cost;
                }
            }
            if (best < 0) return;
            ChartSide& side = graph_.sides[at(best)];
            side.direction = -side.direction;
            graph_.turned_sides.push_back(best);
            for (const int c : side.charts) bad[at(c)] = badness(c);
        }
    }

    const TriangleMesh& mesh_;
    ChartGraph graph_;
    std::map<int, std::vector<int>> charts_at_;  ///< by corner vertex
};

}  // namespace

ChartGraph build_chart_graph(const TriangleMesh& labelled) {
    return GraphBuilder(labelled).build();
}

}  // namespace hex
