#include <hex/segment/charts.h>

#include <algorithm>
#include <string>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

class ChartFinder {
  public:
    ChartFinder(const TriangleMesh& mesh, const std::vector<int>& labels) : mesh_(mesh), labels_(labels) {}

    LabelCharts find() {
        collect_charts();
        mark_boundary_edges();
        collect_corners();
        collect_boundaries();
        measure_charts();
        return std::move(result_);
    }

  private:
    using Edge = TriangleMesh::EdgeHandle;

    int chart_beside(TriangleMesh::HalfedgeHandle h) const {
        const auto face = mesh_.face_handle(h);
        return face.is_valid() ? result_.chart_of_triangle[at(face.idx())] : -1;
    }

    void collect_charts() {
        auto& chart_of = result_.chart_of_triangle;
        chart_of.assign(labels_.size(), -1);
        std::vector<TriangleMesh::FaceHandle> open;
        for (const auto start : mesh_.faces()) {
            if (chart_of[at(start.idx())] >= 0) continue;
            const int chart = static_cast<int>(result_.charts.size());
            const int label = labels_[at(start.idx())];
            result_.charts.emplace_back().label = label;
            chart_of[at(start.idx())] = chart;
            open.assign(1, start);
            while (!open.empty()) {
                const auto face = open.back();
                open.pop_back();
                for (const auto next : mesh_.ff_range(face)) {
                    if (chart_of[at(next.idx())] >= 0 || labels_[at(next.idx())] != label) continue;
                    chart_of[at(next.idx())] = chart;
                    open.push_back(next);
                }
            }
        }
        for (std::size_t t = 0; t < labels_.size(); ++t)
            result_.charts[at(chart_of[t])].triangles.push_back(static_cast<int>(t));
    }

    void mark_boundary_edges() {
        boundary_.assign(mesh_.n_edges(), 0);
        edges_at_.assign(mesh_.n_vertices(), 0);
        for (const auto e : mesh_.edges()) {
            const auto h = mesh_.halfedge_handle(e, 0);
            const int left = chart_beside(h);
            const int right = chart_beside(mesh_.opposite_halfedge_handle(h));
            if (left < 0 || right < 0 || left == right) continue;
            boundary_[at(e.idx())] = 1;
            ++edges_at_[at(mesh_.from_vertex_handle(h).idx())];
            ++edges_at_[at(mesh_.to_vertex_handle(h).idx())];
        }
    }

    void collect_corners() {
        for (const auto v : mesh_.vertices()) {
            if (!is_corner(v.idx())) continue;
            LabelCorner corner{v.idx(), edges_at_[at(v.idx())], {}};
            for (const auto f : mesh_.vf_range(v))
                corner.charts.push_back(result_.chart_of_triangle[at(f.idx())]);
            std::sort(corner.charts.begin(), corner.charts.end());
            corner.charts.erase(std::unique(corner.charts.begin(), corner.charts.end()), corner.charts.end());
            result_.corners.push_back(std::move(corner));
        }
    }

    bool is_corner(int vertex) const { return edges_at_[at(vertex)] >= 3; }

    void collect_boundaries() {
        visited_.assign(mesh_.n_edges(), 0);
        for (const LabelCorner& corner : result_.corners) {
            const auto v = mesh_.vertex_handle(static_cast<unsigned>(corner.vertex));
            for (const auto h : mesh_.voh_range(v)) {
                if (open_boundary(mesh_.edge_handle(h))) walk(h);
            }
        }
        // What is left are closed boundaries without a corner.
        for (const auto e : mesh_.edges()) {
            if (open_boundary(e)) walk(mesh_.halfedge_handle(e, 0));
        }
    }

    bool open_boundary(Edge e) const { return boundary_[at(e.idx())] && !visited_[at(e.idx())]; }

    void walk(TriangleMesh::HalfedgeHandle h) {
        LabelBoundary boundary;
        const int left = chart_beside(h);
        const int right = chart_beside(mesh_.opposite_halfedge_handle(h));
        boundary.charts = {std::min(left, right), std::max(left, right)};
        boundary.vertices.push_back(mesh_.from_vertex_handle(h).idx());
        while (h.is_valid()) {
            visited_[at(mesh_.edge_handle(h).idx())] = 1;
            std::array<int, 2> beside = {mesh_.face_handle(h).idx(),
                                         mesh_.face_handle(mesh_.opposite_halfedge_handle(h)).idx()};
            if (left > right) std::swap(beside[0], beside[1]);
            boundary.triangles.push_back(beside);
            const auto end = mesh_.to_vertex_handle(h);
            boundary.vertices.push_back(end.idx());
            h = TriangleMesh::HalfedgeHandle();
            if (is_corner(end.idx())) break;
            for (const auto next : mesh_.voh_range(end)) {
                if (open_boundary(mesh_.edge_handle(next))) h = next;
            }
        }
        const int index = static_cast<int>(result_.boundaries.size());
        for (const int chart : boundary.charts) result_.charts[at(chart)].boundaries.push_back(index);
        result_.boundaries.push_back(std::move(boundary));
    }

