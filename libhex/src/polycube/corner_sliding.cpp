#include "polycube/corner_sliding.h"

#include "polycube/block_placement.h"
#include "polycube/chart_cutter.h"
#include "polycube/patch_triangles.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/volume/hexahedron.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace hex {
namespace {

constexpr double sharp_cosine = 0.8;
constexpr std::size_t most_candidates = 250;

/// Places that a vertex is tried at.
constexpr std::size_t most_tries = 5;

/// Vertices whose moves are looked for side by side, and how far ahead these are sought.
constexpr std::size_t side_by_side = 8;
constexpr std::size_t look_ahead = 64;

/// A patch with more than this times the area that its four sides span bulges. Harmonic coordinates shrink
/// all that is far up a finger to a point, and no mesh follows it there.
constexpr double bulging = 1.3;
/// Price of being away from the first place by the length of the edges around. It keeps patches in shape: a
/// place is no better for the blocks when the triangles around it are far.
constexpr double price_of_way = 0.3;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

class Slider {
  public:
    Slider(PatchedBlocks& model, double target)
        : model_(model),
          target_(target),
          quads_(boundary_quads(model.blocks)),
          cells_(vertex_cells(model.blocks)),
          patches_(model.triangles, model.patch),
          marked_(model.blocks.cell_count(), 0) {
        find_sharp_vertices();
        name_quads();
        allow_bulges();
        for (const VertexId v : model.blocks.vertices()) home_.push_back(model.blocks.position(v));
    }

    /// Vertex after vertex moves. Moves of vertices that have no block in common do not change each other, so
    /// those of some vertices ahead are found at the same time.
    std::size_t sweep() {
        std::size_t moves = 0;
        const auto& order = quads_.boundary_vertices;
        Known known;
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (!wants_to_move(order[i])) continue;
            if (!known.contains(i)) look_ahead_from(i, known);
            const std::optional<Move> move = std::move(known.extract(i).mapped());
            if (!move) continue;
            make(*move);
            ++moves;
            mark_blocks(order[i], 1);
            std::erase_if(known, [&](const auto& entry) { return is_marked(order[entry.first]); });
            mark_blocks(order[i], 0);
        }
        return moves;
    }

