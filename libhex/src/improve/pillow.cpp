/// Pillowing: a layer of new hexahedra all around, guarded (paper, section on quality improvement).

#include "improve/ascent.h"
#include "improve/shrink_set.h"

#include <hex/base/parallel.h>

#include <algorithm>

namespace hex {
namespace {

using improving::StarQuality;
using improving::Sweeper;
using improving::Workspace;

/// Thickness of a layer as a share of the shortest boundary edge at a vertex.
constexpr double thickness_share = 0.2;
/// A layer is thinned to no less than 2^-10 of its thickness.
constexpr int most_halvings = 10;

/// Where boundary vertices go when a layer is put around them.
struct Inset {
    std::vector<VertexId> vertices;  ///< the boundary vertices, ascending
    std::vector<Vec3> outer;         ///< their old places, where the new vertices go
    std::vector<Vec3> offset;        ///< to where they go at full thickness
};

/// The direction whose smallest dot product with the given unit normals is (almost) the largest: the axis of
/// the narrowest cone around them, by the steps of Badoiu and Clarkson towards the farthest one.
Vec3 axis_of_cone(const std::vector<Vec3>& normals, Vec3 axis) {
    for (int i = 1; i <= 100; ++i) {
        const auto worst =
            std::min_element(normals.begin(), normals.end(),
                             [&](const Vec3& a, const Vec3& b) { return a.dot(axis) < b.dot(axis); });
        axis = (axis + (*worst - axis) / (i + 1)).normalized();
    }
    return axis;
}

/// Mean of the unit outward normals of the boundary quads at their corner v, not of unit length (REFERENCE:
/// paper, pillow); where that mean does not see all the quads from outside, the axis of their cone.
Vec3 outward(const HexMesh& mesh, const BoundaryQuads& boundary, VertexId v) {
    std::vector<Vec3> normals;
    Vec3 sum = Vec3::Zero();
    for (const QuadId q : boundary.vertex_quads[v.index()]) {
        const auto& quad = boundary.vertices[q.index()];
        const auto i = static_cast<std::size_t>(std::find(quad.begin(), quad.end(), v) - quad.begin());
        const Vec3& here = mesh.position(v);
        const Vec3 normal =
            (mesh.position(quad[(i + 1) % 4]) - here).cross(mesh.position(quad[(i + 3) % 4]) - here);
        const double length = normal.norm();
        if (!(length > 0.0)) continue;
        normals.push_back(normal / length);
        sum += normals.back();
    }
    if (normals.empty()) return Vec3::Zero();
    const Vec3 mean = sum / static_cast<double>(normals.size());
    const bool sees_all = std::all_of(normals.begin(), normals.end(),
                                      [&](const Vec3& n) { return n.dot(mean) > 0.1 * mean.norm(); });
    return sees_all ? mean : axis_of_cone(normals, normals.front());
}

Inset make_inset(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary) {
    Inset inset;
    inset.vertices = boundary.boundary_vertices;
    inset.outer.resize(inset.vertices.size());
    inset.offset.resize(inset.vertices.size());
    parallel_for(inset.vertices.size(), [&](std::size_t i) {
        const VertexId v = inset.vertices[i];
        inset.outer[i] = mesh.position(v);
        double shortest = std::numeric_limits<double>::infinity();
        for (const EdgeId e : edges.vertex_edges[v.index()]) {
            const VertexId other = edges.other(e, v);
            if (!boundary.contains(other)) continue;
            const bool on_face =
                std::any_of(boundary.vertex_quads[v.index()].begin(), boundary.vertex_quads[v.index()].end(),
                            [&](QuadId q) {
                                const auto& quad = boundary.vertices[q.index()];
                                return std::find(quad.begin(), quad.end(), other) != quad.end();
                            });
            if (on_face) shortest = std::min(shortest, (mesh.position(other) - mesh.position(v)).norm());
        }
        inset.offset[i] = -thickness_share * shortest * outward(mesh, boundary, v);
    });
    return inset;
}

/// The mesh with one hexahedron on each face around the flagged cells: its bottom the old quad, its top the
/// new vertices, which the other cells have from now on.
HexMesh with_layer(const HexMesh& mesh, const std::vector<char>& flagged, const BoundaryQuads& boundary,
                   const Inset& inset) {
    std::vector<Vec3> positions(mesh.positions().begin(), mesh.positions().end());
    std::vector<VertexId> new_vertex(mesh.vertex_count());
    for (std::size_t i = 0; i < inset.vertices.size(); ++i) {
        new_vertex[inset.vertices[i].index()] = VertexId(positions.size());
        positions.push_back(inset.outer[i]);
    }
    std::vector<HexCell> cells(mesh.cell_array().begin(), mesh.cell_array().end());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (flagged[c]) continue;
        for (VertexId& v : cells[c])
            if (new_vertex[v.index()].valid()) v = new_vertex[v.index()];
    }
    std::vector<int> parts(mesh.parts().begin(), mesh.parts().end());
    for (std::size_t q = 0; q < boundary.size(); ++q) {
        const auto& quad = boundary.vertices[q];
        HexCell cell;
        for (std::size_t i = 0; i < 4; ++i) {
            cell[i] = quad[i];
            cell[i + 4] = new_vertex[quad[i].index()];
        }
        cells.push_back(cell);
        if (!parts.empty()) parts.push_back(mesh.part(HexMesh::cell_of(boundary.half_faces[q])));
    }
    return {std::move(positions), std::move(cells), std::move(parts)};
}

/// Thins the layer around every cell that is inverted and was not before (new cells were not), halving the
/// offsets of its vertices until none is left or the layer is as thin as it may get.
std::vector<double> thin_until_valid(HexMesh& mesh, const Inset& inset, const std::vector<double>& before,
                                     const Context& context) {
    std::vector<double> share(inset.vertices.size(), 1.0);
    std::vector<std::int64_t> place(mesh.vertex_count(), -1);
    for (std::size_t i = 0; i < inset.vertices.size(); ++i)
        place[inset.vertices[i].index()] = static_cast<std::int64_t>(i);
    for (int round = 0;; ++round) {
        for (std::size_t i = 0; i < share.size(); ++i)
            mesh.set_position(inset.vertices[i], inset.outer[i] + share[i] * inset.offset[i]);
        const std::vector<double> values = scaled_jacobians(mesh, context);
        std::vector<char> halve(share.size(), 0);
        for (const CellId c : mesh.cells()) {
            const bool was_inverted = c.index() < before.size() && before[c.index()] <= 0.0;
            if (values[c.index()] > 0.0 || was_inverted) continue;
            for (const VertexId v : mesh.cell(c))
                if (place[v.index()] >= 0) halve[static_cast<std::size_t>(place[v.index()])] = 1;
        }
        if (round == most_halvings || std::count(halve.begin(), halve.end(), char{1}) == 0) return share;
        for (std::size_t i = 0; i < share.size(); ++i)
            if (halve[i]) share[i] /= 2.0;
    }
}

class PillowImprover : public Improver {
  public:
    ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                          const Context& context) const override {
        ImproveResult result{mesh, {}};
        const int layers = options.count < 0 ? 1 : options.count;
        require_bearable(mesh, layers);
        for (int layer = 0; layer < layers; ++layer) {
            context.check_cancelled();
            std::vector<char> flagged(result.mesh.cell_count(), 1);
            if (options.local_layer) {
                flagged = improving::cells_with_flat_edges(result.mesh, options.feature_cosine);
                if (std::count(flagged.begin(), flagged.end(), char{1}) == 0) break;
                improving::grow_to_manifold(result.mesh, flagged);
            }
            result.mesh = add_layer(result.mesh, flagged, result.report, context);
            result.report.history.back().sweep = layer + 1;
            context.progress("pillow", static_cast<double>(layer + 1) / layers);
        }
        return result;
    }

