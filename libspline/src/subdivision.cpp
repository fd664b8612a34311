#include "spline_rows.h"

#include <hex/base/parallel.h>
#include <spline/subdivision.h>

#include <algorithm>

namespace spline {

using hex::CellId;
using hex::EdgeId;
using hex::HalfFaceId;
using hex::HexMesh;
using hex::VertexFeature;
using hex::VertexId;
namespace hexahedron = hex::hexahedron;

namespace {

constexpr std::uint32_t none = VertexId::none_value;

/// Index of each fine vertex by what it is the point of.
struct Numbering {
    explicit Numbering(const LevelMesh& coarse)
        : body(coarse.mesh.cell_count(), none),
          face(coarse.faces.size(), none),
          edge(coarse.edges.size(), none),
          vertex(coarse.mesh.vertex_count(), none) {}

    void add(FineVertex::Kind kind, std::size_t index) {
        std::uint32_t& entry = of(kind)[index];
        if (entry != none) return;
        entry = static_cast<std::uint32_t>(origin.size());
        origin.push_back({kind, static_cast<std::uint32_t>(index)});
    }
    std::vector<std::uint32_t>& of(FineVertex::Kind kind) {
        switch (kind) {
            case FineVertex::Kind::body:
                return body;
            case FineVertex::Kind::face:
                return face;
            case FineVertex::Kind::edge:
                return edge;
            case FineVertex::Kind::vertex:
                break;
        }
        return vertex;
    }

    std::vector<std::uint32_t> body, face, edge, vertex;
    std::vector<FineVertex> origin;
};

/// Edges in the order of their first appearance (cell, then local edge).
std::vector<EdgeId> edges_by_appearance(const LevelMesh& coarse) {
    std::vector<char> seen(coarse.edges.size(), 0);
    std::vector<EdgeId> order;
    order.reserve(seen.size());
    for (const auto& cell : coarse.edges.cell_edges) {
        for (const EdgeId e : cell) {
            if (seen[e.index()] != 0) continue;
            seen[e.index()] = 1;
            order.push_back(e);
        }
    }
    return order;
}

Numbering number_all(const LevelMesh& coarse) {
    Numbering numbering(coarse);
    numbering.origin.reserve(coarse.mesh.vertex_count() + coarse.edges.size() + coarse.faces.size() +
                             coarse.mesh.cell_count());
    for (std::size_t v = 0; v < coarse.mesh.vertex_count(); ++v) numbering.add(FineVertex::Kind::vertex, v);
    for (const EdgeId e : edges_by_appearance(coarse)) numbering.add(FineVertex::Kind::edge, e.index());
    for (std::size_t f = 0; f < coarse.faces.size(); ++f) numbering.add(FineVertex::Kind::face, f);
    for (std::size_t c = 0; c < coarse.mesh.cell_count(); ++c) numbering.add(FineVertex::Kind::body, c);
    return numbering;
}

/// Faces and edges around a vertex in the order of their first appearance in the mesh.
class VertexSurroundings {
  public:
    explicit VertexSurroundings(const LevelMesh& coarse) : coarse_(coarse), rank_(coarse.edges.size()) {
        const auto order = edges_by_appearance(coarse);
        for (std::size_t i = 0; i < order.size(); ++i) rank_[order[i].index()] = i;
    }

