#include "polycube/chart_cutter.h"

#include "polycube/cut_mesh.h"
#include "polycube/flat_region.h"
#include "polycube/straight_cut.h"

#include <hex/base/error.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>

namespace hex {
namespace {

using Face = CutMesh::Face;
using Halfedge = CutMesh::Halfedge;
using Vertex = CutMesh::Vertex;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

struct Region {
    std::vector<Face> faces;
    std::vector<CutLine> lines;
};

class Cutter {
  public:
    explicit Cutter(const CutProblem& problem) : cut_(problem), mesh_(cut_.triangles()) {
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
        cut_.enter(region.faces);
        const auto loops = cut_.rim_loops();
        cut_.mark_rim(loops);
        cut_.split_bridges();
        const Vertex centre = cut_.vertex_of(region.lines.front().nodes.back());
        if (!is_disk(loops) || !cut_.is_simply_connected() || cut_.on_rim(centre))
            fail("the patches around a block vertex form no disk");
        cut_.round_rim(loops.front());
        if (!cut_.flatten()) fail("the patches around a block vertex cannot be flattened onto a disk");
        for (const CutLine& line : region.lines) {
            if (!cut_straight(cut_, line)) fail("a block line cannot be cut anew");
            cut_.finish_line(line);
        }
        return collect();
    }

  private:
    [[noreturn]] static void fail(const char* what) { throw Error(ErrorKind::no_result, what); }

    // --- one region ----------------------------------------------------------------------------------------

    void process(Region& region) {
        cut_.enter(region.faces);
        const auto loops = cut_.rim_loops();
        cut_.mark_rim(loops);
        cut_.split_bridges();
        if (cut_in_polygon(region, loops)) return;
        result_.direct = false;
        ++result_.steps;
        const bool disk = is_disk(loops);
        const CutLine line = take_line(region, loops);
        std::vector<Vertex> path = disk ? cut_in_disk(line, loops.front()) : cut_along_edges(line);
        place_crossings(line, path);
        divide(region, line);
    }

    bool is_disk(const std::vector<CutMesh::Loop>& loops) const {
        if (loops.size() != 1) return false;
        std::set<int> seen;
        for (const auto h : loops.front())
            if (!seen.insert(mesh_.from_vertex_handle(h).idx()).second) return false;
        return true;
    }

    /// Rim vertices: nodes at their places, the others between them by length.
    bool place_rim(const std::vector<CutMesh::Loop>& loops) {
        for (const auto& loop : loops) {
            std::size_t start = 0;
            while (start < loop.size() && cut_.node_from(loop[start]) < 0) ++start;
            if (start == loop.size()) return false;
            std::size_t i = 0;
            while (i < loop.size()) {
                // From one node to the next.
                std::vector<double> lengths = {0.0};
                std::size_t j = i;
                do {
                    lengths.push_back(lengths.back() + cut_.length(loop[(start + j) % loop.size()]));
                    ++j;
                } while (cut_.node_from(loop[(start + j) % loop.size()]) < 0);
                const Vec2 from = cut_.node(cut_.node_from(loop[(start + i) % loop.size()])).place;
                const Vec2 to = cut_.node(cut_.node_from(loop[(start + j) % loop.size()])).place;
                for (std::size_t k = i; k < j; ++k) {
                    const double t = lengths.back() > 0.0 ? lengths[k - i] / lengths.back()
                                                          : double(k - i) / double(j - i);
                    Vec2 place = (1.0 - t) * from + t * to;
                    for (int c = 0; c < 2; ++c)
                        if (from[c] == to[c]) place[c] = from[c];
                    cut_.place(mesh_.from_vertex_handle(loop[(start + k) % loop.size()])) = place;
                }
                i = j;
            }
        }
        return true;
    }

    bool cut_in_polygon(Region& region, const std::vector<CutMesh::Loop>& loops) {
        if (!place_rim(loops)) return false;
        if (!cut_.flatten()) return false;
        // First the lines along one axis, then those along the other, which find the crossings.
        for (const int along : {0, 1}) {
            for (const CutLine& line : region.lines) {
                const Vec2 way = cut_.node(line.nodes.back()).place - cut_.node(line.nodes.front()).place;
                if ((std::abs(way.x()) > std::abs(way.y()) ? 0 : 1) != along) continue;
                const auto path = cut_straight(cut_, line);
                if (!path) fail("a block line cannot be cut into its chart");
                if (along == 1) name_crossings(line, *path);
                remember_line(line, *path);
            }
        }
        for (const CutLine& line : region.lines)
            for (const int n : line.nodes)
                if (cut_.node(n).vertex < 0) fail("two block lines do not cross in their chart");
        return true;
    }

    /// Crossings lie where the path meets vertices of the line across.
    void name_crossings(const CutLine& line, const std::vector<Vertex>& path) {
        for (std::size_t k = 1; k + 1 < line.nodes.size(); ++k) {
            const int n = line.nodes[k];
            for (const Vertex v : path)
                if (cut_.is_crossing_candidate(n, v)) cut_.set_node(n, v);
        }
    }
    /// All vertices of a line are candidates for the crossings on it.
    void remember_line(const CutLine& line, const std::vector<Vertex>& path) {
        cut_.finish_line(line);
        for (const Vertex v : path) cut_.add_crossing_candidate(v, cut_.next_line() - 1);
    }
    // --- one line alone ------------------------------------------------------------------------------------