  private:
    /// Refuses numbers of layers whose cells nothing can hold, before the first of them is made.
    static void require_bearable(const HexMesh& mesh, int layers) {
        constexpr double most_cells = 5e8;
        const double cells = static_cast<double>(mesh.cell_count()) +
                             static_cast<double>(layers) * static_cast<double>(boundary_quads(mesh).size());
        if (layers > 1 && cells > most_cells)
            throw Error(ErrorKind::unsupported,
                        std::to_string(layers) + " layers make more than 500 million hexahedra", {},
                        "ask for fewer layers");
    }

    static HexMesh add_layer(const HexMesh& mesh, const std::vector<char>& flagged, ImproveReport& report,
                             const Context& context) {
        const EdgeTable edges = edge_table(mesh);
        const BoundaryQuads boundary = improving::faces_around(mesh, flagged);
        const std::vector<double> before = scaled_jacobians(mesh, context);
        const Inset inset = make_inset(mesh, edges, boundary);
        HexMesh layered = with_layer(mesh, flagged, boundary, inset);
        const std::vector<double> share = thin_until_valid(layered, inset, before, context);

        std::vector<char> inner(layered.vertex_count(), 0);
        for (const VertexId v : inset.vertices) inner[v.index()] = 1;
        Sweeper sweeper(layered, inner, context);
        fit_thickness(sweeper, mesh, inset, before, share);
        rescue(sweeper, before);

        ImproveRecord record = improving::record_of(sweeper.values());
        record.moved = inset.vertices.size();
        report.history.push_back(record);
        report_inverted(sweeper.values(), before, report);
        return sweeper.finish().mesh;
    }