    void finish() {
        std::vector<std::array<int, 3>> triangles;
        std::vector<int> patch;
        for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
            if (model_.patch[t] < 0) continue;
            triangles.push_back(model_.triangles[t]);
            patch.push_back(model_.patch[t]);
        }
        model_.triangles = std::move(triangles);
        model_.patch = std::move(patch);
    }

  private:
    /// A block vertex goes to another vertex of the surface, and the triangles around it are cut anew.
    struct Move {
        VertexId v;
        int centre = -1;
        std::vector<int> triangles;  ///< cut
        std::vector<int> global;     ///< vertices of the surface, by vertices of the cut
        CutResult cut;
        std::map<int, int> patch_of_part;
    };

    bool wants_to_move(VertexId v) const {
        if (penalty(v) <= 0.0) return false;
        return !(sharp_[at(model_.vertex_of_node[v.index()])] && worst_corner(v) > 0.0);
    }

    void mark_blocks(VertexId v, char mark) {
        for (const CellId c : cells_[v.index()]) marked_[c.index()] = mark;
    }
    bool is_marked(VertexId v) const {
        const auto cells = cells_[v.index()];
        return std::any_of(cells.begin(), cells.end(), [&](CellId c) { return marked_[c.index()] != 0; });
    }

    /// Moves that have been looked for, by the vertex's place in the order; null: the vertex stays.
    using Known = std::map<std::size_t, std::optional<Move>>;

    /// Looks for the move of vertex i, and for those of vertices behind it that no other before them changes.
    void look_ahead_from(std::size_t i, Known& known) {
        const auto& order = quads_.boundary_vertices;
        const std::size_t end = std::min(order.size(), i + look_ahead);
        std::vector<std::size_t> together;
        std::vector<std::vector<int>> places;
        std::vector<VertexId> marked;
        for (std::size_t k = i; k < end && together.size() < side_by_side; ++k) {
            if (!wants_to_move(order[k])) continue;
            const auto found = known.find(k);
            if (found == known.end() && !is_marked(order[k])) {
                places.push_back(better_places(order[k]));
                if (places.back().empty()) {
                    places.pop_back();
                    known.emplace(k, std::nullopt);
                    continue;
                }
                together.push_back(k);
            } else if (found != known.end() && !found->second) {
                continue;
            }
            mark_blocks(order[k], 1);
            marked.push_back(order[k]);
        }
        for (const VertexId v : marked) mark_blocks(v, 0);
        std::vector<std::optional<Move>> moves(together.size());
        parallel_for(
            together.size(), [&](std::size_t k) { moves[k] = find_move(order[together[k]], places[k]); }, 1);
        for (std::size_t k = 0; k < together.size(); ++k)
            known.insert_or_assign(together[k], std::move(moves[k]));
    }

    Vec3 normal(int t) const {
        const auto& c = model_.triangles[at(t)];
        return (model_.points[at(c[1])] - model_.points[at(c[0])])
            .cross(model_.points[at(c[2])] - model_.points[at(c[0])])
            .normalized();
    }

    void find_sharp_vertices() {
        sharp_.assign(model_.points.size(), 0);
        std::map<std::array<int, 2>, int> first;
        for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
            const auto& c = model_.triangles[t];
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [a, b] = std::minmax(c[k], c[(k + 1) % 3]);
                const auto [entry, fresh] = first.emplace(std::array{a, b}, static_cast<int>(t));
                if (fresh) continue;
                if (normal(entry->second).dot(normal(static_cast<int>(t))) < sharp_cosine)
                    sharp_[at(a)] = sharp_[at(b)] = 1;
            }
        }
    }

    /// Which patch each boundary quad is, by its corners.
    void name_quads() {
        std::map<int, std::set<int>> patches_at;  // by surface vertex of a block vertex
        std::set<int> wanted;
        for (const int v : model_.vertex_of_node)
            if (v >= 0) wanted.insert(v);
        for (std::size_t t = 0; t < model_.triangles.size(); ++t)
            for (const int v : model_.triangles[t])
                if (wanted.contains(v)) patches_at[v].insert(model_.patch[t]);
        for (const auto& quad : quads_.vertices) {
            int found = -1;
            for (const int p : patches_at[model_.vertex_of_node[quad[0].index()]]) {
                bool all = true;
                for (const VertexId v : quad)
                    all = all && patches_at[model_.vertex_of_node[v.index()]].contains(p);
                if (all) found = found < 0 ? p : found;
            }
            patch_of_quad_.push_back(found);
        }
    }

    double penalty(VertexId v) const {
        double sum = 0.0;
        for (const CellId c : cells_[v.index()]) {
            for (std::size_t k = 0; k < 8; ++k) {
                const double lack = target_ - corner_scaled_jacobian(model_.blocks, c, k);
                if (lack > 0.0) sum += lack * lack;
            }
        }
        return sum;
    }

    /// What penalty(v) is when v is elsewhere.
    class PenaltyElsewhere {
      public:
        PenaltyElsewhere(const Slider& slider, VertexId v) : slider_(slider), v_(v) {
            for (const CellId c : slider.cells_[v.index()]) {
                for (std::size_t k = 0; k < 8; ++k) {
                    const bool fixed = !touches(slider.model_.blocks.cell(c), k, v);
                    const double lack =
                        fixed ? slider.target_ - corner_scaled_jacobian(slider.model_.blocks, c, k) : 0.0;
                    corners_.push_back({c, k, fixed, lack});
                }
            }
        }
        double operator()(const Vec3& place) const {
            double sum = 0.0;
            for (const Corner& corner : corners_) {
                const double lack = corner.fixed ? corner.lack
                                                 : slider_.target_ - corner_scaled_jacobian(
                                                                         slider_.model_.blocks, corner.block,
                                                                         corner.k, v_, place);
                if (lack > 0.0) sum += lack * lack;
            }
            return sum;
        }

      private:
        struct Corner {
            CellId block;
            std::size_t k;
            bool fixed;  ///< does not depend on where v is
            double lack;
        };
        const Slider& slider_;
        VertexId v_;
        std::vector<Corner> corners_;
    };

    double worst_corner(VertexId v) const {
        double worst = 1.0;
        for (const CellId c : cells_[v.index()])
            for (std::size_t k = 0; k < 8; ++k)
                worst = std::min(worst, corner_scaled_jacobian(model_.blocks, c, k));
        return worst;
    }

    /// The patches around a vertex; none if they cannot be cut anew.
    std::vector<int> patches_around(VertexId v) const {
        std::vector<int> patches;
        for (const QuadId q : quads_.vertex_quads[v.index()]) {
            const int p = patch_of_quad_[q.index()];
            if (p < 0) return {};
            if (std::find(patches.begin(), patches.end(), p) != patches.end() &&
                !patches_.triangles(p).empty())
                return {};
            patches.push_back(p);
        }
        return patches;
    }

    /// Where a vertex would be better for the blocks, the best place first.
    std::vector<int> better_places(VertexId v) const {
        const int here = model_.vertex_of_node[v.index()];
        const std::vector<int> patches = patches_around(v);
        if (patches.empty()) return {};
        const std::vector<int> candidates = patches_.inner_vertices(patches);
        const double before = penalty(v);
        double reach = 0.0;
        for (const QuadId q : quads_.vertex_quads[v.index()]) {
            const auto& quad = quads_.vertices[q.index()];
            const auto k = static_cast<std::size_t>(std::find(quad.begin(), quad.end(), v) - quad.begin());
            reach += (model_.blocks.position(quad[(k + 1) % 4]) - model_.blocks.position(v)).norm();
        }
        reach /= static_cast<double>(patches.size());
        const double acceptable = before * 0.98 - 1e-4;
        std::vector<std::pair<double, int>> better;
        const PenaltyElsewhere penalty_at(*this, v);
        const std::size_t stride = candidates.size() / most_candidates + 1;
        for (std::size_t i = 0; i < candidates.size(); i += stride) {
            if (sharp_[at(candidates[i])] != sharp_[at(here)] || candidates[i] == here) continue;
            const double p = penalty_at(model_.points[at(candidates[i])]);
            if (p >= acceptable) continue;
            const double way = (model_.points[at(candidates[i])] - home_[v.index()]).norm() / reach;
            better.emplace_back(p + price_of_way * way * way, candidates[i]);
        }
        std::sort(better.begin(), better.end());
        std::vector<int> places;
        for (const auto& [price, place] : better) places.push_back(place);
        return places;
    }

    std::optional<Move> find_move(VertexId v, const std::vector<int>& places) const {
        Move move;
        move.v = v;
        for (const int p : patches_around(v)) {
            const std::vector<int>& triangles = patches_.triangles(p);
            move.triangles.insert(move.triangles.end(), triangles.begin(), triangles.end());
        }
        std::sort(move.triangles.begin(), move.triangles.end());
        // Those next to the best one mostly fail as it does.
        for (std::size_t tries = 0, i = 0; tries < most_tries && i < places.size(); ++tries, i += 1 + i) {
            move.centre = places[i];
            if (recut(move)) return move;
        }
        return {};
    }

    /// Area of a patch by the product of the mean lengths of its opposite sides, taken straight; after a
    /// move.
    double bulge_of(QuadId q, double area, const Move* move = nullptr) const {
        const auto& quad = quads_.vertices[q.index()];
        const auto place = [&](std::size_t k) -> const Vec3& {
            const VertexId v = quad[k % 4];
            return move != nullptr && move->v == v ? model_.points[at(move->centre)]
                                                   : model_.blocks.position(v);
        };
        std::array<double, 4> length{};
        for (std::size_t k = 0; k < 4; ++k) length[k] = (place(k) - place(k + 1)).norm();
        const double spanned = 0.25 * (length[0] + length[2]) * (length[1] + length[3]);
        return spanned > 0.0 ? area / spanned : std::numeric_limits<double>::infinity();
    }

    double area_of(const std::vector<Vec3>& points, const std::array<int, 3>& c) const {
        return 0.5 * (points[at(c[1])] - points[at(c[0])]).cross(points[at(c[2])] - points[at(c[0])]).norm();
    }

    /// What each patch may bulge, however often its corners move.
    void allow_bulges() {
        for (std::size_t q = 0; q < quads_.size(); ++q) {
            double area = 0.0;
            if (patch_of_quad_[q] >= 0)
                for (const int t : patches_.triangles(patch_of_quad_[q]))
                    area += area_of(model_.points, model_.triangles[at(t)]);
            allowed_bulge_.push_back(std::max(bulging, 1.05 * bulge_of(QuadId(q), area)));
        }
    }

    /// Cuts the triangles of a move for its centre. Returns whether that is possible.
    bool recut(Move& move) const {
        const VertexId v = move.v;
        CutProblem problem;
        std::vector<int>& global = move.global;
        global.clear();
        std::vector<int> local(model_.points.size(), -1);
        for (const int t : move.triangles) {
            std::array<int, 3> c{};
            for (std::size_t k = 0; k < 3; ++k) {
                const int g = model_.triangles[at(t)][k];
                if (local[at(g)] < 0) {
                    local[at(g)] = static_cast<int>(global.size());
                    global.push_back(g);
                    problem.points.push_back(model_.points[at(g)]);
                }
                c[k] = local[at(g)];
            }
            problem.triangles.push_back(c);
        }
        // The neighbours of v along the quads, each once; and which patch has each corner opposite v.
        std::vector<int> spokes;
        std::map<int, int> patch_at_far;  // by local vertex
        for (const QuadId q : quads_.vertex_quads[v.index()]) {
            const auto& quad = quads_.vertices[q.index()];
            const auto k = static_cast<std::size_t>(std::find(quad.begin(), quad.end(), v) - quad.begin());
            const auto surface = [&](std::size_t i) {
                return local[at(model_.vertex_of_node[quad[(k + i) % 4].index()])];
            };
            spokes.push_back(surface(1));
            if (!patch_at_far.emplace(surface(2), patch_of_quad_[q.index()]).second) return false;
        }
        if (std::find(spokes.begin(), spokes.end(), -1) != spokes.end()) return false;
        for (const int s : spokes) problem.nodes.push_back({Vec2::Zero(), s});
        const int middle = static_cast<int>(problem.nodes.size());
        problem.nodes.push_back({Vec2::Zero(), local[at(move.centre)]});
        for (int k = 0; k < middle; ++k) problem.lines.push_back({{k, middle}});
        CutResult& cut = move.cut;
        try {
            cut = cut_star(problem);
        } catch (const Error&) {
            return false;
        }
        std::map<int, int>& patch_of_part = move.patch_of_part;
        patch_of_part.clear();
        for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
            for (const int c : cut.triangles[t]) {
                const auto far = patch_at_far.find(c);
                if (far != patch_at_far.end()) patch_of_part.emplace(cut.part[t], far->second);
            }
        }
        const int parts = *std::max_element(cut.part.begin(), cut.part.end()) + 1;
        std::set<int> named;
        for (const auto& [part, patch] : patch_of_part) named.insert(patch);
        if (at(parts) != spokes.size() || patch_of_part.size() != at(parts) || named.size() != at(parts))
            return false;

        std::map<int, double> area;  // by patch
        for (std::size_t t = 0; t < cut.triangles.size(); ++t)
            area[patch_of_part.at(cut.part[t])] += area_of(cut.points, cut.triangles[t]);
        for (const QuadId q : quads_.vertex_quads[v.index()])
            if (bulge_of(q, area.at(patch_of_quad_[q.index()]), &move) > allowed_bulge_[q.index()])
                return false;
        return true;
    }

    void make(const Move& move) {
        const CutResult& cut = move.cut;
        for (const int t : move.triangles) model_.patch[at(t)] = -1;
        std::vector<int> global = move.global;
        for (std::size_t i = global.size(); i < cut.points.size(); ++i) {
            global.push_back(static_cast<int>(model_.points.size()));
            model_.points.push_back(cut.points[i]);
            sharp_.push_back(0);
        }
        std::map<int, std::vector<int>> made;  // triangles by patch
        for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
            std::array<int, 3> c{};
            for (std::size_t k = 0; k < 3; ++k) c[k] = global[at(cut.triangles[t][k])];
            const int patch = move.patch_of_part.at(cut.part[t]);
            made[patch].push_back(static_cast<int>(model_.triangles.size()));
            model_.triangles.push_back(c);
            model_.patch.push_back(patch);
        }
        for (auto& [patch, triangles] : made) patches_.replace(patch, std::move(triangles), model_.triangles);
        model_.vertex_of_node[move.v.index()] = move.centre;
        model_.blocks.set_position(move.v, model_.points[at(move.centre)]);
    }

    PatchedBlocks& model_;
    double target_;
    BoundaryQuads quads_;
    CompressedRows<CellId> cells_;
    PatchTriangles patches_;
    std::vector<char> marked_;  ///< blocks
    std::vector<char> sharp_;   ///< vertices on sharp edges
    std::vector<int> patch_of_quad_;
    std::vector<double> allowed_bulge_;  ///< of each quad
    std::vector<Vec3> home_;             ///< where each block vertex was at first
};

}  // namespace

std::size_t slide_corners(PatchedBlocks& model, double target, int sweeps, const Context& context) {
    std::vector<char> free;
    for (const int v : model.vertex_of_node) free.push_back(v < 0);
    Slider slider(model, target);
    std::size_t moves = 0;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        context.check_cancelled();
        const std::size_t moved = slider.sweep();
        moves += moved;
        if (moved == 0) break;
        place_inner_vertices(model.blocks, free);
    }
    slider.finish();
    return moves;
}

}  // namespace hex
