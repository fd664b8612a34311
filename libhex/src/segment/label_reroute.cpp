#include "segment/label_reroute.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// How a path is priced.
struct Course {
    double straightness;  ///< price of its length, beside that of running where the normals are decided
    double against;       ///< price of a length against the axis; negative when that is forbidden
};

/// Finds paths for one boundary.
class Router {
  public:
    Router(const LabelSurface& surface, const LabelCharts& charts, int boundary)
        : surface_(surface), charts_(charts), boundary_(charts.boundaries[at(boundary)]) {
        const int v = boundary_.vertices[0];
        const int w = boundary_.vertices[1];
        // The pair is in the order of the charts; the left triangle winds from v to w.
        left_ = winds(boundary_.triangles[0][0], v, w) ? boundary_.charts[0] : boundary_.charts[1];
        right_ = left_ == boundary_.charts[0] ? boundary_.charts[1] : boundary_.charts[0];
        axis_ = boundary_axis(label_of(left_), label_of(right_));
        mark_vertices(boundary);
    }

    bool open() const {
        return axis_ >= 0 && boundary_.vertices.front() != boundary_.vertices.back() && rise() != 0.0;
    }

    /// The edges of the cheapest path from the first to the last vertex, each as (from, to); empty when there
    /// is none.
    std::vector<int> path(const Course& course) const {
        const int start = boundary_.vertices.front();
        const int goal = boundary_.vertices.back();
        const double sense = rise() > 0.0 ? 1.0 : -1.0;
        std::vector<double> price(surface_.points.size(), std::numeric_limits<double>::infinity());
        std::vector<int> from(surface_.points.size(), -1);
        using Reach = std::pair<double, int>;
        std::priority_queue<Reach, std::vector<Reach>, std::greater<>> queue;
        price[at(start)] = 0.0;
        queue.emplace(0.0, start);
        while (!queue.empty()) {
            const auto [base, v] = queue.top();
            queue.pop();
            if (base > price[at(v)]) continue;
            if (v == goal) break;
            for (const int t : surface_.arrays.vertex_triangles[at(v)]) {
                if (!inside(t)) continue;
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto& corners = surface_.arrays.corners[at(t)];
                    if (corners[k] != v) continue;
                    const int w = corners[(k + 1) % 3];
                    const int other = surface_.arrays.neighbours[at(t)][k];
                    if (!inside(other) || !(free_[at(w)] || w == goal)) continue;
                    const LabelEdge& edge = surface_.edges[at(surface_.edges_of_triangle[at(t)][k])];
                    const double step =
                        sense * (surface_.points[at(w)][axis_] - surface_.points[at(v)][axis_]);
                    const double wrong = std::max(0.0, undecided(other)) + std::max(0.0, -undecided(t));
                    double cost = course.straightness * edge.weight + edge.length * wrong;
                    if (step <= 2.0 * surface_.flat) {
                        if (course.against < 0.0) continue;
                        cost += course.against * edge.length;
                    }
                    if (!(base + cost < price[at(w)])) continue;
                    price[at(w)] = base + cost;
                    from[at(w)] = v;
                    queue.emplace(price[at(w)], w);
                }
            }
        }
        std::vector<int> vertices;
        if (from[at(goal)] < 0) return vertices;
        for (int v = goal; v >= 0; v = from[at(v)]) vertices.push_back(v);
        std::reverse(vertices.begin(), vertices.end());
        return vertices;
    }

    /// The labels that a path asks for: those of the left chart on its left, of the right one on its right.
    /// Empty when it does not separate the two.
    LabelChange labels_for(const std::vector<int>& path) const {
        std::vector<int> next_on_path(surface_.points.size(), -1);
        for (std::size_t i = 0; i + 1 < path.size(); ++i) next_on_path[at(path[i])] = path[i + 1];
        std::vector<int> side(surface_.size(), -1);  // the chart a triangle shall belong to
        std::vector<int> queue;
        const auto seed = [&](int t, int chart) {
            if (side[at(t)] < 0) queue.push_back(t);
            side[at(t)] = chart;
        };
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            for (const int t : surface_.arrays.vertex_triangles[at(path[i])]) {
                if (winds(t, path[i], path[i + 1])) seed(t, left_);
                if (winds(t, path[i + 1], path[i])) seed(t, right_);
            }
        }
        for (std::size_t next = 0; next < queue.size(); ++next) {
            const int t = queue[next];
            for (std::size_t k = 0; k < 3; ++k) {
                const int n = surface_.arrays.neighbours[at(t)][k];
                if (!inside(n)) continue;
                const int a = surface_.arrays.corners[at(t)][k];
                const int b = surface_.arrays.corners[at(t)][(k + 1) % 3];
                if (next_on_path[at(a)] == b || next_on_path[at(b)] == a) continue;
                const bool crosses = charts_.chart_of_triangle[at(t)] != charts_.chart_of_triangle[at(n)];
                if (crosses && !(on_boundary_[at(a)] && on_boundary_[at(b)])) continue;
                if (side[at(n)] >= 0 && side[at(n)] != side[at(t)]) return {};
                if (side[at(n)] < 0) {
                    side[at(n)] = side[at(t)];
                    queue.push_back(n);
                }
            }
        }
        LabelChange change{"straighten-boundary", {}};
        std::sort(queue.begin(), queue.end());
        for (const int t : queue) {
            if (side[at(t)] != charts_.chart_of_triangle[at(t)])
                change.labels.emplace_back(t, label_of(side[at(t)]));
        }
        return change;
    }

  private:
    int label_of(int chart) const { return charts_.charts[at(chart)].label; }
    double rise() const {
        const double d = surface_.points[at(boundary_.vertices.back())][axis_] -
                         surface_.points[at(boundary_.vertices.front())][axis_];
        return std::abs(d) > surface_.flat ? d : 0.0;
    }
    bool inside(int t) const {
        return t >= 0 &&
               (charts_.chart_of_triangle[at(t)] == left_ || charts_.chart_of_triangle[at(t)] == right_);
    }
    bool winds(int t, int v, int w) const {
        const auto& c = surface_.arrays.corners[at(t)];
        return (c[0] == v && c[1] == w) || (c[1] == v && c[2] == w) || (c[2] == v && c[0] == w);
    }
    /// How much better the left label fits than the right one.
    double undecided(int t) const {
        return surface_.cosine(t, label_of(left_)) - surface_.cosine(t, label_of(right_));
    }

    /// Free are the vertices that lie on no other boundary.
    void mark_vertices(int boundary) {
        free_.assign(surface_.points.size(), 1);
        on_boundary_.assign(surface_.points.size(), 0);
        for (const int chart : {left_, right_}) {
            for (const int b : charts_.charts[at(chart)].boundaries) {
                if (b == boundary) continue;
                for (const int v : charts_.boundaries[at(b)].vertices) free_[at(v)] = 0;
            }
        }
        for (const int v : boundary_.vertices) on_boundary_[at(v)] = 1;
    }

    const LabelSurface& surface_;
    const LabelCharts& charts_;
    const LabelBoundary& boundary_;
    int left_ = 0;
    int right_ = 0;
    int axis_ = -1;
    std::vector<char> free_;
    std::vector<char> on_boundary_;
};

}  // namespace

