#include "improve/curve_matching.h"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <map>
#include <queue>
#include <unordered_map>

namespace hex::improving {
namespace {

/// A vertex farther from the curve than this share of its mean edge length is not on any path.
constexpr double farthest = 0.25;
/// A vertex nearer than this share of its mean edge length lies on the curve.
constexpr double on_curve = 0.03;
/// Curves whose mean cosine is below this are followed in parts where they are not as a whole.
constexpr double strong = 0.5;
/// Cost of an edge: length (1 + penalty (distance / edge length)^2).
constexpr double penalty = 25.0;
/// A path must be about as long as its curve.
constexpr double shortest_path = 0.6;
constexpr double longest_path = 1.6;
/// Candidates for the vertex that stands for a point of a curve.
constexpr unsigned candidates = 12;

using Kernel = CGAL::Simple_cartesian<double>;
using PointWithVertex = std::pair<Kernel::Point_3, std::uint32_t>;
using PointTraits =
    CGAL::Search_traits_adapter<PointWithVertex, CGAL::First_of_pair_property_map<PointWithVertex>,
                                CGAL::Search_traits_3<Kernel>>;
using NeighbourSearch = CGAL::Orthogonal_k_neighbor_search<PointTraits>;

Kernel::Point_3 to_cgal(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

class Matcher {
  public:
    Matcher(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
            const GuideSurface& surface)
        : mesh_(mesh), edges_(edges), boundary_(boundary), surface_(surface), taken_(mesh.vertex_count(), 0) {
        std::vector<PointWithVertex> points;
        for (const VertexId v : boundary.boundary_vertices)
            points.emplace_back(to_cgal(mesh.position(v)), v.value());
        tree_.insert(points.begin(), points.end());
        tree_.build();
    }

    std::vector<VertexId> match(const SurfaceCurve& curve, const SegmentSearch& search) {
        std::vector<double> arc = {0.0};
        for (std::size_t i = 1; i < curve.vertices.size(); ++i)
            arc.push_back(
                arc.back() +
                (surface_.points[curve.vertices[i]] - surface_.points[curve.vertices[i - 1]]).norm());
        std::vector<VertexId> stations;
        if (curve.closed()) {
            for (const double share : {0.0, 1.0 / 3.0, 2.0 / 3.0})
                stations.push_back(nearest_on_curve(point_at(curve, arc, share * arc.back()), search));
            stations.push_back(stations.front());
        } else {
            stations = {end_vertex(curve.vertices.front()), end_vertex(curve.vertices.back())};
        }
        std::vector<VertexId> path = {stations.front()};
        double length = 0.0;
        for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
            if (!stations[i].valid() || !stations[i + 1].valid() || stations[i] == stations[i + 1]) return {};
            const std::vector<VertexId> piece = shortest(stations[i], stations[i + 1], search);
            if (piece.empty()) return {};
            for (std::size_t k = 1; k < piece.size(); ++k) {
                length += (mesh_.position(piece[k]) - mesh_.position(piece[k - 1])).norm();
                path.push_back(piece[k]);
            }
        }
        if (length < shortest_path * arc.back() || length > longest_path * arc.back()) return {};
        const std::size_t begin = curve.closed() ? 0 : 1;
        std::vector<VertexId> inner(path.begin() + static_cast<std::ptrdiff_t>(begin), path.end() - 1);
        std::sort(inner.begin(), inner.end());
        if (std::adjacent_find(inner.begin(), inner.end()) != inner.end()) return {};
        for (const VertexId v : inner) taken_[v.index()] = 1;
        if (!curve.closed()) taken_[path.front().index()] = taken_[path.back().index()] = 2;
        return path;
    }

    /// All ends of open curves get their vertices first, so that no path runs through them.
    void reserve_end(std::uint32_t surface_vertex) {
        if (ends_.contains(surface_vertex)) return;
        const Vec3& p = surface_.points[surface_vertex];
        NeighbourSearch found(tree_, to_cgal(p), 1);
        const VertexId v(static_cast<std::size_t>(found.begin()->first.second));
        const bool close = (mesh_.position(v) - p).norm() <= farthest * edge_length(v);
        const bool fresh = close && taken_[v.index()] == 0;
        ends_[surface_vertex] = fresh ? v : VertexId();
        if (fresh) taken_[v.index()] = 2;
    }

    /// Runs of edges that lie on a curve although the whole of it is not followed.
    std::vector<std::vector<VertexId>> match_parts(const SegmentSearch& search) {
        std::vector<char> near(mesh_.vertex_count(), 0);
        for (const VertexId v : boundary_.boundary_vertices)
            near[v.index()] = !taken_[v.index()] && lies_on(v, search);
        const auto next = [&](VertexId v, VertexId previous) {
            VertexId found;
            int count = 0;
            for (const EdgeId e : edges_.vertex_edges[v.index()]) {
                const VertexId w = edges_.other(e, v);
                if (!edges_.boundary[e.index()] || !near[w.index()]) continue;
                const Vec3 middle = 0.5 * (mesh_.position(v) + mesh_.position(w));
                const double length = (mesh_.position(v) - mesh_.position(w)).norm();
                if ((search.closest(middle).point - middle).norm() > 2.0 * on_curve * length) continue;
                ++count;
                if (w != previous) found = w;
            }
            return std::pair(found, count);
        };
        std::vector<std::vector<VertexId>> runs;
        for (const VertexId start : boundary_.boundary_vertices) {
            if (!near[start.index()] || next(start, VertexId()).second != 1) continue;
            std::vector<VertexId> run = {start};
            VertexId previous;
            for (VertexId v = start; v.valid();) {
                const auto [w, count] = next(v, previous);
                if (count > 2 || !w.valid() || run.size() > near.size()) break;
                run.push_back(w);
                previous = v;
                v = w;
            }
            for (const VertexId v : run) near[v.index()] = 0;
            if (run.size() < 3) continue;
            for (const VertexId v : run) taken_[v.index()] = 1;
            runs.push_back(std::move(run));
        }
        return runs;
    }

  private:
    bool lies_on(VertexId v, const SegmentSearch& search) const {
        return (search.closest(mesh_.position(v)).point - mesh_.position(v)).norm() <=
               on_curve * edge_length(v);
    }
    VertexId end_vertex(std::uint32_t surface_vertex) const { return ends_.at(surface_vertex); }

    double edge_length(VertexId v) const {
        double sum = 0.0;
        int count = 0;
        for (const EdgeId e : edges_.vertex_edges[v.index()]) {
            if (!edges_.boundary[e.index()]) continue;
            sum += (mesh_.position(edges_.other(e, v)) - mesh_.position(v)).norm();
            ++count;
        }
        return sum / count;
    }

    Vec3 point_at(const SurfaceCurve& curve, const std::vector<double>& arc, double s) const {
        const auto next = std::upper_bound(arc.begin() + 1, arc.end() - 1, s);
        const auto i = static_cast<std::size_t>(next - arc.begin());
        const Vec3& a = surface_.points[curve.vertices[i - 1]];
        const Vec3& b = surface_.points[curve.vertices[i]];
        const double span = arc[i] - arc[i - 1];
        return span > 0.0 ? Vec3(a + (s - arc[i - 1]) / span * (b - a)) : a;
    }

    /// Among the vertices near p the one nearest to the curve.
    VertexId nearest_on_curve(const Vec3& p, const SegmentSearch& search) const {
        NeighbourSearch found(tree_, to_cgal(p), candidates);
        VertexId best;
        double best_distance = 0.0;
        for (const auto& [point, squared] : found) {
            const VertexId v(static_cast<std::size_t>(point.second));
            if (taken_[v.index()]) continue;
            const double to_curve = (search.closest(mesh_.position(v)).point - mesh_.position(v)).norm();
            if (to_curve > farthest * edge_length(v)) continue;
            const double distance = 10.0 * to_curve + std::sqrt(squared);
            if (best.valid() && distance >= best_distance) continue;
            best = v;
            best_distance = distance;
        }
        return best;
    }

    /// Dijkstra's path through free boundary vertices near the curve.
    std::vector<VertexId> shortest(VertexId from, VertexId to, const SegmentSearch& search) const {
        struct Step {
            double cost;
            VertexId vertex, previous;
            bool operator>(const Step& other) const {
                return cost != other.cost ? cost > other.cost : vertex > other.vertex;
            }
        };
        std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
        std::unordered_map<std::uint32_t, VertexId> previous;
        queue.push({0.0, from, VertexId()});
        while (!queue.empty()) {
            const Step step = queue.top();
            queue.pop();
            const VertexId v = step.vertex;
            if (!previous.emplace(v.value(), step.previous).second) continue;
            if (v == to) break;
            for (const EdgeId e : edges_.vertex_edges[v.index()]) {
                const VertexId w = edges_.other(e, v);
                if (!edges_.boundary[e.index()] || previous.contains(w.value())) continue;
                if (taken_[w.index()] && w != to) continue;
                const double size = edge_length(w);
                // Not where the middle of the edge is: on a bent curve it has to be off.
                const double off = (search.closest(mesh_.position(w)).point - mesh_.position(w)).norm();
                if (off > farthest * size) continue;
                const double share = off / size;
                const double length = (mesh_.position(v) - mesh_.position(w)).norm();
                queue.push({step.cost + length * (1.0 + penalty * share * share), w, v});
            }
        }
        if (!previous.contains(to.value())) return {};
        std::vector<VertexId> path;
        for (VertexId v = to; v.valid(); v = previous.at(v.value())) path.push_back(v);
        std::reverse(path.begin(), path.end());
        return path;
    }

    const HexMesh& mesh_;
    const EdgeTable& edges_;
    const BoundaryQuads& boundary_;
    const GuideSurface& surface_;
    std::vector<char> taken_;  // 1: inside a path, 2: end of a path
    std::map<std::uint32_t, VertexId> ends_;
    NeighbourSearch::Tree tree_;
};

}  // namespace

CurveMatches match_curves(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                          const GuideSurface& surface, const std::vector<SurfaceCurve>& curves,
                          const std::vector<std::unique_ptr<SegmentSearch>>& searches) {
    Matcher matcher(mesh, edges, boundary, surface);
    for (const SurfaceCurve& curve : curves) {
        if (curve.closed()) continue;
        matcher.reserve_end(curve.vertices.front());
        matcher.reserve_end(curve.vertices.back());
    }
    CurveMatches matches;
    for (std::size_t i = 0; i < curves.size(); ++i)
        matches.whole.push_back(matcher.match(curves[i], *searches[i]));
    for (std::size_t i = 0; i < curves.size(); ++i)
        matches.parts.push_back(matches.whole[i].empty() && curves[i].mean_cosine < strong
                                    ? matcher.match_parts(*searches[i])
                                    : std::vector<std::vector<VertexId>>());
    return matches;
}

}  // namespace hex::improving
