#include "segment/label_energy.h"

#include <algorithm>
#include <cmath>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

}  // namespace

LabelEnergy::LabelEnergy(const LabelSurface& surface)
    : surface_(&surface),
      node_(surface.size()),
      visited_(surface.edges.size(), 0),
      degree_(surface.points.size(), 0),
      edges_at_(surface.points.size()) {}

LabelScore LabelEnergy::evaluate(const std::vector<int>& labels) {
    prepare(labels, {});
    return evaluate_prepared(labels);
}

void LabelEnergy::prepare(const std::vector<int>& labels, const std::vector<int>& region) {
    constexpr int unknown = -1;
    region_ = region;
    std::fill(node_.begin(), node_.end(), unknown);
    nodes_ = 0;
    for (const int t : region_) node_[at(t)] = nodes_++;
    const int in_region = nodes_;
    outer_infidelity_ = 0.0;
    for (std::size_t start = 0; start < labels.size(); ++start) {
        if (node_[start] < in_region && node_[start] != unknown) continue;
        outer_infidelity_ += surface_->costs[start][at(labels[start])];
        if (node_[start] != unknown) continue;
        node_[start] = nodes_;
        stack_.assign(1, static_cast<int>(start));
        while (!stack_.empty()) {
            const int t = stack_.back();
            stack_.pop_back();
            for (const int n : surface_->arrays.neighbours[at(t)]) {
                if (n < 0 || node_[at(n)] != unknown || labels[at(n)] != labels[start]) continue;
                node_[at(n)] = nodes_;
                stack_.push_back(n);
            }
        }
        ++nodes_;
    }
    inner_edges_.clear();
    outer_edges_.clear();
    for (std::size_t e = 0; e < surface_->edges.size(); ++e) {
        const auto [left, right] = surface_->edges[e].triangles;
        if (node_[at(left)] < in_region || node_[at(right)] < in_region)
            inner_edges_.push_back(static_cast<int>(e));
        else if (labels[at(left)] != labels[at(right)])
            outer_edges_.push_back(static_cast<int>(e));
    }
}

LabelScore LabelEnergy::evaluate_prepared(const std::vector<int>& labels) {
    LabelScore score;
    score.infidelity = outer_infidelity_;
    for (const int t : region_) score.infidelity += surface_->costs[at(t)][at(labels[at(t)])];
    parent_.resize(at(nodes_));
    for (int node = 0; node < nodes_; ++node) parent_[at(node)] = node;
    sides_.assign(at(nodes_), 0);
    boundary_edges_.clear();
    order_.clear();
    score.charts = nodes_;
    for (const int e : outer_edges_) add_boundary_edge(e, score);
    for (const int e : inner_edges_) {
        const auto [left, right] = surface_->edges[at(e)].triangles;
        if (labels[at(left)] != labels[at(right)]) {
            add_boundary_edge(e, score);
            continue;
        }
        const int a = find(node_[at(left)]);
        const int b = find(node_[at(right)]);
        if (a == b) continue;
        parent_[at(b)] = a;
        --score.charts;
    }
    for (const int e : boundary_edges_) {
        for (const int v : surface_->edges[at(e)].vertices) {
            if (degree_[at(v)] >= 3 && !visited_[at(e)]) walk(v, e, labels, score);
        }
    }
    for (const int e : boundary_edges_) {
        if (visited_[at(e)]) continue;
        walk(surface_->edges[at(e)].vertices[0], e, labels, score);
        ++score.closed;
    }
    order_.conflicts();
    score.disorder = order_.disorder();
    for (const int e : boundary_edges_) {
        visited_[at(e)] = 0;
        for (const int v : surface_->edges[at(e)].vertices) {
            if (degree_[at(v)] > 3) ++score.crossings;
            degree_[at(v)] = 0;
        }
    }
    for (int node = 0; node < nodes_; ++node) {
        if (parent_[at(node)] != node) continue;
        score.missing_sides += std::max(0, 4 - sides_[at(node)]);
        score.few_sided += sides_[at(node)] < 4 ? 1 : 0;
    }
    return score;
}

int LabelEnergy::find(int node) {
    while (parent_[at(node)] != node) {
        parent_[at(node)] = parent_[at(parent_[at(node)])];
        node = parent_[at(node)];
    }
    return node;
}

void LabelEnergy::add_boundary_edge(int e, LabelScore& score) {
    const LabelEdge& edge = surface_->edges[at(e)];
    boundary_edges_.push_back(e);
    score.cut += edge.weight;
    for (const int v : edge.vertices) {
        const int degree = degree_[at(v)]++;
        if (degree < 2) edges_at_[at(v)][at(degree)] = e;
    }
}

void LabelEnergy::walk(int vertex, int edge, const std::vector<int>& labels, LabelScore& score) {
    const LabelEdge& first = surface_->edges[at(edge)];
    const int left = labels[at(first.triangles[0])];
    const int right = labels[at(first.triangles[1])];
    for (const int t : first.triangles) ++sides_[at(find(node_[at(t)]))];
    const bool opposite = opposite_labels(left, right);
    if (opposite) ++score.opposite;
    const int axis = opposite ? 0 : 3 - left / 2 - right / 2;
    const int start = vertex;
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
        if (degree_[at(vertex)] >= 3) break;
        const auto& both = edges_at_[at(vertex)];
        const int other = both[0] == edge ? both[1] : both[0];
        if (visited_[at(other)]) return;
        edge = other;
    }
    if (opposite || degree_[at(start)] != 3 || degree_[at(vertex)] != 3) return;
    const double rise = surface_->points[at(vertex)][axis] - surface_->points[at(start)][axis];
    const int before = chart_across(axis, rise > 0.0 ? start : vertex, labels);
    const int after = chart_across(axis, rise > 0.0 ? vertex : start, labels);
    if (before >= 0 && after >= 0 && (before == after || std::abs(rise) > surface_->flat))
        order_.add({before, after, -1});
}

int LabelEnergy::chart_across(int axis, int vertex, const std::vector<int>& labels) {
    // Two of the three boundaries touch all three charts.
    for (const int e : edges_at_[at(vertex)]) {
        for (const int t : surface_->edges[at(e)].triangles) {
            if (labels[at(t)] / 2 == axis) return find(node_[at(t)]);
        }
    }
    return -1;
}

}  // namespace hex
