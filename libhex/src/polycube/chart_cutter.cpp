#include "polycube/chart_cutter.h"

#include "polycube/flat_region.h"

#include <hex/base/error.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <queue>
#include <set>

namespace hex {
namespace {

using Face = TriangleMesh::FaceHandle;
using Halfedge = TriangleMesh::HalfedgeHandle;
using Edge = TriangleMesh::EdgeHandle;
using Vertex = TriangleMesh::VertexHandle;

/// A vertex that a line meets within this share of an edge is moved onto the line.
constexpr double snap_share = 0.12;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

struct Region {
    std::vector<Face> faces;
    std::vector<CutLine> lines;
};

class Cutter {
  public:
    explicit Cutter(const CutProblem& problem) : nodes_(problem.nodes) {
        for (const Vec3& p : problem.points) mesh_.add_vertex(to_openmesh(p));
        for (const auto& t : problem.triangles)
            if (!mesh_.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])).is_valid())
                throw Error(ErrorKind::no_result, "a chart of the polycube is no manifold");
        uv_.assign(mesh_.n_vertices(), Vec2::Zero());
        fixed_.assign(mesh_.n_vertices(), 0);
        node_at_.assign(mesh_.n_vertices(), -1);
        line_of_edge_.assign(mesh_.n_edges(), -1);
        for (std::size_t n = 0; n < nodes_.size(); ++n)
            if (nodes_[n].vertex >= 0) node_at_[at(nodes_[n].vertex)] = static_cast<int>(n);
        region_of_.assign(mesh_.n_faces(), 0);
        Region whole;
        for (const auto f : mesh_.faces()) whole.faces.push_back(f);
        whole.lines = problem.lines;
        open_.push_back(std::move(whole));
    }

    CutResult cut() {
        result_.direct = true;
        while (!open_.empty()) {
            Region region = std::move(open_.back());
            open_.pop_back();
            if (region.lines.empty()) continue;
            process(region);
        }
        return collect();
    }

    CutResult cut_star() {
        const Region region = std::move(open_.back());
        open_.pop_back();
        enter(region);
        const auto loops = rim_loops();
        mark_rim(loops);
        split_bridges();
        const int centre = nodes_[at(region.lines.front().nodes.back())].vertex;
        if (!is_disk(loops) || !is_simply_connected() || fixed_[at(centre)])
            fail("the patches around a block vertex form no disk");
        round_rim(loops.front());
        if (!flatten_region(mesh_, faces_of_current(), fixed_, uv_))
            fail("the patches around a block vertex cannot be flattened onto a disk");
        for (const CutLine& line : region.lines) {
            if (!cut_straight(line)) fail("a block line cannot be cut anew");
            lines_.push_back(line);
        }
        return collect();
    }

  private:
    [[noreturn]] static void fail(const char* what) { throw Error(ErrorKind::no_result, what); }

    // --- regions -------------------------------------------------------------------------------------------

    bool in_region(Face f) const { return f.is_valid() && region_of_[at(f.idx())] == current_; }
    bool on_rim(Halfedge h) const {
        return line_of_edge_[at(mesh_.edge_handle(h).idx())] >= 0 ||
               !in_region(mesh_.face_handle(mesh_.opposite_halfedge_handle(h)));
    }

    void enter(const Region& region) {
        current_ = ++last_region_;
        for (const auto f : region.faces) region_of_[at(f.idx())] = current_;
    }

    std::vector<Face> faces_of_current() const {
        std::vector<Face> faces;
        for (const auto f : mesh_.faces())
            if (in_region(f)) faces.push_back(f);
        return faces;
    }

    /// Closed walks along the rim, the region on the left.
    std::vector<std::vector<Halfedge>> rim_loops() const {
        std::vector<std::vector<Halfedge>> loops;
        std::set<int> seen;
        for (const auto h : mesh_.halfedges()) {
            if (!in_region(mesh_.face_handle(h)) || !on_rim(h) || seen.contains(h.idx())) continue;
            auto& loop = loops.emplace_back();
            Halfedge walk = h;
            do {
                seen.insert(walk.idx());
                loop.push_back(walk);
                walk = mesh_.next_halfedge_handle(walk);
                while (!on_rim(walk)) walk = mesh_.next_halfedge_handle(mesh_.opposite_halfedge_handle(walk));
            } while (walk != h);
        }
        return loops;
    }

    double length(Halfedge h) const {
        return (point(mesh_.to_vertex_handle(h)) - point(mesh_.from_vertex_handle(h))).norm();
    }
    Vec3 point(Vertex v) const { return to_eigen(mesh_.point(v)); }

    void mark_rim(const std::vector<std::vector<Halfedge>>& loops) {
        std::fill(fixed_.begin(), fixed_.end(), 0);
        for (const auto& loop : loops)
            for (const auto h : loop) fixed_[at(mesh_.from_vertex_handle(h).idx())] = 1;
    }

    /// Inner edges that join two vertices of the rim are cut in two.
    void split_bridges() {
        const std::size_t count = mesh_.n_edges();
        for (std::size_t i = 0; i < count; ++i) {
            const Edge e(static_cast<int>(i));
            const Halfedge h = mesh_.halfedge_handle(e, 0);
            if (mesh_.is_boundary(e) || !in_region(mesh_.face_handle(h)) || on_rim(h)) continue;
            const Vertex a = mesh_.from_vertex_handle(h);
            const Vertex b = mesh_.to_vertex_handle(h);
            if (fixed_[at(a.idx())] && fixed_[at(b.idx())])
                split(e, 0.5 * (point(a) + point(b)), 0.5 * (uv_[at(a.idx())] + uv_[at(b.idx())]));
        }
    }

    /// Splits an edge; its halves keep its line, the two faces beside it their region.
    Vertex split(Edge e, const Vec3& p, const Vec2& place) {
        const Halfedge h = mesh_.halfedge_handle(e, 0);
        const Vertex a = mesh_.from_vertex_handle(h);
        const Vertex b = mesh_.to_vertex_handle(h);
        const int line = line_of_edge_[at(e.idx())];
        const Face left = mesh_.face_handle(h);
        const Face right = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
        const int left_region = left.is_valid() ? region_of_[at(left.idx())] : -1;
        const int right_region = right.is_valid() ? region_of_[at(right.idx())] : -1;
        const Vertex left_apex =
            left.is_valid() ? mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)) : Vertex();
        const Vertex v = mesh_.add_vertex(to_openmesh(p));
        uv_.push_back(place);
        fixed_.push_back(0);
        node_at_.push_back(-1);
        mesh_.split(e, v);
        line_of_edge_.resize(mesh_.n_edges(), -1);
        region_of_.resize(mesh_.n_faces(), -1);
        for (const auto out : mesh_.voh_range(v)) {
            const Vertex to = mesh_.to_vertex_handle(out);
            const bool half = to == a || to == b;
            line_of_edge_[at(mesh_.edge_handle(out).idx())] = half ? line : -1;
            const Face f = mesh_.face_handle(out);
            if (!f.is_valid()) continue;
            // The faces at the left apex lie left of a -> b.
            const Vertex third = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(out));
            const bool is_left = left_apex.is_valid() && (to == left_apex || third == left_apex);
            region_of_[at(f.idx())] = is_left ? left_region : right_region;
        }
        return v;
    }

    // --- one region ----------------------------------------------------------------------------------------

    void process(Region& region) {
        enter(region);
        auto loops = rim_loops();
        mark_rim(loops);
        split_bridges();
        if (cut_in_polygon(region, loops)) return;
        result_.direct = false;
        ++result_.steps;
        const bool disk = is_disk(loops);
        const CutLine line = take_line(region, loops);
        std::vector<Vertex> path = disk ? cut_in_disk(line, loops.front()) : cut_along_edges(line);
        place_crossings(line, path);
        divide(region, line);
    }

    bool is_disk(const std::vector<std::vector<Halfedge>>& loops) const {
        if (loops.size() != 1) return false;
        std::set<int> seen;
        for (const auto h : loops.front())
            if (!seen.insert(mesh_.from_vertex_handle(h).idx()).second) return false;
        return true;
    }

    /// Rim vertices: nodes at their places, the others between them by length.
    bool place_rim(const std::vector<std::vector<Halfedge>>& loops) {
        for (const auto& loop : loops) {
            std::size_t start = 0;
            while (start < loop.size() && node_of(loop[start]) < 0) ++start;
            if (start == loop.size()) return false;
            std::size_t i = 0;
            while (i < loop.size()) {
                // From one node to the next.
                std::vector<double> lengths = {0.0};
                std::size_t j = i;
                do {
                    lengths.push_back(lengths.back() + length(loop[(start + j) % loop.size()]));
                    ++j;
                } while (node_of(loop[(start + j) % loop.size()]) < 0);
                const Vec2 from = nodes_[at(node_of(loop[(start + i) % loop.size()]))].place;
                const Vec2 to = nodes_[at(node_of(loop[(start + j) % loop.size()]))].place;
                for (std::size_t k = i; k < j; ++k) {
                    const double t = lengths.back() > 0.0 ? lengths[k - i] / lengths.back()
                                                          : double(k - i) / double(j - i);
                    Vec2 place = (1.0 - t) * from + t * to;
                    for (int c = 0; c < 2; ++c)
                        if (from[c] == to[c]) place[c] = from[c];
                    uv_[at(mesh_.from_vertex_handle(loop[(start + k) % loop.size()]).idx())] = place;
                }
                i = j;
            }
        }
        return true;
    }
    int node_of(Halfedge h) const { return node_at_[at(mesh_.from_vertex_handle(h).idx())]; }

    bool cut_in_polygon(Region& region, const std::vector<std::vector<Halfedge>>& loops) {
        if (!place_rim(loops)) return false;
        const auto faces = faces_of_current();
        if (!flatten_region(mesh_, faces, fixed_, uv_)) return false;
        // First the lines along one axis, then those along the other, which find the crossings.
        for (const int along : {0, 1}) {
            for (const CutLine& line : region.lines) {
                const Vec2 way = nodes_[at(line.nodes.back())].place - nodes_[at(line.nodes.front())].place;
                if ((std::abs(way.x()) > std::abs(way.y()) ? 0 : 1) != along) continue;
                const auto path = cut_straight(line);
                if (!path) fail("a block line cannot be cut into its chart");
                if (along == 1) name_crossings(line, *path);
                remember_line(line, *path);
            }
        }
        for (const CutLine& line : region.lines)
            for (const int n : line.nodes)
                if (nodes_[at(n)].vertex < 0) fail("two block lines do not cross in their chart");
        return true;
    }

    /// Crossings lie where the path meets vertices of the line across.
    void name_crossings(const CutLine& line, const std::vector<Vertex>& path) {
        for (std::size_t k = 1; k + 1 < line.nodes.size(); ++k) {
            const int n = line.nodes[k];
            for (const Vertex v : path) {
                const auto found = node_candidates_.find({n, v.idx()});
                if (found == node_candidates_.end()) continue;
                nodes_[at(n)].vertex = v.idx();
                node_at_[at(v.idx())] = n;
            }
        }
    }
    /// All vertices of a line are candidates for the crossings on it.
    void remember_line(const CutLine& line, const std::vector<Vertex>& path) {
        lines_.push_back(line);
        for (const Vertex v : path) add_to_line(v, static_cast<int>(lines_.size()) - 1);
    }
    void add_to_line(Vertex v, int line) {
        for (std::size_t k = 1; k + 1 < lines_[at(line)].nodes.size(); ++k)
            node_candidates_.insert({lines_[at(line)].nodes[k], v.idx()});
    }

    // --- straight cuts -------------------------------------------------------------------------------------

    /// Cuts along the segment between the two ends of the line in the plane. Returns the vertices along it,
    /// or nothing when the walk gets stuck.
    std::optional<std::vector<Vertex>> cut_straight(const CutLine& line) {
        const Vertex start(nodes_[at(line.nodes.front())].vertex);
        const Vertex goal(nodes_[at(line.nodes.back())].vertex);
        const Vec2 a = uv_[at(start.idx())];
        const Vec2 b = uv_[at(goal.idx())];
        const int number = static_cast<int>(lines_.size());
        std::vector<Vertex> path = {start};
        const std::size_t limit = 4 * mesh_.n_faces() + 16;
        while (path.back() != goal) {
            if (path.size() > limit) return std::nullopt;
            const std::optional<Halfedge> step = next_step(path, a, b, goal);
            if (!step) return std::nullopt;
            line_of_edge_[at(mesh_.edge_handle(*step).idx())] = number;
            path.push_back(mesh_.to_vertex_handle(*step));
        }
        return path;
    }

    /// The half-edge along which the line goes on; makes it by splitting the edge ahead if need be.
    std::optional<Halfedge> next_step(const std::vector<Vertex>& path, const Vec2& a, const Vec2& b,
                                      Vertex goal) {
        const Vertex here = path.back();
        const Vec2 way = b - a;
        for (const auto h : mesh_.voh_range(here)) {
            const bool inside = in_region(mesh_.face_handle(h)) ||
                                in_region(mesh_.face_handle(mesh_.opposite_halfedge_handle(h)));
            if (!inside) continue;
            const Vertex p = mesh_.to_vertex_handle(h);
            if (p == goal && !on_rim(h)) return h;
            if (fixed_[at(p.idx())]) continue;
            if (side_of_line(a, b, uv_[at(p.idx())]) == 0 &&
                (uv_[at(p.idx())] - uv_[at(here.idx())]).dot(way) > 0.0)
                return h;
        }
        for (const auto h : mesh_.voh_range(here)) {
            if (!in_region(mesh_.face_handle(h))) continue;
            const Halfedge opposite = mesh_.next_halfedge_handle(h);
            const Vertex p = mesh_.from_vertex_handle(opposite);
            const Vertex q = mesh_.to_vertex_handle(opposite);
            if (side_of_line(a, b, uv_[at(p.idx())]) >= 0 || side_of_line(a, b, uv_[at(q.idx())]) <= 0)
                continue;
            if (crosses_backwards(here, p, q, way)) continue;
            return cross(here, opposite, a, b);
        }
        return std::nullopt;
    }

    bool crosses_backwards(Vertex here, Vertex p, Vertex q, const Vec2& way) const {
        const Vec2& o = uv_[at(here.idx())];
        return (uv_[at(p.idx())] - o).dot(way) <= 0.0 && (uv_[at(q.idx())] - o).dot(way) <= 0.0;
    }

    /// Goes on across an edge: to one of its ends, if that can be moved onto the line, or to a new vertex.
    std::optional<Halfedge> cross(Vertex here, Halfedge edge, const Vec2& a, const Vec2& b) {
        const Vertex p = mesh_.from_vertex_handle(edge);
        const Vertex q = mesh_.to_vertex_handle(edge);
        const Vec2 way = (b - a).normalized();
        const auto off = [&](Vertex v) {
            const Vec2 d = uv_[at(v.idx())] - a;
            return way.x() * d.y() - way.y() * d.x();
        };
        const double dp = std::abs(off(p));
        const double dq = std::abs(off(q));
        const double share = dp + dq > 0.0 ? dp / (dp + dq) : 0.5;
        const auto on_line = [&](Vec2 place) {
            // Exactly on lines that are parallel to an axis.
            if (a.x() == b.x()) place.x() = a.x();
            if (a.y() == b.y()) place.y() = a.y();
            return place;
        };
        Vec2 crossing = on_line((1.0 - share) * uv_[at(p.idx())] + share * uv_[at(q.idx())]);
        for (int c = 0; c < 2; ++c)
            if (uv_[at(p.idx())][c] == uv_[at(q.idx())][c]) crossing[c] = uv_[at(p.idx())][c];
        const Edge e = mesh_.edge_handle(edge);
        const int across = line_of_edge_[at(e.idx())];
        if (share < snap_share && move_onto_line(p, across, crossing, a, b))
            return mesh_.find_halfedge(here, p);
        if (share > 1.0 - snap_share && move_onto_line(q, across, crossing, a, b))
            return mesh_.find_halfedge(here, q);
        if (on_rim(edge) && across < 0) return std::nullopt;
        if (across >= static_cast<int>(lines_.size())) return std::nullopt;
        const double bounded = std::clamp(share, 0.02, 0.98);
        const Vertex v = split(e, (1.0 - bounded) * point(p) + bounded * point(q), crossing);
        if (across >= 0) add_to_line(v, across);
        return mesh_.find_halfedge(here, v);
    }

    /// Moves a vertex in the plane onto the line, unless it is needed where it is or a triangle would flip.
    /// One on another line may only slide along that line, when the edge to cross is part of it (`across`).
    bool move_onto_line(Vertex v, int across, const Vec2& crossing, const Vec2& a, const Vec2& b) {
        if (fixed_[at(v.idx())] || node_at_[at(v.idx())] >= 0) return false;
        bool on_other = false;
        for (const auto h : mesh_.voh_range(v)) {
            const int line = line_of_edge_[at(mesh_.edge_handle(h).idx())];
            on_other = on_other || line >= 0;
            if (line >= 0 && line != across) return false;
        }
        const Vec2 before = uv_[at(v.idx())];
        const Vec2 way = (b - a).normalized();
        Vec2 place = a + way * way.dot(before - a);
        if (a.x() == b.x()) place.x() = a.x();
        if (a.y() == b.y()) place.y() = a.y();
        for (const Vec2& target : {on_other ? crossing : place, crossing}) {
            uv_[at(v.idx())] = target;
            bool good = true;
            for (const auto f : mesh_.vf_range(v)) good = good && positive(f);
            if (good) return true;
        }
        uv_[at(v.idx())] = before;
        return false;
    }
    bool positive(Face f) const {
        std::array<Vec2, 3> p;
        std::size_t k = 0;
        for (const auto v : mesh_.fv_range(f)) p[k++] = uv_[at(v.idx())];
        return counter_clockwise(p[0], p[1], p[2]);
    }

    // --- one line alone ------------------------------------------------------------------------------------

    /// The line to cut first, removed from the region. While the rim has several loops, one that joins two of
    /// them: whichever way it goes around the others, what is left is the same. Else the one that divides the
    /// rim most evenly; not one that ends on a cut whose two sides both are rim, if there is a choice,
    /// because its vertex does not tell from which side it starts.
    CutLine take_line(Region& region, const std::vector<std::vector<Halfedge>>& loops) const {
        struct Place {
            int loop = 0;
            double length = 0.0;
            int times = 0;
        };
        std::map<int, Place> place;  // by node
        std::vector<double> total;
        for (std::size_t l = 0; l < loops.size(); ++l) {
            double sum = 0.0;
            for (const auto h : loops[l]) {
                if (node_of(h) >= 0) {
                    Place& p = place[node_of(h)];
                    p = {static_cast<int>(l), sum, p.times + 1};
                }
                sum += length(h);
            }
            total.push_back(sum);
        }
        std::size_t best = 0;
        double best_score = -1.0;
        for (std::size_t i = 0; i < region.lines.size(); ++i) {
            const auto one = place.find(region.lines[i].nodes.front());
            const auto two = place.find(region.lines[i].nodes.back());
            if (one == place.end() || two == place.end()) continue;
            const bool joins = one->second.loop != two->second.loop;
            if (loops.size() > 1 && !joins) continue;
            double score = 0.0;
            if (!joins) {
                const double whole = total[at(one->second.loop)];
                const double arc = std::abs(one->second.length - two->second.length);
                score = whole > 0.0 ? std::min(arc, whole - arc) / whole : 0.0;
            }
            if (one->second.times == 1 && two->second.times == 1) score += 1.0;
            if (score > best_score) {
                best = i;
                best_score = score;
            }
        }
        if (best_score < 0.0) fail("no block line of a chart can be cut next");
        CutLine line = region.lines[best];
        region.lines.erase(region.lines.begin() + static_cast<std::ptrdiff_t>(best));
        return line;
    }

    bool is_simply_connected() const {
        std::set<int> vertices;
        std::set<int> edges;
        int faces = 0;
        for (const auto f : mesh_.faces()) {
            if (!in_region(f)) continue;
            ++faces;
            for (const auto h : mesh_.fh_range(f)) {
                vertices.insert(mesh_.to_vertex_handle(h).idx());
                edges.insert(mesh_.edge_handle(h).idx());
            }
        }
        return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + faces == 1;
    }

    /// The rim of a disk on a circle, by length.
    void round_rim(const std::vector<Halfedge>& rim) {
        double total = 0.0;
        for (const auto h : rim) total += length(h);
        double sum = 0.0;
        for (std::size_t i = 0; i < rim.size(); ++i) {
            const double share = total > 0.0 ? sum / total : double(i) / double(rim.size());
            const double angle = 2.0 * std::numbers::pi * share;
            uv_[at(mesh_.from_vertex_handle(rim[i]).idx())] = {std::cos(angle), std::sin(angle)};
            sum += length(rim[i]);
        }
    }

    std::vector<Vertex> cut_in_disk(const CutLine& line, const std::vector<Halfedge>& rim) {
        round_rim(rim);
        if (!flatten_region(mesh_, faces_of_current(), fixed_, uv_))
            fail("a chart of the polycube cannot be flattened onto a disk");
        const auto path = cut_straight(line);
        if (!path) fail("a block line cannot be cut into its chart");
        lines_.push_back(line);
        return *path;
    }

    /// Shortest path of edges through inner vertices.
    std::vector<Vertex> cut_along_edges(const CutLine& line) {
        const Vertex start(nodes_[at(line.nodes.front())].vertex);
        const Vertex goal(nodes_[at(line.nodes.back())].vertex);
        std::vector<double> distance(mesh_.n_vertices(), -1.0);
        std::vector<Halfedge> came(mesh_.n_vertices());
        using Entry = std::pair<double, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        std::vector<char> done(mesh_.n_vertices(), 0);
        queue.push({0.0, start.idx()});
        distance[at(start.idx())] = 0.0;
        while (!queue.empty()) {
            const auto [d, index] = queue.top();
            queue.pop();
            if (done[at(index)]) continue;
            done[at(index)] = 1;
            const Vertex v(index);
            if (v == goal) break;
            if (v != start && fixed_[at(index)]) continue;
            for (const auto h : mesh_.voh_range(v)) {
                if (!in_region(mesh_.face_handle(h)) || on_rim(h)) continue;
                const Vertex w = mesh_.to_vertex_handle(h);
                const double longer = d + length(h);
                if (distance[at(w.idx())] >= 0.0 && distance[at(w.idx())] <= longer) continue;
                distance[at(w.idx())] = longer;
                came[at(w.idx())] = h;
                queue.push({longer, w.idx()});
            }
        }
        if (!done[at(goal.idx())]) fail("a block line finds no way through its chart");
        const int number = static_cast<int>(lines_.size());
        std::vector<Vertex> path = {goal};
        while (path.back() != start) {
            const Halfedge h = came[at(path.back().idx())];
            line_of_edge_[at(mesh_.edge_handle(h).idx())] = number;
            path.push_back(mesh_.from_vertex_handle(h));
        }
        std::reverse(path.begin(), path.end());
        lines_.push_back(line);
        return path;
    }

    /// Puts the crossings on the path where their places divide the line.
    void place_crossings(const CutLine& line, std::vector<Vertex>& path) {
        const Vec2 from = nodes_[at(line.nodes.front())].place;
        const Vec2 to = nodes_[at(line.nodes.back())].place;
        for (std::size_t k = 1; k + 1 < line.nodes.size(); ++k) {
            const double share = (nodes_[at(line.nodes[k])].place - from).norm() / (to - from).norm();
            std::vector<double> lengths = {0.0};
            for (std::size_t i = 1; i < path.size(); ++i)
                lengths.push_back(lengths.back() + (point(path[i]) - point(path[i - 1])).norm());
            const double wanted = share * lengths.back();
            // Not before the last crossing.
            std::size_t first = 0;
            for (std::size_t i = 0; i < path.size(); ++i)
                if (node_at_[at(path[i].idx())] >= 0 && i + 1 < path.size()) first = i;
            std::size_t i = first;
            while (i + 2 < path.size() && lengths[i + 1] < wanted) ++i;
            const double span = lengths[i + 1] - lengths[i];
            const double t = span > 0.0 ? std::clamp((wanted - lengths[i]) / span, 0.0, 1.0) : 0.5;
            Vertex crossing;
            if (t < 0.2 && i > first) {
                crossing = path[i];
            } else if (t > 0.8 && i + 2 < path.size()) {
                crossing = path[i + 1];
            } else {
                const double inner = std::clamp(t, 0.2, 0.8);
                const Halfedge h = mesh_.find_halfedge(path[i], path[i + 1]);
                crossing =
                    split(mesh_.edge_handle(h), (1.0 - inner) * point(path[i]) + inner * point(path[i + 1]),
                          0.5 * (uv_[at(path[i].idx())] + uv_[at(path[i + 1].idx())]));
                path.insert(path.begin() + static_cast<std::ptrdiff_t>(i) + 1, crossing);
            }
            nodes_[at(line.nodes[k])].vertex = crossing.idx();
            node_at_[at(crossing.idx())] = line.nodes[k];
        }
    }

    /// The parts of the region beside the new cut, each with the lines and pieces of lines in it.
    void divide(const Region& region, const CutLine& cut) {
        std::vector<CutLine> pieces;
        for (const CutLine& line : region.lines) {
            std::size_t crossing = 0;
            for (std::size_t k = 1; k + 1 < line.nodes.size(); ++k)
                if (std::find(cut.nodes.begin(), cut.nodes.end(), line.nodes[k]) != cut.nodes.end())
                    crossing = k;
            if (crossing == 0) {
                pieces.push_back(line);
                continue;
            }
            const auto middle = line.nodes.begin() + static_cast<std::ptrdiff_t>(crossing);
            pieces.push_back({{line.nodes.begin(), middle + 1}});
            pieces.push_back({{middle, line.nodes.end()}});
        }
        std::vector<Region> parts;
        std::map<int, std::set<int>> parts_of_node;
        std::vector<int> part_of(mesh_.n_faces(), -1);
        for (const auto start : mesh_.faces()) {
            if (!in_region(start) || part_of[at(start.idx())] >= 0) continue;
            const int part = static_cast<int>(parts.size());
            Region& fresh = parts.emplace_back();
            std::vector<Face> open = {start};
            part_of[at(start.idx())] = part;
            while (!open.empty()) {
                const Face f = open.back();
                open.pop_back();
                fresh.faces.push_back(f);
                for (const auto h : mesh_.fh_range(f)) {
                    const int node = node_at_[at(mesh_.to_vertex_handle(h).idx())];
                    if (node >= 0) parts_of_node[node].insert(part);
                    if (on_rim(h)) continue;
                    const Face next = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
                    if (part_of[at(next.idx())] >= 0) continue;
                    part_of[at(next.idx())] = part;
                    open.push_back(next);
                }
            }
            std::sort(fresh.faces.begin(), fresh.faces.end());
        }
        for (CutLine& piece : pieces) assign_piece(piece, cut, parts, parts_of_node);
        for (Region& part : parts) open_.push_back(std::move(part));
    }

    /// A piece lies in the part that holds both its ends. When both ends lie on several parts, the side of
    /// the cut decides.
    void assign_piece(CutLine& piece, const CutLine& cut, std::vector<Region>& parts,
                      const std::map<int, std::set<int>>& parts_of_node) const {
        std::vector<int> common;
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const int part = static_cast<int>(p);
            bool all = true;
            for (const int node : {piece.nodes.front(), piece.nodes.back()}) {
                const auto found = parts_of_node.find(node);
                all = all && found != parts_of_node.end() && found->second.contains(part);
            }
            if (all) common.push_back(part);
        }
        if (common.empty()) fail("a block line is lost when its chart is cut");
        if (common.size() > 1) {
            // The part whose other nodes lie on the piece's side of the cut.
            const Vec2 from = nodes_[at(cut.nodes.front())].place;
            const Vec2 to = nodes_[at(cut.nodes.back())].place;
            Vec2 middle = Vec2::Zero();
            for (const int n : piece.nodes) middle += nodes_[at(n)].place / double(piece.nodes.size());
            const int side = side_of_line(from, to, middle);
            for (const int part : common) {
                int votes = 0;
                for (const auto& [node, in] : parts_of_node)
                    if (in.contains(part) && in.size() == 1)
                        votes += side_of_line(from, to, nodes_[at(node)].place) == side ? 1 : -1;
                if (votes > 0) {
                    common = {part};
                    break;
                }
            }
        }
        parts[at(common.front())].lines.push_back(std::move(piece));
    }

    // --- result --------------------------------------------------------------------------------------------

    CutResult collect() {
        for (const auto v : mesh_.vertices()) result_.points.push_back(point(v));
        result_.part.assign(mesh_.n_faces(), -1);
        int parts = 0;
        for (const auto start : mesh_.faces()) {
            std::array<int, 3> t{};
            std::size_t k = 0;
            for (const auto v : mesh_.fv_range(start)) t[k++] = v.idx();
            result_.triangles.push_back(t);
            if (result_.part[at(start.idx())] >= 0) continue;
            std::vector<Face> open = {start};
            result_.part[at(start.idx())] = parts;
            while (!open.empty()) {
                const Face f = open.back();
                open.pop_back();
                for (const auto h : mesh_.fh_range(f)) {
                    if (line_of_edge_[at(mesh_.edge_handle(h).idx())] >= 0) continue;
                    const Face next = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
                    if (!next.is_valid() || result_.part[at(next.idx())] >= 0) continue;
                    result_.part[at(next.idx())] = parts;
                    open.push_back(next);
                }
            }
            ++parts;
        }
        for (const CutNode& node : nodes_) result_.node_vertex.push_back(node.vertex);
        return std::move(result_);
    }

    TriangleMesh mesh_;
    std::vector<CutNode> nodes_;
    std::vector<Vec2> uv_;
    std::vector<char> fixed_;        ///< on the rim of the current region
    std::vector<int> node_at_;       ///< node of each vertex, or -1
    std::vector<int> line_of_edge_;  ///< number of the line that an edge was cut for, or -1
    std::vector<int> region_of_;
    int current_ = 0;
    int last_region_ = 0;
    std::vector<CutLine> lines_;  ///< those that are cut
    std::set<std::pair<int, int>> node_candidates_;
    std::vector<Region> open_;
    CutResult result_;
};

}  // namespace

CutResult cut_star(const CutProblem& problem) {
    return Cutter(problem).cut_star();
}

CutResult cut_chart(const CutProblem& problem) {
    return Cutter(problem).cut();
}

}  // namespace hex