int boundary_axis(int label, int other) {
    return label / 2 == other / 2 ? -1 : 3 - label / 2 - other / 2;
}

int count_turns(const LabelSurface& surface, const LabelCharts& charts, const LabelBoundary& boundary) {
    const int axis = boundary_axis(charts.charts[at(boundary.charts[0])].label,
                                   charts.charts[at(boundary.charts[1])].label);
    if (axis < 0) return 0;
    int turns = 0;
    int sense = 0;
    for (std::size_t i = 1; i < boundary.vertices.size(); ++i) {
        const double rise = surface.points[at(boundary.vertices[i])][axis] -
                            surface.points[at(boundary.vertices[i - 1])][axis];
        const int now = rise > surface.flat ? 1 : rise < -surface.flat ? -1 : 0;
        if (now == 0) continue;
        if (sense != 0 && now != sense) ++turns;
        sense = now;
    }
    return turns;
}

void straighten_boundary(const LabelSurface& surface, const std::vector<int>& labels,
                         const LabelCharts& charts, int boundary, std::vector<LabelChange>& out) {
    const Router router(surface, charts, boundary);
    if (!router.open()) return;
    const RepairOperators operators(surface, labels, charts);
    constexpr double never = -1.0;
    std::vector<std::vector<int>> tried = {charts.boundaries[at(boundary)].vertices};
    for (const Course& course :
         {Course{0.1, never}, Course{0.5, never}, Course{2.0, never}, Course{0.3, 10.0}, Course{1.0, 1.0}}) {
        auto path = router.path(course);
        if (path.empty() || std::find(tried.begin(), tried.end(), path) != tried.end()) continue;
        operators.finish(router.labels_for(path), out);
        tried.push_back(std::move(path));
    }
}

}  // namespace hex
