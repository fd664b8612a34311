#include "segment/label_energy.h"

#include <algorithm>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

}  // namespace

LabelEnergy::LabelEnergy(const LabelSurface& surface)
    : surface_(&surface),
      chart_(surface.size()),
      visited_(surface.edges.size(), 0),
      degree_(surface.points.size(), 0),
      edges_at_(surface.points.size()) {}

LabelScore LabelEnergy::evaluate(const std::vector<int>& labels) {
    LabelScore score;
    for (std::size_t t = 0; t < labels.size(); ++t) score.infidelity += surface_->costs[t][at(labels[t])];
    flood_charts(labels);
    score.charts = static_cast<int>(sides_.size());
    collect_boundary_edges(labels, score);
    for (const int e : boundary_edges_) {
        for (const int v : surface_->edges[at(e)].vertices) {
            if (degree_[at(v)] >= 3 && !visited_[at(e)]) walk(v, e, labels, score);
        }
    }
    for (const int e : boundary_edges_) {
        if (!visited_[at(e)]) walk(surface_->edges[at(e)].vertices[0], e, labels, score);
    }
    for (const int e : boundary_edges_) {
        visited_[at(e)] = 0;
        for (const int v : surface_->edges[at(e)].vertices) {
            if (degree_[at(v)] > 3) ++score.crossings;
            degree_[at(v)] = 0;
        }
    }
    for (const int sides : sides_) {
        score.missing_sides += std::max(0, 4 - sides);
        score.few_sided += sides < 4 ? 1 : 0;
    }
    return score;
}

void LabelEnergy::flood_charts(const std::vector<int>& labels) {
    std::fill(chart_.begin(), chart_.end(), -1);
    sides_.clear();
    for (std::size_t start = 0; start < labels.size(); ++start) {
        if (chart_[start] >= 0) continue;
        const int chart = static_cast<int>(sides_.size());
        sides_.push_back(0);
        chart_[start] = chart;
        stack_.assign(1, static_cast<int>(start));
        while (!stack_.empty()) {
            const int t = stack_.back();
            stack_.pop_back();
            for (const int n : surface_->arrays.neighbours[at(t)]) {
                if (n < 0 || chart_[at(n)] >= 0 || labels[at(n)] != labels[start]) continue;
                chart_[at(n)] = chart;
                stack_.push_back(n);
            }
        }
    }
}

void LabelEnergy::collect_boundary_edges(const std::vector<int>& labels, LabelScore& score) {
    boundary_edges_.clear();
    for (std::size_t e = 0; e < surface_->edges.size(); ++e) {
        const LabelEdge& edge = surface_->edges[e];
        if (labels[at(edge.triangles[0])] == labels[at(edge.triangles[1])]) continue;
        boundary_edges_.push_back(static_cast<int>(e));
        score.cut += edge.weight;
        for (const int v : edge.vertices) {
            const int degree = degree_[at(v)]++;
            if (degree < 2) edges_at_[at(v)][at(degree)] = static_cast<int>(e);
        }
    }
}

void LabelEnergy::walk(int vertex, int edge, const std::vector<int>& labels, LabelScore& score) {
    const LabelEdge& first = surface_->edges[at(edge)];
    const int left = labels[at(first.triangles[0])];
    const int right = labels[at(first.triangles[1])];
    for (const int t : first.triangles) ++sides_[at(chart_[at(t)])];
    const bool opposite = opposite_labels(left, right);
    if (opposite) ++score.opposite;
    const int axis = opposite ? 0 : 3 - left / 2 - right / 2;
    int sense = 0;
    while (true) {
        visited_[at(edge)] = 1;
        const LabelEdge& here = surface_->edges[at(edge)];
        const int next = here.vertices[0] == vertex ? here.vertices[1] : here.vertices[0];
        const double rise = surface_->points[at(next)][axis] - surface_->points[at(vertex)][axis];
        const int now = rise > surface_->flat ? 1 : rise < -surface_->flat ? -1 : 0;
        if (now != 0) {
            if (sense != 0 && now != sense && !opposite) ++score.turns;
            sense = now;
        }
        vertex = next;
        if (degree_[at(vertex)] >= 3) return;
        const auto& both = edges_at_[at(vertex)];
        const int other = both[0] == edge ? both[1] : both[0];
        if (visited_[at(other)]) return;
        edge = other;
    }
}

}  // namespace hex
