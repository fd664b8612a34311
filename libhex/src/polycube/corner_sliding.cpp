#include "polycube/corner_sliding.h"

#include "polycube/block_placement.h"
#include "polycube/chart_cutter.h"

#include <hex/base/error.h>
#include <hex/volume/hexahedron.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <set>

namespace hex {
namespace {

constexpr double sharp_cosine = 0.8;
constexpr std::size_t most_candidates = 250;

/// Places that a vertex is tried at.
constexpr std::size_t most_tries = 5;

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
          cells_(vertex_cells(model.blocks)) {
        int patches = 0;
        for (const int p : model.patch) patches = std::max(patches, p + 1);
        triangles_of_.resize(at(patches));
        for (std::size_t t = 0; t < model.triangles.size(); ++t)
            triangles_of_[at(model.patch[t])].push_back(static_cast<int>(t));
        find_sharp_vertices();
        name_quads();
        allow_bulges();
        for (const VertexId v : model.blocks.vertices()) home_.push_back(model.blocks.position(v));
    }

    std::size_t sweep() {
        std::size_t moves = 0;
        for (const VertexId v : quads_.boundary_vertices) {
            if (penalty(v) <= 0.0) continue;
            if (sharp_[at(model_.vertex_of_node[v.index()])] && worst_corner(v) > 0.0) continue;
            if (slide(v)) ++moves;
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

    double worst_corner(VertexId v) const {
        double worst = 1.0;
        for (const CellId c : cells_[v.index()])
            for (std::size_t k = 0; k < 8; ++k)
                worst = std::min(worst, corner_scaled_jacobian(model_.blocks, c, k));
        return worst;
    }

    bool slide(VertexId v) {
        const int here = model_.vertex_of_node[v.index()];
        std::vector<int> patches;
        for (const QuadId q : quads_.vertex_quads[v.index()]) patches.push_back(patch_of_quad_[q.index()]);
        std::vector<int> triangles;
        for (const int p : patches) {
            if (p < 0) return false;
            triangles.insert(triangles.end(), triangles_of_[at(p)].begin(), triangles_of_[at(p)].end());
        }
        std::sort(triangles.begin(), triangles.end());
        if (std::adjacent_find(triangles.begin(), triangles.end()) != triangles.end()) return false;

        const std::vector<int> candidates = inner_vertices(triangles);
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
        const Vec3 position = model_.blocks.position(v);
        const std::size_t stride = candidates.size() / most_candidates + 1;
        for (std::size_t i = 0; i < candidates.size(); i += stride) {
            if (sharp_[at(candidates[i])] != sharp_[at(here)]) continue;
            model_.blocks.set_position(v, model_.points[at(candidates[i])]);
            const double p = penalty(v);
            if (p >= acceptable || candidates[i] == here) continue;
            const double way = (model_.points[at(candidates[i])] - home_[v.index()]).norm() / reach;
            better.emplace_back(p + price_of_way * way * way, candidates[i]);
        }
        model_.blocks.set_position(v, position);
        std::sort(better.begin(), better.end());
        // Those next to the best one mostly fail as it does.
        for (std::size_t tries = 0, i = 0; tries < most_tries && i < better.size(); ++tries, i += 1 + i) {
            model_.blocks.set_position(v, model_.points[at(better[i].second)]);
            if (recut(v, better[i].second, triangles)) return true;
        }
        model_.blocks.set_position(v, position);
        return false;
    }

    /// Area of a patch by the product of the mean lengths of its opposite sides, taken straight.
    double bulge_of(QuadId q, double area) const {
        const auto& quad = quads_.vertices[q.index()];
        std::array<double, 4> length{};
        for (std::size_t k = 0; k < 4; ++k)
            length[k] = (model_.blocks.position(quad[k]) - model_.blocks.position(quad[(k + 1) % 4])).norm();
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
                for (const int t : triangles_of_[at(patch_of_quad_[q])])
                    area += area_of(model_.points, model_.triangles[at(t)]);
            allowed_bulge_.push_back(std::max(bulging, 1.05 * bulge_of(QuadId(q), area)));
        }
    }

    /// Vertices of the triangles that are not on their rim, ascending.
    std::vector<int> inner_vertices(const std::vector<int>& triangles) const {
        std::vector<std::array<int, 2>> edges;
        std::vector<int> vertices;
        for (const int t : triangles) {
            const auto& c = model_.triangles[at(t)];
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [a, b] = std::minmax(c[k], c[(k + 1) % 3]);
                edges.push_back({a, b});
                vertices.push_back(c[k]);
            }
        }
        std::sort(edges.begin(), edges.end());
        std::vector<int> rim;
        for (std::size_t i = 0; i < edges.size();) {
            std::size_t end = i;
            while (end < edges.size() && edges[end] == edges[i]) ++end;
            if (end - i != 2) rim.insert(rim.end(), edges[i].begin(), edges[i].end());
            i = end;
        }
        const auto sort_once = [](std::vector<int>& numbers) {
            std::sort(numbers.begin(), numbers.end());
            numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
        };
        sort_once(vertices);
        sort_once(rim);
        std::vector<int> inner;
        std::set_difference(vertices.begin(), vertices.end(), rim.begin(), rim.end(),
                            std::back_inserter(inner));
        return inner;
    }