    /// The line to cut first, removed from the region. While the rim has several loops, one that joins two of
    /// them: whichever way it goes around the others, what is left is the same. Else the one that divides the
    /// rim most evenly; not one that ends on a cut whose two sides both are rim, if there is a choice,
    /// because its vertex does not tell from which side it starts.
    CutLine take_line(Region& region, const std::vector<CutMesh::Loop>& loops) const {
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
                if (cut_.node_from(h) >= 0) {
                    Place& p = place[cut_.node_from(h)];
                    p = {static_cast<int>(l), sum, p.times + 1};
                }
                sum += cut_.length(h);
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

    std::vector<Vertex> cut_in_disk(const CutLine& line, const CutMesh::Loop& rim) {
        cut_.round_rim(rim);
        if (!cut_.flatten()) fail("a chart of the polycube cannot be flattened onto a disk");
        const auto path = cut_straight(cut_, line);
        if (!path) fail("a block line cannot be cut into its chart");
        cut_.finish_line(line);
        return *path;
    }

    /// Shortest path of edges through inner vertices.
    std::vector<Vertex> cut_along_edges(const CutLine& line) {
        const Vertex start = cut_.vertex_of(line.nodes.front());
        const Vertex goal = cut_.vertex_of(line.nodes.back());
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
            if (v != start && cut_.on_rim(v)) continue;
            for (const auto h : mesh_.voh_range(v)) {
                if (!cut_.in_region(mesh_.face_handle(h)) || cut_.on_rim(h)) continue;
                const Vertex w = mesh_.to_vertex_handle(h);
                const double longer = d + cut_.length(h);
                if (distance[at(w.idx())] >= 0.0 && distance[at(w.idx())] <= longer) continue;
                distance[at(w.idx())] = longer;
                came[at(w.idx())] = h;
                queue.push({longer, w.idx()});
            }
        }
        if (!done[at(goal.idx())]) fail("a block line finds no way through its chart");
        const int number = cut_.next_line();
        std::vector<Vertex> path = {goal};
        while (path.back() != start) {
            const Halfedge h = came[at(path.back().idx())];
            cut_.put_on_line(h, number);
            path.push_back(mesh_.from_vertex_handle(h));
        }
        std::reverse(path.begin(), path.end());
        cut_.finish_line(line);
        return path;
    }

    /// Puts the crossings on the path where their places divide the line.
    void place_crossings(const CutLine& line, std::vector<Vertex>& path) {
        const Vec2 from = cut_.node(line.nodes.front()).place;
        const Vec2 to = cut_.node(line.nodes.back()).place;
        for (std::size_t k = 1; k + 1 < line.nodes.size(); ++k) {
            const double share = (cut_.node(line.nodes[k]).place - from).norm() / (to - from).norm();
            std::vector<double> lengths = {0.0};
            for (std::size_t i = 1; i < path.size(); ++i)
                lengths.push_back(lengths.back() + (cut_.point(path[i]) - cut_.point(path[i - 1])).norm());
            const double wanted = share * lengths.back();
            // Not before the last crossing.
            std::size_t first = 0;
            for (std::size_t i = 0; i < path.size(); ++i)
                if (cut_.node_at(path[i]) >= 0 && i + 1 < path.size()) first = i;
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
                crossing = cut_.split(mesh_.edge_handle(h),
                                      (1.0 - inner) * cut_.point(path[i]) + inner * cut_.point(path[i + 1]),
                                      0.5 * (cut_.place(path[i]) + cut_.place(path[i + 1])));
                path.insert(path.begin() + static_cast<std::ptrdiff_t>(i) + 1, crossing);
            }
            cut_.set_node(line.nodes[k], crossing);
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
            if (!cut_.in_region(start) || part_of[at(start.idx())] >= 0) continue;
            const int part = static_cast<int>(parts.size());
            Region& fresh = parts.emplace_back();
            std::vector<Face> open = {start};
            part_of[at(start.idx())] = part;
            while (!open.empty()) {
                const Face f = open.back();
                open.pop_back();
                fresh.faces.push_back(f);
                for (const auto h : mesh_.fh_range(f)) {
                    const int node = cut_.node_at(mesh_.to_vertex_handle(h));
                    if (node >= 0) parts_of_node[node].insert(part);
                    if (cut_.on_rim(h)) continue;
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
            const Vec2 from = cut_.node(cut.nodes.front()).place;
            const Vec2 to = cut_.node(cut.nodes.back()).place;
            Vec2 middle = Vec2::Zero();
            for (const int n : piece.nodes) middle += cut_.node(n).place / double(piece.nodes.size());
            const int side = side_of_line(from, to, middle);
            for (const int part : common) {
                int votes = 0;
                for (const auto& [node, in] : parts_of_node)
                    if (in.contains(part) && in.size() == 1)
                        votes += side_of_line(from, to, cut_.node(node).place) == side ? 1 : -1;
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
        for (const auto v : mesh_.vertices()) result_.points.push_back(cut_.point(v));
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
                    if (cut_.line_of(h) >= 0) continue;
                    const Face next = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
                    if (!next.is_valid() || result_.part[at(next.idx())] >= 0) continue;
                    result_.part[at(next.idx())] = parts;
                    open.push_back(next);
                }
            }
            ++parts;
        }
        for (const CutNode& node : cut_.nodes()) result_.node_vertex.push_back(node.vertex);
        return std::move(result_);
    }

    CutMesh cut_;
    const TriangleMesh& mesh_;
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
