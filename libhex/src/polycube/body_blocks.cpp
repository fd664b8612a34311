#include "polycube/body_blocks.h"

#include "polycube/block_complex.h"
#include "polycube/block_placement.h"
#include "polycube/chart_cutter.h"
#include "polycube/chart_graph.h"
#include "polycube/integer_polycube.h"
#include "polycube/plane_placement.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace hex {
namespace {

Vec3 point_of(const TriangleMesh& mesh, int vertex) {
    return to_eigen(mesh.point(TriangleMesh::VertexHandle(vertex)));
}

class BlockMaker {
  public:
    BlockMaker(TriangleMesh labelled, double unit, std::vector<int> chart_ids, const Context& context)
        : context_(context), work_(std::move(labelled)), unit_(unit), chart_ids_(std::move(chart_ids)) {}

    BodyBlocks make() {
        step("charts", 0.0);
        graph_ = build_chart_graph(work_);
        report().charts = graph_.charts.size();
        report().sides = graph_.sides.size();
        report().corners = graph_.layout.corners.size();
        report().turned_sides = graph_.turned_sides.size();
        report().unit = unit_;
        if (!graph_.violations.empty()) return give_up(graph_.violations);
        measure_charts();
        step("integer polycube", 0.1);
        Diagnostics violations = solve();
        if (!violations.empty()) return give_up(std::move(violations));
        step("block lines", 0.4);
        places_ = place_planes(graph_, complex_, level_, unit_);
        insert_side_nodes();
        cut_charts();
        step("blocks", 0.9);
        assemble();
        step("blocks", 1.0);
        return std::move(result_);
    }

  private:
    BlocksReport& report() { return result_.report; }

    void step(const char* name, double share) const {
        context_.check_cancelled();
        context_.progress(name, share);
    }

    BodyBlocks give_up(Diagnostics violations) {
        report().violations = std::move(violations);
        return std::move(result_);
    }

    /// Number of a chart in the whole surface.
    int id(int chart) const { return chart_ids_[at(chart)]; }
    std::string name(int chart) const {
        return std::to_string(id(chart)) + " (" + label_name(graph_.charts[at(chart)].label) + ")";
    }

    /// Mean coordinate of each chart along its axis.
    void measure_charts() {
        std::vector<double> area(graph_.charts.size(), 0.0);
        level_.assign(graph_.charts.size(), 0.0);
        for (const auto f : work_.faces()) {
            std::array<Vec3, 3> p;
            std::size_t k = 0;
            for (const auto v : work_.fv_range(f)) p[k++] = to_eigen(work_.point(v));
            const double a = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
            const int chart = graph_.layout.patch_of_triangle[at(f.idx())];
            area[at(chart)] += a;
            level_[at(chart)] += a * ((p[0] + p[1] + p[2]) / 3.0)[axis_of(graph_.charts[at(chart)].label)];
        }
        for (std::size_t c = 0; c < area.size(); ++c)
            if (area[c] > 0.0) level_[c] /= area[c];
    }

    Diagnostics solve() {
        Diagnostics violations;
        PlaneOrders orders(graph_);
        for (const PlaneOrder& order : side_orders(graph_)) {
            if (orders.add(order)) continue;
            const std::vector<int> cycle = orders.cycle(order);
            std::string names;
            std::vector<std::int64_t> ids;
            for (const int chart : cycle) {
                names += (names.empty() ? "" : " below ") + name(chart);
                ids.push_back(id(chart));
            }
            const ChartSide& side = graph_.sides[at(order.side)];
            violations.push_back({Severity::error, "infeasible-orders",
                                  "the side between charts " + name(side.charts[0]) + " and " +
                                      name(side.charts[1]) + " puts chart " + name(order.low) +
                                      " below chart " + name(order.high) + ", but others put " + names,
                                  "chart", std::move(ids)});
        }
        if (!violations.empty()) return violations;
        for (const PlaneOrder& order : ray_orders(work_, graph_)) orders.add(order);

        for (int round = 0; round < 40; ++round) {
            context_.check_cancelled();
            coordinates_ = solve_coordinates(graph_, orders, unit_);
            complex_ = build_blocks(graph_, coordinates_);
            report().rounds = at(round) + 1;
            report().orders = orders.orders().size();
            if (complex_.conflicts.empty()) break;
            if (!part_conflicts(orders)) break;
        }
        for (const ChartConflict& conflict : complex_.conflicts)
            violations.push_back({Severity::error,
                                  "charts-overlap",
                                  conflict.chart == conflict.other
                                      ? "chart " + name(conflict.chart) + " is folded over itself"
                                      : "charts " + name(conflict.chart) + " and " + name(conflict.other) +
                                            " lie over each other",
                                  "chart",
                                  {id(conflict.chart), id(conflict.other)}});
        for (std::size_t a = 0; a < 3; ++a) report().planes[a] = complex_.planes[a].size();
        report().cells = complex_.cells;
        return violations;
    }