    bool recut(VertexId v, int centre, const std::vector<int>& triangles) {
        CutProblem problem;
        std::vector<int> global;
        std::map<int, int> local;
        for (const int t : triangles) {
            std::array<int, 3> c{};
            for (std::size_t k = 0; k < 3; ++k) {
                const int g = model_.triangles[at(t)][k];
                const auto [entry, fresh] = local.emplace(g, static_cast<int>(global.size()));
                if (fresh) {
                    global.push_back(g);
                    problem.points.push_back(model_.points[at(g)]);
                }
                c[k] = entry->second;
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
                return local.at(model_.vertex_of_node[quad[(k + i) % 4].index()]);
            };
            spokes.push_back(surface(1));
            if (!patch_at_far.emplace(surface(2), patch_of_quad_[q.index()]).second) return false;
        }
        for (const int s : spokes) problem.nodes.push_back({Vec2::Zero(), s});
        const int middle = static_cast<int>(problem.nodes.size());
        problem.nodes.push_back({Vec2::Zero(), local.at(centre)});
        for (int k = 0; k < middle; ++k) problem.lines.push_back({{k, middle}});
        CutResult cut;
        try {
            cut = cut_star(problem);
        } catch (const Error&) {
            return false;
        }
        std::map<int, int> patch_of_part;
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
            if (bulge_of(q, area.at(patch_of_quad_[q.index()])) > allowed_bulge_[q.index()]) return false;

        for (const int t : triangles) {
            triangles_of_[at(model_.patch[at(t)])].clear();
            model_.patch[at(t)] = -1;
        }
        for (std::size_t i = global.size(); i < cut.points.size(); ++i) {
            global.push_back(static_cast<int>(model_.points.size()));
            model_.points.push_back(cut.points[i]);
            sharp_.push_back(0);
        }
        for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
            std::array<int, 3> c{};
            for (std::size_t k = 0; k < 3; ++k) c[k] = global[at(cut.triangles[t][k])];
            const int patch = patch_of_part.at(cut.part[t]);
            triangles_of_[at(patch)].push_back(static_cast<int>(model_.triangles.size()));
            model_.triangles.push_back(c);
            model_.patch.push_back(patch);
        }
        model_.vertex_of_node[v.index()] = centre;
        return true;
    }

    PatchedBlocks& model_;
    double target_;
    BoundaryQuads quads_;
    CompressedRows<CellId> cells_;
    std::vector<std::vector<int>> triangles_of_;  ///< of each patch
    std::vector<char> sharp_;                     ///< vertices on sharp edges
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