    /// Where the layer made the worst cell around a vertex worse than it was, a thinner or thicker one is
    /// taken as long as that helps.
    static void fit_thickness(Sweeper& sweeper, const HexMesh& old, const Inset& inset,
                              const std::vector<double>& before, std::vector<double> share) {
        const CompressedRows<CellId> old_cells = vertex_cells(old);
        std::vector<std::uint32_t> place(sweeper.mesh().vertex_count(), 0);
        for (std::size_t i = 0; i < inset.vertices.size(); ++i)
            place[inset.vertices[i].index()] = static_cast<std::uint32_t>(i);
        const auto visit = [&](VertexId v, Workspace& workspace) {
            double old_minimum = 1.0;
            for (const CellId c : old_cells[v.index()])
                old_minimum = std::min(old_minimum, before[c.index()]);
            if (sweeper.star_minimum(v) >= old_minimum) return false;
            const std::size_t i = place[v.index()];
            const improving::Star& star = sweeper.gather(v, workspace);
            const double present = share[i];
            StarQuality best = star.quality(sweeper.mesh().position(v));
            for (const double candidate : {0.5 * present, std::min(1.0, 2.0 * present)}) {
                if (candidate < std::ldexp(1.0, -most_halvings)) continue;
                const StarQuality quality = star.quality(inset.outer[i] + candidate * inset.offset[i]);
                if (!quality.better_than(best)) continue;
                best = quality;
                share[i] = candidate;
            }
            if (share[i] == present) return false;
            sweeper.move(v, inset.outer[i] + share[i] * inset.offset[i], star);
            return true;
        };
        for (int pass = 0; pass < most_halvings && sweeper.sweep(visit) > 0; ++pass) {
        }
    }

    /// Cells that are still inverted and were not: their inner vertices are moved freely.
    static void rescue(Sweeper& sweeper, const std::vector<double>& before) {
        const auto visit = [&](VertexId v, Workspace& workspace) {
            return sweeper.star_minimum(v) <= 0.0 &&
                   improving::raise_star_minimum(sweeper, v, 0.01, workspace);
        };
        for (int pass = 0; pass < 20 && !newly_inverted(sweeper.values(), before).empty(); ++pass)
            if (sweeper.sweep(visit) == 0) break;
    }

    static std::vector<std::int64_t> newly_inverted(std::span<const double> values,
                                                    const std::vector<double>& before) {
        std::vector<std::int64_t> cells;
        for (std::size_t c = 0; c < values.size(); ++c) {
            const bool was_inverted = c < before.size() && before[c] <= 0.0;
            if (values[c] <= 0.0 && !was_inverted) cells.push_back(static_cast<std::int64_t>(c));
        }
        return cells;
    }

    static void report_inverted(std::span<const double> values, const std::vector<double>& before,
                                ImproveReport& report) {
        std::vector<std::int64_t> cells = newly_inverted(values, before);
        if (cells.empty()) return;
        report.diagnostics.push_back(
            {Severity::warning, "pillow-inverted",
             "the boundary is folded at " + std::to_string(cells.size()) +
                 " elements of the layer; no thickness keeps them positive: " + list_ids(cells),
             "cell", std::move(cells)});
    }
};

const Register<Improver, PillowImprover> registered(
    improvers(), "pillow", "a layer of new hexahedra all around, as thin as it must be to invert nothing");

}  // namespace
}  // namespace hex