    /// Where charts lie over each other or touch, they take the order that they have in space, and where that
    /// is not enough the charts around them do.
    bool part_conflicts(PlaneOrders& orders) const {
        std::set<int> near;
        for (const ChartConflict& conflict : complex_.conflicts) {
            near.insert(conflict.chart);
            near.insert(conflict.other);
        }
        if (part(near, orders)) return true;
        const std::set<int> centre = near;
        for (const ChartSide& side : graph_.sides) {
            if (centre.contains(side.charts[0])) near.insert(side.charts[1]);
            if (centre.contains(side.charts[1])) near.insert(side.charts[0]);
        }
        return part(near, orders);
    }

    bool part(const std::set<int>& charts, PlaneOrders& orders) const {
        bool any = false;
        for (const int low : charts) {
            for (const int high : charts) {
                if (axis_of(graph_.charts[at(low)].label) != axis_of(graph_.charts[at(high)].label)) continue;
                const double gap = level_[at(high)] - level_[at(low)];
                if (gap <= 0.0 || coordinates_[at(low)] < coordinates_[at(high)]) continue;
                PlaneOrder order;
                order.low = low;
                order.high = high;
                order.length = gap;
                order.weight = 0.1;
                any = orders.add(order) || any;
            }
        }
        return any;
    }

    // --- surface -------------------------------------------------------------------------------------------

    /// Makes the block vertices on the sides vertices of the mesh: at the length of the chain that their
    /// place between the ends gives.
    void insert_side_nodes() {
        for (const auto f : work_.faces()) work_.data(f).part = graph_.layout.patch_of_triangle[at(f.idx())];
        vertex_of_node_.assign(complex_.positions.size(), -1);
        for (std::size_t s = 0; s < graph_.sides.size(); ++s) {
            ChartSide& side = graph_.sides[s];
            const auto& nodes = complex_.side_nodes[s];
            vertex_of_node_[at(nodes.front().vertex)] = side.chain.front();
            vertex_of_node_[at(nodes.back().vertex)] = side.chain.back();
            const double from = places_[at(nodes.front().vertex)][side.axis];
            const double to = places_[at(nodes.back().vertex)][side.axis];
            std::size_t last = 0;  // index in the chain of the node before
            for (std::size_t n = 1; n + 1 < nodes.size(); ++n) {
                const double share = (places_[at(nodes[n].vertex)][side.axis] - from) / (to - from);
                last = insert_node(side, share, last);
                vertex_of_node_[at(nodes[n].vertex)] = side.chain[last];
            }
        }
    }

    /// How far along a side each vertex of its chain is, from 0 to 1: by halves the length so far and the way
    /// made in the side's direction, so that planes stay flat where the side is oblique and nothing bunches
    /// up where it is level.
    std::vector<double> progress_along(const ChartSide& side) const {
        std::vector<double> length = {0.0};
        std::vector<double> rise = {0.0};
        for (std::size_t i = 1; i < side.chain.size(); ++i) {
            const Vec3 edge = point_of(work_, side.chain[i]) - point_of(work_, side.chain[i - 1]);
            length.push_back(length.back() + edge.norm());
            rise.push_back(rise.back() + std::max(0.0, side.direction * edge[side.axis]));
        }
        std::vector<double> progress;
        for (std::size_t i = 0; i < length.size(); ++i) {
            const double l = length.back() > 0.0
                                 ? length[i] / length.back()
                                 : static_cast<double>(i) / static_cast<double>(length.size() - 1);
            progress.push_back(rise.back() > 0.0 ? 0.5 * (l + rise[i] / rise.back()) : l);
        }
        return progress;
    }

