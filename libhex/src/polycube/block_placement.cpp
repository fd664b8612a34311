#include "polycube/block_placement.h"

#include <hex/volume/hexahedron.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <cmath>

namespace hex {
namespace {

template <class Positions>
double corner_determinant(const HexCell& cell, std::size_t k, bool scaled, const Positions& at) {
    const Vec3& p = at(cell[k]);
    const auto& n = hexahedron::corner_neighbours[k];
    const auto edge = [&](std::size_t i) { return Vec3(at(cell[static_cast<std::size_t>(n[i])]) - p); };
    const Vec3 a = edge(0), b = edge(1), d = edge(2);
    const double det = a.cross(b).dot(d);
    if (!scaled) return det;
    const double size = a.norm() * b.norm() * d.norm();
    return size > 0.0 ? det / size : -1.0;
}

double corner_determinant(const HexMesh& blocks, CellId c, std::size_t k, bool scaled) {
    return corner_determinant(blocks.cell(c), k, scaled,
                              [&](VertexId v) -> const Vec3& { return blocks.position(v); });
}

/// Smallest scaled determinant of the corners of cells that v does, or does not, have a part in; only whether
/// it is above `enough` matters.
double worst_corner(const HexMesh& blocks, std::span<const CellId> cells, VertexId v, bool with_part,
                    double enough) {
    double worst = 1.0;
    for (const CellId c : cells) {
        for (std::size_t k = 0; k < 8; ++k) {
            if (touches(blocks.cell(c), k, v) != with_part) continue;
            worst = std::min(worst, corner_determinant(blocks, c, k, true));
            if (worst <= enough) return worst;
        }
    }
    return worst;
}

}  // namespace

double corner_scaled_jacobian(const HexMesh& blocks, CellId c, std::size_t k) {
    return corner_determinant(blocks, c, k, true);
}

double corner_scaled_jacobian(const HexMesh& blocks, CellId c, std::size_t k, VertexId v, const Vec3& place) {
    return corner_determinant(blocks.cell(c), k, true,
                              [&](VertexId w) -> const Vec3& { return w == v ? place : blocks.position(w); });
}

bool touches(const HexCell& block, std::size_t k, VertexId v) {
    const auto& n = hexahedron::corner_neighbours[k];
    return block[k] == v || std::any_of(n.begin(), n.end(), [&](int neighbour) {
               return block[static_cast<std::size_t>(neighbour)] == v;
           });
}

BlockQuality block_quality(const HexMesh& blocks) {
    BlockQuality quality;
    quality.min_scaled_jacobian = 1.0;
    for (const CellId c : blocks.cells()) {
        std::size_t bad = 0;
        for (std::size_t k = 0; k < 8; ++k) {
            quality.min_scaled_jacobian =
                std::min(quality.min_scaled_jacobian, corner_determinant(blocks, c, k, true));
            if (!(corner_determinant(blocks, c, k, false) > 0.0)) ++bad;
        }
        quality.inverted_corners += bad;
        if (bad > 0) quality.inverted_blocks.push_back(static_cast<std::int64_t>(c.index()));
    }
    return quality;
}

void place_inner_vertices(HexMesh& blocks, const std::vector<char>& free) {
    const EdgeTable edges = edge_table(blocks);
    const auto cells = vertex_cells(blocks);
    std::vector<VertexId> inner;
    for (const VertexId v : blocks.vertices())
        if (free[v.index()]) inner.push_back(v);
    if (inner.empty()) return;

    for (int sweep = 0; sweep < 300; ++sweep) {
        double moved = 0.0;
        for (const VertexId v : inner) {
            Vec3 mean = Vec3::Zero();
            const auto around = edges.vertex_edges[v.index()];
            for (const EdgeId e : around) mean += blocks.position(edges.other(e, v));
            mean /= static_cast<double>(around.size());
            moved = std::max(moved, (mean - blocks.position(v)).norm());
            blocks.set_position(v, mean);
        }
        if (moved < 1e-9 * bounding_box(blocks).diagonal()) break;
    }

    // Where nothing around a vertex has moved since it was looked at in vain, it need not be looked at again.
    std::vector<std::size_t> moved_at(blocks.vertex_count(), 1);
    std::vector<std::size_t> seen_at(blocks.vertex_count(), 0);
    std::size_t now = 1;
    for (int sweep = 0; sweep < 60; ++sweep) {
        bool any = false;
        for (const VertexId v : inner) {
            const auto star = cells[v.index()];
            std::size_t last_move = 0;
            for (const CellId c : star)
                for (const VertexId w : blocks.cell(c)) last_move = std::max(last_move, moved_at[w.index()]);
            if (last_move <= seen_at[v.index()]) continue;
            seen_at[v.index()] = now;
            double worst = worst_corner(blocks, star, v, true, -2.0);
            // Where another corner of the cells is worse, moving v does not help.
            const double others = worst_corner(blocks, star, v, false, worst);
            if (worst > 0.5 || others <= worst) continue;
            double reach = 0.0;
            for (const EdgeId e : edges.vertex_edges[v.index()])
                reach += (blocks.position(edges.other(e, v)) - blocks.position(v)).norm();
            reach /= static_cast<double>(edges.vertex_edges[v.index()].size());
            for (double share = 0.3; share > 0.005; share *= 0.5) {
                const Vec3 here = blocks.position(v);
                Vec3 best = here;
                for (int i = -1; i <= 1; ++i) {
                    for (int j = -1; j <= 1; ++j) {
                        for (int k = -1; k <= 1; ++k) {
                            if (i == 0 && j == 0 && k == 0) continue;
                            const Vec3 trial = here + share * reach * Vec3(i, j, k).normalized();
                            blocks.set_position(v, trial);
                            const double w =
                                std::min(others, worst_corner(blocks, star, v, true, worst + 1e-9));
                            if (w > worst + 1e-9) {
                                worst = w;
                                best = trial;
                                any = true;
                                moved_at[v.index()] = now + 1;
                            }
                        }
                    }
                }
                blocks.set_position(v, best);
            }
            now = std::max(now, moved_at[v.index()]);
        }
        if (!any) break;
    }
}

}  // namespace hex
