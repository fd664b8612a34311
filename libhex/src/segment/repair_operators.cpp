#include "segment/repair_operators.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

void sort_unique(std::vector<int>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

using Reach = std::pair<double, int>;  ///< price, item
using ReachQueue = std::priority_queue<Reach, std::vector<Reach>, std::greater<>>;

}  // namespace

RepairOperators::RepairOperators(const LabelSurface& surface, const std::vector<int>& labels,
                                 const LabelCharts& charts)
    : surface_(&surface), labels_(&labels), charts_(&charts) {}

void RepairOperators::add(const char* repair, const std::vector<int>& triangles, int label,
                          std::vector<LabelChange>& out) const {
    LabelChange change{repair, {}};
    for (const int t : triangles) change.labels.emplace_back(t, label);
    finish(std::move(change), out);
}

void RepairOperators::finish(LabelChange change, std::vector<LabelChange>& out) const {
    // The triangles of a polygon go with its first one that changes.
    const std::size_t asked = change.labels.size();
    for (std::size_t i = 0; i < asked; ++i) {
        const auto [begin, end] = surface_->polygons[at(change.labels[i].first)];
        if (end - begin == 1) continue;
        for (int t = begin; t < end; ++t) change.labels.emplace_back(t, change.labels[i].second);
    }
    std::stable_sort(change.labels.begin(), change.labels.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    change.labels.erase(std::unique(change.labels.begin(), change.labels.end(), same), change.labels.end());
    std::erase_if(change.labels, [&](const auto& c) { return (*labels_)[at(c.first)] == c.second; });
    if (!change.labels.empty()) out.push_back(std::move(change));
}

template <class Inside>
std::vector<std::vector<int>> RepairOperators::rings(const std::vector<int>& vertices, int count,
                                                     const Inside& inside) const {
    std::vector<std::vector<int>> found;
    std::vector<int> all;
    std::vector<int> front = vertices;
    for (int ring = 0; ring < count; ++ring) {
        std::vector<int> next;
        for (const int v : front) {
            for (const int t : surface_->arrays.vertex_triangles[at(v)]) {
                if (inside(t)) next.push_back(t);
            }
        }
        sort_unique(next);
        std::vector<int> merged;
        std::set_union(all.begin(), all.end(), next.begin(), next.end(), std::back_inserter(merged));
        if (merged.size() == all.size()) break;
        all = std::move(merged);
        found.push_back(all);
        front.clear();
        for (const int t : next) {
            for (const int v : surface_->arrays.corners[at(t)]) front.push_back(v);
        }
        sort_unique(front);
    }
    return found;
}

std::vector<int> RepairOperators::neighbour_charts(int chart) const {
    std::vector<int> found;
    for (const int b : charts_->charts[at(chart)].boundaries) {
        for (const int c : charts_->boundaries[at(b)].charts) {
            if (c != chart) found.push_back(c);
        }
    }
    sort_unique(found);
    return found;
}

void RepairOperators::merge_chart(int chart, std::vector<LabelChange>& out) const {
    std::vector<int> labels;
    for (const int c : neighbour_charts(chart)) labels.push_back(charts_->charts[at(c)].label);
    sort_unique(labels);
    for (const int label : labels) add("merge-chart", charts_->charts[at(chart)].triangles, label, out);
}

void RepairOperators::relabel_chart(int chart, std::vector<LabelChange>& out) const {
    for (int label = 0; label < 6; ++label)
        add("relabel-chart", charts_->charts[at(chart)].triangles, label, out);
}

void RepairOperators::dissolve_chart(int chart, std::vector<LabelChange>& out) const {
    const LabelChart& old = charts_->charts[at(chart)];
    std::vector<std::pair<int, int>> taken;
    struct Step {
        double price;
        int triangle;
        int label;
        bool operator>(const Step& o) const {
            return std::tie(price, triangle, label) > std::tie(o.price, o.triangle, o.label);
        }
    };
    std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
    const auto push = [&](int t, int label) {
        const double extra = surface_->costs[at(t)][at(label)] / std::max(surface_->areas[at(t)], 1e-300);
        queue.push({extra, t, label});
    };
    const auto inside = [&](int t) { return t >= 0 && charts_->chart_of_triangle[at(t)] == chart; };
    for (const int t : old.triangles) {
        for (const int n : surface_->arrays.neighbours[at(t)]) {
            if (n >= 0 && !inside(n) && (*labels_)[at(n)] != old.label) push(t, (*labels_)[at(n)]);
        }
    }
    std::vector<char> mark(surface_->size(), 0);
    while (!queue.empty()) {
        const Step step = queue.top();
        queue.pop();
        if (mark[at(step.triangle)]) continue;
        mark[at(step.triangle)] = 1;
        taken.emplace_back(step.triangle, step.label);
        for (const int n : surface_->arrays.neighbours[at(step.triangle)]) {
            if (inside(n) && !mark[at(n)]) push(n, step.label);
        }
    }
    finish({"dissolve-chart", std::move(taken)}, out);
}

void RepairOperators::insert_chart(int boundary, std::vector<LabelChange>& out) const {
    constexpr std::array widths = {1, 2, 4};
    const LabelBoundary& b = charts_->boundaries[at(boundary)];
    for (int side = 0; side < 3; ++side) {
        const auto inside = [&](int t) {
            const int c = charts_->chart_of_triangle[at(t)];
            return (side != 1 && c == b.charts[0]) || (side != 0 && c == b.charts[1]);
        };
        std::vector<int> middle(b.vertices.begin() + 1, b.vertices.end() - 1);
        for (const bool ends : {true, false}) {
            if (!ends && middle.empty()) continue;
            const auto strips = rings(ends ? b.vertices : middle, widths.back(), inside);
            for (const int width : widths) {
                if (at(width) > strips.size()) break;
                for (int label = 0; label < 6; ++label) {
                    if (label / 2 == charts_->charts[at(b.charts[0])].label / 2 ||
                        label / 2 == charts_->charts[at(b.charts[1])].label / 2)
                        continue;
                    add("insert-chart", strips[at(width - 1)], label, out);
                }
            }
            // The triangles along the boundary alone, without those that only touch it.
            if (!ends || side == 2) continue;
            std::vector<int> beside;
            for (const auto& pair : b.triangles) beside.push_back(pair[at(side)]);
            for (int label = 0; label < 6; ++label) {
                if (label / 2 != charts_->charts[at(b.charts[0])].label / 2 &&
                    label / 2 != charts_->charts[at(b.charts[1])].label / 2)
                    add("insert-chart", beside, label, out);
            }
        }
    }
}

void RepairOperators::grow_chart(int chart, std::vector<LabelChange>& out) const {
    constexpr std::array widths = {1, 2, 4};
    const LabelChart& old = charts_->charts[at(chart)];
    std::vector<int> from = neighbour_charts(chart);
    if (from.size() > 1) from.push_back(-1);  // all of them
    for (const int other : from) {
        std::vector<int> rim;
        for (const int b : old.boundaries) {
            const LabelBoundary& boundary = charts_->boundaries[at(b)];
            if (other >= 0 && boundary.charts[0] != other && boundary.charts[1] != other) continue;
            rim.insert(rim.end(), boundary.vertices.begin(), boundary.vertices.end());
        }
        sort_unique(rim);
        const auto grown = rings(rim, widths.back(), [&](int t) {
            const int c = charts_->chart_of_triangle[at(t)];
            return c != chart && (other < 0 || c == other);
        });
        for (const int width : widths) {
            if (at(width) <= grown.size()) add("grow-chart", grown[at(width - 1)], old.label, out);
        }
    }
}

void RepairOperators::fill_corner(int vertex, std::vector<LabelChange>& out) const {
    const auto star = rings({vertex}, 3, [](int) { return true; });
    std::vector<int> labels;
    for (const int t : star.back()) labels.push_back((*labels_)[at(t)]);
    sort_unique(labels);
    for (const int label : labels) {
        // Rings of all labels, and the part of each label in the first two.
        for (std::size_t ring = 0; ring < star.size(); ++ring) {
            add("fill-corner", star[ring], label, out);
            for (const int from : labels) {
                if (from == label) continue;
                std::vector<int> part;
                for (const int t : star[ring]) {
                    if ((*labels_)[at(t)] == from) part.push_back(t);
                }
                add("fill-corner", part, label, out);
            }
        }
    }
    for (const int t : star.front()) {
        for (const int n : surface_->arrays.neighbours[at(t)]) {
            if (n >= 0) add("fill-corner", {t}, (*labels_)[at(n)], out);
        }
    }
}

void RepairOperators::pull_chart(int chart, std::vector<LabelChange>& out) const {
    for (int label = 0; label < 6; ++label) pull_label(chart, label, out);
}

void RepairOperators::pull_label(int chart, int label, std::vector<LabelChange>& out) const {
    // Dijkstra over the triangles outside, from the rim of the chart to the first of the label that is not
    // one of the chart's own neighbours.
    const LabelChart& old = charts_->charts[at(chart)];
    const std::vector<int> beside = neighbour_charts(chart);
    const auto chart_of = [&](int t) { return charts_->chart_of_triangle[at(t)]; };
    const auto is_goal = [&](int t) {
        const int c = chart_of(t);
        return c != chart && (*labels_)[at(t)] == label &&
               !std::binary_search(beside.begin(), beside.end(), c);
    };
    constexpr double stretch = 0.01;  // price of a path's length, beside that of the labels
    std::vector<double> price(surface_->size(), std::numeric_limits<double>::infinity());
    std::vector<int> from(surface_->size(), -1);
    ReachQueue queue;
    const auto reach = [&](int t, int before, double base) {
        const double step =
            std::max(0.0, surface_->costs[at(t)][at(label)] - surface_->costs[at(t)][at((*labels_)[at(t)])]) +
            stretch * std::sqrt(surface_->areas[at(t)]);
        if (!(base + step < price[at(t)])) return;
        price[at(t)] = base + step;
        from[at(t)] = before;
        queue.emplace(price[at(t)], t);
    };
    for (const int b : old.boundaries) {
        const LabelBoundary& boundary = charts_->boundaries[at(b)];
        const std::size_t outside = boundary.charts[0] == chart ? 1 : 0;
        for (const auto& pair : boundary.triangles) reach(pair[outside], -1, 0.0);
    }
    constexpr double most = 0.1;
    while (!queue.empty()) {
        const auto [base, t] = queue.top();
        queue.pop();
        if (base > price[at(t)]) continue;
        if (base > most) return;
        if (is_goal(t)) {
            std::vector<int> path;
            for (int p = from[at(t)]; p >= 0; p = from[at(p)]) path.push_back(p);
            if (path.empty()) return;
            std::vector<int> vertices;
            for (const int p : path) {
                for (const int v : surface_->arrays.corners[at(p)]) vertices.push_back(v);
            }
            sort_unique(vertices);
            add("pull-chart", path, label, out);
            const auto wider = rings(vertices, 2, [&](int u) { return chart_of(u) != chart; });
            for (const auto& strip : wider) add("pull-chart", strip, label, out);
            return;
        }
        for (const int n : surface_->arrays.neighbours[at(t)]) {
            if (n >= 0 && chart_of(n) != chart) reach(n, t, base);
        }
    }
}

void RepairOperators::split_chart(int chart, std::vector<LabelChange>& out) const {
    const LabelChart& old = charts_->charts[at(chart)];
    for (int label = 0; label < 6; ++label) {
        if (label / 2 == old.label / 2) continue;
        std::size_t last = 0;
        for (const double least : {0.65, 0.5, 0.35}) {
            std::vector<int> part;
            for (const int t : old.triangles) {
                if (surface_->cosine(t, label) > least) part.push_back(t);
            }
            if (part.size() == last || part.size() == old.triangles.size()) continue;
            last = part.size();
            add("split-chart", part, label, out);
        }
    }
    // Smooth faces between creases; more than a few are no faces of a CAD part.
    constexpr double smooth = 0.98;  // least cosine between neighbours' normals
    constexpr std::size_t most_faces = 8;
    std::vector<std::vector<int>> faces;
    std::vector<int> members = old.triangles;
    std::vector<char> seen(members.size(), 0);
    const auto index_of = [&](int t) {
        const auto it = std::lower_bound(members.begin(), members.end(), t);
        return it != members.end() && *it == t ? static_cast<int>(it - members.begin()) : -1;
    };
    for (std::size_t start = 0; start < members.size(); ++start) {
        if (seen[start]) continue;
        if (faces.size() == most_faces) return;
        std::vector<int> face = {members[start]};
        seen[start] = 1;
        for (std::size_t next = 0; next < face.size(); ++next) {
            for (const int n : surface_->arrays.neighbours[at(face[next])]) {
                const int i = n < 0 ? -1 : index_of(n);
                if (i < 0 || seen[at(i)] ||
                    surface_->normals[at(n)].dot(surface_->normals[at(face[next])]) < smooth)
                    continue;
                seen[at(i)] = 1;
                face.push_back(n);
            }
        }
        faces.push_back(std::move(face));
    }
    if (faces.size() < 2) return;
    for (const auto& face : faces) {
        for (int label = 0; label < 6; ++label) add("split-chart", face, label, out);
    }
}

}  // namespace hex