    /// Returns the index in the chain of a vertex near `share` of the way, after `last`.
    std::size_t insert_node(ChartSide& side, double share, std::size_t last) {
        Chain& chain = side.chain;
        const std::vector<double> progress = progress_along(side);
        const double wanted = std::max(share, progress[last]);
        std::size_t i = last;
        while (i + 2 < chain.size() && progress[i + 1] < wanted) ++i;
        const double span = progress[i + 1] - progress[i];
        const double t = span > 0.0 ? std::clamp((wanted - progress[i]) / span, 0.0, 1.0) : 0.5;
        if (t < 0.25 && i > last) return i;
        if (t > 0.75 && i + 2 < chain.size()) return i + 1;
        const double inner = std::clamp(t, 0.25, 0.75);
        const Vec3 p = (1.0 - inner) * point_of(work_, chain[i]) + inner * point_of(work_, chain[i + 1]);
        const auto h = work_.find_halfedge(TriangleMesh::VertexHandle(chain[i]),
                                           TriangleMesh::VertexHandle(chain[i + 1]));
        const auto v = work_.add_vertex(to_openmesh(p));
        work_.split_copy(work_.edge_handle(h), v);
        chain.insert(chain.begin() + static_cast<std::ptrdiff_t>(i) + 1, v.idx());
        return i + 1;
    }

    struct ChartPiece {
        CutProblem problem;
        std::vector<int> vertices;     ///< of the work mesh, one a point
        std::vector<int> block_nodes;  ///< block vertex of each node
        CutResult result;
    };

    void cut_charts() {
        pieces_.resize(graph_.charts.size());
        std::vector<std::vector<int>> triangles(pieces_.size());
        for (const auto f : work_.faces()) triangles[at(work_.data(f).part)].push_back(f.idx());
        std::vector<std::string> failures(pieces_.size());
        parallel_for(
            pieces_.size(),
            [&](std::size_t c) {
                fill_problem(static_cast<int>(c), triangles[c]);
                try {
                    pieces_[c].result = cut_chart(pieces_[c].problem);
                } catch (const Error& error) {
                    failures[c] = error.problem();
                }
            },
            1);
        for (std::size_t c = 0; c < failures.size(); ++c)
            if (!failures[c].empty())
                throw Error(ErrorKind::no_result, failures[c], "chart " + name(static_cast<int>(c)));
        for (const ChartPiece& piece : pieces_) report().cut_alone += at(piece.result.steps);
    }

    void fill_problem(int chart, const std::vector<int>& triangles) {
        ChartPiece& piece = pieces_[at(chart)];
        std::map<int, int> local;
        for (const int f : triangles) {
            std::array<int, 3> t{};
            std::size_t k = 0;
            for (const auto v : work_.fv_range(TriangleMesh::FaceHandle(f))) {
                const auto [entry, fresh] = local.emplace(v.idx(), static_cast<int>(piece.vertices.size()));
                if (fresh) {
                    piece.vertices.push_back(v.idx());
                    piece.problem.points.push_back(to_eigen(work_.point(v)));
                }
                t[k++] = entry->second;
            }
            piece.problem.triangles.push_back(t);
        }
        std::map<int, int> node_of;  // by block vertex
        const auto node = [&](int block_vertex, bool boundary) {
            const auto [entry, fresh] =
                node_of.emplace(block_vertex, static_cast<int>(piece.problem.nodes.size()));
            if (fresh) {
                CutNode& n = piece.problem.nodes.emplace_back();
                n.place = plane_place(chart, block_vertex);
                if (boundary) n.vertex = local.at(vertex_of_node_[at(block_vertex)]);
                piece.block_nodes.push_back(block_vertex);
            }
            return entry->second;
        };
        for (const auto& loop : graph_.charts[at(chart)].loops)
            for (const SideUse& use : loop)
                for (const SideNode& n : complex_.side_nodes[at(use.side)]) node(n.vertex, true);
        for (const ChartSegment& segment : complex_.segments[at(chart)]) {
            CutLine& line = piece.problem.lines.emplace_back();
            line.nodes.push_back(node(segment.vertices[0], true));
            for (const auto& crossing : segment.crossings) line.nodes.push_back(node(crossing[1], false));
            line.nodes.push_back(node(segment.vertices[1], true));
        }
    }