    std::vector<std::uint32_t> faces(VertexId v) const {
        std::vector<std::uint32_t> found;
        for (const CellId c : coarse_.stars[v.index()]) {
            const auto& corners = coarse_.mesh.cell(c);
            const auto corner =
                static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
            for (const int f : hexahedron::corner_faces[corner])
                found.push_back(coarse_.faces.of_half_face[HexMesh::half_face(c, f).index()]);
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    std::vector<EdgeId> edges(VertexId v) const {
        const auto around = coarse_.edges.vertex_edges[v.index()];
        std::vector<EdgeId> found(around.begin(), around.end());
        std::sort(found.begin(), found.end(),
                  [&](EdgeId a, EdgeId b) { return rank_[a.index()] < rank_[b.index()]; });
        return found;
    }

  private:
    const LevelMesh& coarse_;
    std::vector<std::size_t> rank_;
};

Numbering number_some(const LevelMesh& coarse, std::span<const CellId> parents) {
    Numbering numbering(coarse);
    const VertexSurroundings around(coarse);
    for (const CellId e : parents) {
        const hex::HexCell& corners = coarse.mesh.cell(e);
        numbering.add(FineVertex::Kind::body, e.index());
        for (const VertexId v : corners) {
            for (const CellId c : coarse.stars[v.index()]) numbering.add(FineVertex::Kind::body, c.index());
        }
        for (const VertexId v : corners) {
            for (const std::uint32_t f : around.faces(v)) numbering.add(FineVertex::Kind::face, f);
        }
        for (const VertexId v : corners) {
            for (const EdgeId edge : around.edges(v)) numbering.add(FineVertex::Kind::edge, edge.index());
        }
        for (const VertexId v : corners) numbering.add(FineVertex::Kind::vertex, v.index());
    }
    return numbering;
}

/// One row of C as numerators; returns the denominator.
class Stencils {
  public:
    explicit Stencils(const LevelMesh& coarse) : coarse_(coarse) {}

    std::int64_t row(FineVertex fine, RationalRowSum& row) const {
        row.clear();
        switch (fine.kind) {
            case FineVertex::Kind::body:
                add_cell(CellId(fine.index), 1, row);
                return 8;
            case FineVertex::Kind::face:
                return face_row(fine.index, row);
            case FineVertex::Kind::edge:
                return edge_row(EdgeId(fine.index), row);
            case FineVertex::Kind::vertex:
                break;
        }
        return vertex_row(VertexId(fine.index), row);
    }

  private:
    void add_cell(CellId c, std::int64_t numerator, RationalRowSum& row) const {
        for (const VertexId v : coarse_.mesh.cell(c)) row.add(v.value(), numerator);
    }
    void add_face(HalfFaceId h, std::int64_t numerator, RationalRowSum& row) const {
        for (const VertexId v : coarse_.mesh.face_vertices(h)) row.add(v.value(), numerator);
    }
    void add_edge(EdgeId e, std::int64_t numerator, RationalRowSum& row) const {
        for (const VertexId v : coarse_.edges.vertices[e.index()]) row.add(v.value(), numerator);
    }

    std::int64_t face_row(std::size_t face, RationalRowSum& row) const {
        const HalfFaceId h = coarse_.faces.half_faces[face];
        const HalfFaceId twin = coarse_.mesh.twin(h);
        if (!twin.valid()) {
            add_face(h, 1, row);
            return 4;
        }
        add_cell(HexMesh::cell_of(h), 1, row);
        add_cell(HexMesh::cell_of(twin), 1, row);
        add_face(h, 4, row);
        return 32;
    }

    std::int64_t edge_row(EdgeId e, RationalRowSum& row) const {
        const bool boundary = coarse_.edges.boundary[e.index()] != 0;
        if (coarse_.features.sharp_edge[e.index()] != 0 || coarse_.open_edge[e.index()] != 0) {
            add_edge(e, 1, row);
            return 2;
        }
        if (boundary) {
            // (mean of k quads + midpoint) / 2 over 16 k / 2.
            const auto [a, b] = coarse_.edges.vertices[e.index()];
            std::int64_t quads = 0;
            for (const hex::QuadId q : coarse_.boundary.vertex_quads[a.index()]) {
                const auto& quad = coarse_.boundary.vertices[q.index()];
                const auto at =
                    static_cast<std::size_t>(std::find(quad.begin(), quad.end(), a) - quad.begin());
                if (quad[(at + 1) % 4] != b && quad[(at + 3) % 4] != b) continue;
                add_face(coarse_.boundary.half_faces[q.index()], 1, row);
                ++quads;
            }
            add_edge(e, 2 * quads, row);
            return 8 * quads;
        }
        const auto cells = coarse_.edges.cells[e.index()];
        const auto n = static_cast<std::int64_t>(cells.size());
        for (const CellId c : cells) {
            add_cell(c, 1, row);
            // Each of the n faces at the edge is seen from its two cells.
            for (const HalfFaceId h : half_faces_at(c, e)) add_face(h, 2, row);
        }
        add_edge(e, 4 * n * (n - 3), row);
        return 8 * n * n;
    }

    std::array<HalfFaceId, 2> half_faces_at(CellId c, EdgeId e) const {
        const auto& edges = coarse_.edges.cell_edges[c.index()];
        const auto local = static_cast<std::size_t>(std::find(edges.begin(), edges.end(), e) - edges.begin());
        const auto& faces = hexahedron::edge_faces[local];
        return {HexMesh::half_face(c, faces[0]), HexMesh::half_face(c, faces[1])};
    }

    std::int64_t vertex_row(VertexId v, RationalRowSum& row) const {
        const std::uint32_t self = v.value();
        if (coarse_.open_vertex[v.index()] != 0) {
            row.add(self, 1);
            return 1;
        }
        const auto edges = coarse_.edges.vertex_edges[v.index()];
        switch (coarse_.features.vertex[v.index()]) {
            case VertexFeature::corner:
                row.add(self, 1);
                return 1;
            case VertexFeature::crease:
                row.add(self, 6);
                for (const EdgeId e : edges) {
                    if (coarse_.features.sharp_edge[e.index()] != 0)
                        row.add(coarse_.edges.other(e, v).value(), 1);
                }
                return 8;
            case VertexFeature::smooth: {
                const auto quads = coarse_.boundary.vertex_quads[v.index()];
                const auto n = static_cast<std::int64_t>(quads.size());
                std::int64_t boundary_edges = 0;
                for (const EdgeId e : edges) {
                    if (coarse_.edges.boundary[e.index()] == 0) continue;
                    add_edge(e, 4 * n, row);
                    ++boundary_edges;
                }
                for (const hex::QuadId q : quads)
                    add_face(coarse_.boundary.half_faces[q.index()], boundary_edges, row);
                row.add(self, 4 * n * boundary_edges * (n - 3));
                return 4 * n * n * boundary_edges;
            }
            case VertexFeature::interior:
                break;
        }
        const auto cells = coarse_.stars[v.index()];
        const auto cell_count = static_cast<std::int64_t>(cells.size());
        const auto edge_count = static_cast<std::int64_t>(edges.size());
        // Three faces a cell, each seen from both sides.
        const std::int64_t face_count = 3 * cell_count / 2;
        for (const CellId c : cells) {
            add_cell(c, face_count * edge_count, row);
            const auto& corners = coarse_.mesh.cell(c);
            const auto corner =
                static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
            for (const int f : hexahedron::corner_faces[corner])
                add_face(HexMesh::half_face(c, f), 3 * cell_count * edge_count, row);
        }
        for (const EdgeId e : edges) add_edge(e, 12 * face_count * cell_count, row);
        row.add(self, 8 * cell_count * face_count * edge_count);
        return 64 * cell_count * face_count * edge_count;
    }

    const LevelMesh& coarse_;
};

/// The child of cell e at its corner.
hex::HexCell child_cell(const LevelMesh& coarse, const Numbering& numbering, CellId e, std::size_t corner) {
    const auto& uvw = hexahedron::corner_uvw[corner];
    hex::HexCell child;
    for (std::size_t c = 0; c < 8; ++c) {
        // In how many axes this corner of the child is in the middle of the parent, and which.
        std::array<bool, 3> middle{};
        int count = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            middle[a] = hexahedron::corner_uvw[c][a] != uvw[a];
            count += middle[a];
        }
        std::uint32_t vertex = numbering.body[e.index()];
        if (count == 0) {
            vertex = numbering.vertex[coarse.mesh.cell(e)[corner].index()];
        } else if (count == 1) {
            const int edge = hexahedron::edge_between(static_cast<int>(corner), static_cast<int>(c));
            vertex =
                numbering.edge[coarse.edges.cell_edges[e.index()][static_cast<std::size_t>(edge)].index()];
        } else if (count == 2) {
            const std::size_t axis = !middle[0] ? 0 : !middle[1] ? 1 : 2;
            constexpr std::array<std::array<int, 2>, 3> faces = {{{4, 2}, {1, 3}, {0, 5}}};
            const int face = faces[axis][static_cast<std::size_t>(uvw[axis])];
            vertex = numbering.face[coarse.faces.of_half_face[HexMesh::half_face(e, face).index()]];
        }
        child[c] = VertexId(vertex);
    }
    return child;
}

/// Boundary quads of the finer mesh: those that are a quarter of a boundary quad.
hex::BoundaryQuads inherit_boundary(const LevelMesh& coarse, const HexMesh& fine,
                                    std::span<const CellId> parents) {
    std::vector<char> on_solid_boundary(fine.half_face_count(), 0);
    for (std::size_t p = 0; p < parents.size(); ++p) {
        for (int f = 0; f < 6; ++f) {
            const HalfFaceId h = HexMesh::half_face(parents[p], f);
            if (!coarse.boundary.quad_of_half_face[h.index()].valid()) continue;
            for (const int corner : hexahedron::face_corners[static_cast<std::size_t>(f)]) {
                const CellId child(8 * p + static_cast<std::size_t>(corner));
                on_solid_boundary[HexMesh::half_face(child, f).index()] = 1;
            }
        }
    }
    hex::BoundaryQuads boundary;
    boundary.quad_of_half_face.resize(fine.half_face_count());
    boundary.on_boundary.assign(fine.vertex_count(), 0);
    for (const HalfFaceId h : fine.half_faces()) {
        if (on_solid_boundary[h.index()] == 0) continue;
        boundary.quad_of_half_face[h.index()] = hex::QuadId(boundary.half_faces.size());
        boundary.half_faces.push_back(h);
        boundary.vertices.push_back(fine.face_vertices(h));
        for (const VertexId v : boundary.vertices.back()) boundary.on_boundary[v.index()] = 1;
    }
    for (const VertexId v : fine.vertices()) {
        if (boundary.contains(v)) boundary.boundary_vertices.push_back(v);
    }
    std::vector<std::size_t> next(fine.vertex_count() + 1, 0);
    for (const auto& quad : boundary.vertices) {
        for (const VertexId v : quad) ++next[v.index() + 1];
    }
    for (std::size_t v = 0; v < fine.vertex_count(); ++v) next[v + 1] += next[v];
    boundary.vertex_quads.offsets = next;
    boundary.vertex_quads.values.resize(next.back());
    for (std::size_t q = 0; q < boundary.vertices.size(); ++q) {
        for (const VertexId v : boundary.vertices[q])
            boundary.vertex_quads.values[next[v.index()]++] = hex::QuadId(q);
    }
    return boundary;
}

/// Marks edges of boundary quads, and what is open: incident to a face without neighbour that is no boundary.
void mark_ends(LevelMesh& level) {
    level.edges.boundary.assign(level.edges.size(), 0);
    level.open_edge.assign(level.edges.size(), 0);
    level.open_vertex.assign(level.mesh.vertex_count(), 0);
    for (const HalfFaceId h : level.mesh.half_faces()) {
        if (!level.mesh.is_boundary(h)) continue;
        const bool solid_boundary = level.boundary.quad_of_half_face[h.index()].valid();
        const auto& corners = hexahedron::face_corners[static_cast<std::size_t>(HexMesh::local_face(h))];
        const CellId c = HexMesh::cell_of(h);
        for (std::size_t i = 0; i < 4; ++i) {
            const auto local =
                static_cast<std::size_t>(hexahedron::edge_between(corners[i], corners[(i + 1) % 4]));
            const EdgeId e = level.edges.cell_edges[c.index()][local];
            if (solid_boundary) {
                level.edges.boundary[e.index()] = 1;
            } else {
                level.open_edge[e.index()] = 1;
                level.open_vertex[level.mesh.corner(c, corners[i]).index()] = 1;
            }
        }
    }
}

hex::FeatureSet inherit_features(const LevelMesh& coarse, const LevelMesh& fine, const Numbering& numbering) {
    hex::FeatureSet features;
    features.sharp_edge.assign(fine.edges.size(), 0);
    features.vertex.assign(fine.mesh.vertex_count(), VertexFeature::interior);
    for (std::size_t v = 0; v < numbering.origin.size(); ++v) {
        const FineVertex origin = numbering.origin[v];
        VertexFeature& feature = features.vertex[v];
        if (origin.kind == FineVertex::Kind::vertex) {
            feature = coarse.features.vertex[origin.index];
        } else if (origin.kind == FineVertex::Kind::edge) {
            if (coarse.features.sharp_edge[origin.index] != 0)
                feature = VertexFeature::crease;
            else if (coarse.edges.boundary[origin.index] != 0)
                feature = VertexFeature::smooth;
        } else if (origin.kind == FineVertex::Kind::face) {
            if (coarse.boundary.quad_of_half_face[coarse.faces.half_faces[origin.index].index()].valid())
                feature = VertexFeature::smooth;
        }
    }
    for (std::size_t e = 0; e < coarse.edges.size(); ++e) {
        if (coarse.features.sharp_edge[e] == 0 || numbering.edge[e] == none) continue;
        for (const VertexId end : coarse.edges.vertices[e]) {
            const std::uint32_t vertex = numbering.vertex[end.index()];
            if (vertex == none) continue;
            const EdgeId half = fine.edges.find(VertexId(numbering.edge[e]), VertexId(vertex));
            if (half.valid()) features.sharp_edge[half.index()] = 1;
        }
    }
    return features;
}

Subdivision subdivide_numbered(const LevelMesh& coarse, Numbering numbering,
                               std::span<const CellId> parents) {
    Subdivision result;
    const Stencils stencils(coarse);
    result.coefficients = build_rows(numbering.origin.size(), [&](std::size_t v, RationalRowSum& row) {
        return stencils.row(numbering.origin[v], row);
    });
    std::vector<hex::Vec3> positions(numbering.origin.size());
    hex::parallel_for(positions.size(), [&](std::size_t v) {
        positions[v] = combine(result.coefficients[v], coarse.mesh.positions());
    });
    std::vector<hex::HexCell> cells(8 * parents.size());
    hex::parallel_for(cells.size(), [&](std::size_t c) {
        cells[c] = child_cell(coarse, numbering, parents[c / 8], c % 8);
    });
    std::vector<int> parts;
    if (!coarse.mesh.parts().empty()) {
        parts.reserve(cells.size());
        for (const CellId p : parents) parts.insert(parts.end(), 8, coarse.mesh.part(p));
    }

    LevelMesh& fine = result.fine;
    fine.mesh = HexMesh(std::move(positions), std::move(cells), std::move(parts));
    fine.edges = hex::edge_table(fine.mesh);
    fine.faces = face_table(fine.mesh);
    fine.stars = hex::vertex_cells(fine.mesh);
    fine.boundary = inherit_boundary(coarse, fine.mesh, parents);
    fine.patch_of_quad.reserve(fine.boundary.size());
    for (const HalfFaceId h : fine.boundary.half_faces) {
        const HalfFaceId parent =
            HexMesh::half_face(parents[HexMesh::cell_of(h).index() / 8], HexMesh::local_face(h));
        fine.patch_of_quad.push_back(
            coarse.patch_of_quad[coarse.boundary.quad_of_half_face[parent.index()].index()]);
    }
    mark_ends(fine);
    fine.features = inherit_features(coarse, fine, numbering);
    result.origin = std::move(numbering.origin);
    return result;
}

}  // namespace

Subdivision subdivide(const LevelMesh& coarse) {
    std::vector<CellId> all(coarse.mesh.cell_count());
    for (std::size_t c = 0; c < all.size(); ++c) all[c] = CellId(c);
    return subdivide_numbered(coarse, number_all(coarse), all);
}

Subdivision subdivide(const LevelMesh& coarse, std::span<const CellId> refined,
                      std::span<const CellId> buffer) {
    std::vector<CellId> parents(refined.begin(), refined.end());
    parents.insert(parents.end(), buffer.begin(), buffer.end());
    return subdivide_numbered(coarse, number_some(coarse, parents), parents);
}

}  // namespace spline