    void measure_charts() {
        std::vector<int> last_chart_at(mesh_.n_vertices(), -1);
        for (std::size_t c = 0; c < result_.charts.size(); ++c) {
            LabelChart& chart = result_.charts[c];
            int vertices = 0;
            int rim = 0;
            for (const int t : chart.triangles) {
                for (const auto h : mesh_.fh_range(mesh_.face_handle(static_cast<unsigned>(t)))) {
                    int& last = last_chart_at[at(mesh_.to_vertex_handle(h).idx())];
                    if (last != static_cast<int>(c)) ++vertices;
                    last = static_cast<int>(c);
                    if (chart_beside(mesh_.opposite_halfedge_handle(h)) != static_cast<int>(c)) ++rim;
                }
            }
            const int faces = static_cast<int>(chart.triangles.size());
            chart.euler_characteristic = vertices - (3 * faces + rim) / 2 + faces;
        }
    }

    const TriangleMesh& mesh_;
    const std::vector<int>& labels_;
    LabelCharts result_;
    std::vector<char> boundary_;  ///< edges between different charts
    std::vector<char> visited_;
    std::vector<int> edges_at_;  ///< boundary edges that end in a vertex
};

std::string chart_name(const LabelCharts& charts, int chart) {
    return "chart " + std::to_string(chart) + " (" + label_name(charts.charts[at(chart)].label) + ")";
}

bool opposite(int label, int other) {
    return label != other && label / 2 == other / 2;
}

void check_boundaries(const LabelCharts& charts, Diagnostics& found) {
    for (const LabelBoundary& boundary : charts.boundaries) {
        if (!opposite(charts.charts[at(boundary.charts[0])].label,
                      charts.charts[at(boundary.charts[1])].label))
            continue;
        Diagnostic d{Severity::error,
                     "opposite-labels-adjacent",
                     chart_name(charts, boundary.charts[0]) + " and " +
                         chart_name(charts, boundary.charts[1]) + " share a boundary of " +
                         std::to_string(boundary.triangles.size()) + " edges from vertex " +
                         std::to_string(boundary.vertices.front()) + " to vertex " +
                         std::to_string(boundary.vertices.back()),
                     "triangle",
                     {}};
        for (const auto& pair : boundary.triangles) d.ids.insert(d.ids.end(), pair.begin(), pair.end());
        std::sort(d.ids.begin(), d.ids.end());
        d.ids.erase(std::unique(d.ids.begin(), d.ids.end()), d.ids.end());
        found.push_back(std::move(d));
    }
}

void check_corners(const LabelCharts& charts, Diagnostics& found) {
    for (const LabelCorner& corner : charts.corners) {
        std::array<bool, 3> axes = {};
        std::string names;
        for (const int chart : corner.charts) {
            axes[at(charts.charts[at(chart)].label / 2)] = true;
            names += (names.empty() ? "" : ", ") + chart_name(charts, chart);
        }
        const auto report = [&](Severity severity, const char* code, const std::string& what) {
            found.push_back({severity,
                             code,
                             "vertex " + std::to_string(corner.vertex) + " " + what + ": " + names,
                             "vertex",
                             {corner.vertex}});
        };
        if (corner.charts.size() < 3)
            report(Severity::error, "corner-of-two-charts", "is a corner of two charts only");
        else if (corner.valence == 3 && !(axes[0] && axes[1] && axes[2]))
            report(Severity::error, "corner-repeats-axis",
                   "is a corner of three charts that do not face three axes");
        else if (corner.valence > 3)
            report(Severity::note, "corner-valence",
                   "is a corner where " + std::to_string(corner.valence) + " boundaries meet");
    }
}

/// The corners on the rim of a chart, or one vertex of each boundary when it has none.
std::vector<std::int64_t> rim_vertices(const LabelCharts& charts, const LabelChart& chart) {
    std::vector<std::int64_t> ids;
    for (const int b : chart.boundaries) {
        const auto& vertices = charts.boundaries[at(b)].vertices;
        ids.push_back(vertices.front());
        ids.push_back(vertices.back());
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
}

void check_charts(const LabelCharts& charts, Diagnostics& found) {
    for (std::size_t c = 0; c < charts.charts.size(); ++c) {
        const LabelChart& chart = charts.charts[c];
        const std::string name = chart_name(charts, static_cast<int>(c)) + ", " +
                                 std::to_string(chart.triangles.size()) + " triangles from triangle " +
                                 std::to_string(chart.triangles.front()) + ",";
        const std::string count = std::to_string(chart.boundaries.size());
        if (chart.boundaries.size() < 4) {
            found.push_back({Severity::error,
                             "chart-too-few-boundaries",
                             name + " has " + count + " boundaries, fewer than four",
                             "triangle",
                             {chart.triangles.begin(), chart.triangles.end()}});
            continue;
        }
        if (chart.boundaries.size() > 4)
            found.push_back({Severity::warning, "chart-too-many-boundaries",
                             name + " has " + count + " boundaries, more than four", "vertex",
                             rim_vertices(charts, chart)});
        if (chart.euler_characteristic != 1)
            found.push_back({Severity::warning, "chart-not-a-disk",
                             name + " is not a disk (Euler characteristic " +
                                 std::to_string(chart.euler_characteristic) + ")",
                             "vertex", rim_vertices(charts, chart)});
    }
}

}  // namespace

LabelCharts find_charts(const TriangleMesh& mesh, const Segmentation& segmentation) {
    require_labels(segmentation, mesh.n_faces());
    return ChartFinder(mesh, segmentation.labels).find();
}

Diagnostics validate_charts(const LabelCharts& charts) {
    Diagnostics found;
    check_boundaries(charts, found);
    check_corners(charts, found);
    check_charts(charts, found);
    return found;
}

}  // namespace hex