    /// A block vertex in the plane of a chart, seen from outside.
    Vec2 plane_place(int chart, int block_vertex) const {
        const int label = graph_.charts[at(chart)].label;
        const int u = (axis_of(label) + 1) % 3;
        const int v = (axis_of(label) + 2) % 3;
        const Vec3& place = places_[at(block_vertex)];
        const Vec2 p(place[u], place[v]);
        return sign_of(label) > 0 ? p : Vec2(p.y(), p.x());
    }

    // --- result --------------------------------------------------------------------------------------------

    void assemble() {
        PatchedBlocks& model = result_.model;
        for (const auto v : work_.vertices()) model.points.push_back(to_eigen(work_.point(v)));
        int patches = 0;
        for (ChartPiece& piece : pieces_) {
            for (std::size_t i = piece.vertices.size(); i < piece.result.points.size(); ++i) {
                piece.vertices.push_back(static_cast<int>(model.points.size()));
                model.points.push_back(piece.result.points[i]);
            }
            for (std::size_t t = 0; t < piece.result.triangles.size(); ++t) {
                auto& triangle = model.triangles.emplace_back();
                for (std::size_t k = 0; k < 3; ++k)
                    triangle[k] = piece.vertices[at(piece.result.triangles[t][k])];
                model.patch.push_back(patches + piece.result.part[t]);
            }
            patches += *std::max_element(piece.result.part.begin(), piece.result.part.end()) + 1;
            for (std::size_t n = 0; n < piece.block_nodes.size(); ++n)
                vertex_of_node_[at(piece.block_nodes[n])] = piece.vertices[at(piece.result.node_vertex[n])];
        }
        report().patches = at(patches);
        model.vertex_of_node = vertex_of_node_;
        place_blocks(model);
        if (block_quality(model.blocks).min_scaled_jacobian < least_scaled_jacobian)
            report().slides = slide_corners(model, least_scaled_jacobian, 12, context_);
        report().blocks = model.blocks.cell_count();
        const BlockQuality quality = block_quality(model.blocks);
        report().min_scaled_jacobian = quality.min_scaled_jacobian;
        report().inverted_corners = quality.inverted_corners;
        if (quality.inverted_corners > 0)
            report().violations.push_back(
                {Severity::warning, "inverted-block",
                 std::to_string(quality.inverted_blocks.size()) + " blocks have an inverted or flat corner",
                 "block", quality.inverted_blocks});
    }

    void place_blocks(PatchedBlocks& model) const {
        std::vector<Vec3> positions;
        std::vector<char> free;
        for (const int v : model.vertex_of_node) {
            free.push_back(v < 0);
            positions.push_back(v < 0 ? Vec3::Zero().eval() : model.points[at(v)]);
        }
        start_inner(free, positions);
        std::vector<HexCell> cells;
        for (const auto& block : complex_.blocks) {
            HexCell& cell = cells.emplace_back();
            for (std::size_t k = 0; k < 8; ++k) cell[k] = VertexId(at(block[k]));
        }
        model.blocks = HexMesh(std::move(positions), std::move(cells));
        place_inner_vertices(model.blocks, free);
    }

    /// A start for the inner vertices: the middle of the others.
    static void start_inner(const std::vector<char>& free, std::vector<Vec3>& positions) {
        Vec3 middle = Vec3::Zero();
        double count = 0.0;
        for (std::size_t n = 0; n < positions.size(); ++n) {
            if (free[n]) continue;
            middle += positions[n];
            count += 1.0;
        }
        for (std::size_t n = 0; n < positions.size(); ++n)
            if (free[n]) positions[n] = middle / count;
    }

    /// Block corners below this scaled Jacobian make their vertices slide.
    static constexpr double least_scaled_jacobian = 0.2;

    const Context& context_;
    TriangleMesh work_;
    double unit_;
    std::vector<int> chart_ids_;
    ChartGraph graph_;
    std::vector<double> level_;
    std::vector<int> coordinates_;
    BlockComplex complex_;
    std::vector<Vec3> places_;         ///< of block vertices in a polycube with real coordinates
    std::vector<int> vertex_of_node_;  ///< surface vertex of each block vertex, or -1
    std::vector<ChartPiece> pieces_;
    BodyBlocks result_;
};

}  // namespace

BodyBlocks make_body_blocks(TriangleMesh labelled, double unit, std::vector<int> chart_ids,
                            const Context& context) {
    return BlockMaker(std::move(labelled), unit, std::move(chart_ids), context).make();
}

}  // namespace hex
