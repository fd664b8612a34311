#include "volume/counting_rows.h"

#include <hex/base/components.h>
#include <hex/base/parallel.h>
#include <hex/volume/topology.h>

#include <algorithm>

namespace hex {

CompressedRows<CellId> vertex_cells(const HexMesh& mesh) {
    return rows_by_counting<CellId>(mesh.vertex_count(), [&](const auto& emit) {
        for (const CellId c : mesh.cells()) {
            for (const VertexId v : mesh.cell(c)) emit(v.index(), c);
        }
    });
}

BoundaryQuads boundary_quads(const HexMesh& mesh) {
    BoundaryQuads boundary;
    boundary.quad_of_half_face.resize(mesh.half_face_count());
    boundary.on_boundary.assign(mesh.vertex_count(), 0);
    for (const HalfFaceId h : mesh.half_faces()) {
        if (!mesh.is_boundary(h)) continue;
        boundary.quad_of_half_face[h.index()] = QuadId(boundary.half_faces.size());
        boundary.half_faces.push_back(h);
        boundary.vertices.push_back(mesh.face_vertices(h));
        for (const VertexId v : boundary.vertices.back()) boundary.on_boundary[v.index()] = 1;
    }
    for (const VertexId v : mesh.vertices()) {
        if (boundary.contains(v)) boundary.boundary_vertices.push_back(v);
    }
    boundary.vertex_quads = rows_by_counting<QuadId>(mesh.vertex_count(), [&](const auto& emit) {
        for (std::size_t q = 0; q < boundary.size(); ++q) {
            for (const VertexId v : boundary.vertices[q]) emit(v.index(), QuadId(q));
        }
    });
    return boundary;
}

namespace {

/// Calls `visit(edge)` for the four edges of a half-face.
template <class Visit>
void for_each_edge(const EdgeTable& table, HalfFaceId h, const Visit& visit) {
    const auto& corners = hexahedron::face_corners[static_cast<std::size_t>(HexMesh::local_face(h))];
    for (std::size_t i = 0; i < 4; ++i) {
        const int e = hexahedron::edge_between(corners[i], corners[(i + 1) % 4]);
        visit(table.cell_edges[HexMesh::cell_of(h).index()][static_cast<std::size_t>(e)]);
    }
}

}  // namespace

EdgeTable edge_table(const HexMesh& mesh) {
    // Every cell edge in the bucket of its smaller vertex, with its larger vertex and its place in the cell.
    struct CellEdge {
        std::uint32_t larger;
        std::uint32_t cell;
        std::uint8_t local;
    };
    const auto ends = [&](std::size_t c, std::size_t e) {
        const HexCell& cell = mesh.cell_array()[c];
        const std::uint32_t a = cell[static_cast<std::size_t>(hexahedron::edge_corners[e][0])].value();
        const std::uint32_t b = cell[static_cast<std::size_t>(hexahedron::edge_corners[e][1])].value();
        return std::pair(std::min(a, b), std::max(a, b));
    };
    const std::size_t vertex_count = mesh.vertex_count();
    auto buckets = rows_by_counting<CellEdge>(vertex_count, [&](const auto& emit) {
        for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
            for (std::size_t e = 0; e < 12; ++e) {
                const auto [a, b] = ends(c, e);
                emit(a, CellEdge{b, static_cast<std::uint32_t>(c), static_cast<std::uint8_t>(e)});
            }
        }
    });

    // Within a bucket equal edges come together; cells stay ascending because the sort key ends in the cell.
    std::vector<std::size_t> first_edge(vertex_count + 1, 0);
    parallel_for(vertex_count, [&](std::size_t v) {
        const auto begin = buckets.values.begin() + static_cast<std::ptrdiff_t>(buckets.offsets[v]);
        const auto end = buckets.values.begin() + static_cast<std::ptrdiff_t>(buckets.offsets[v + 1]);
        std::sort(begin, end, [](const CellEdge& x, const CellEdge& y) {
            return x.larger != y.larger ? x.larger < y.larger : x.cell < y.cell;
        });
        std::size_t distinct = 0;
        for (auto it = begin; it != end; ++it) distinct += it == begin || it->larger != (it - 1)->larger;
        first_edge[v + 1] = distinct;
    });
    std::partial_sum(first_edge.begin(), first_edge.end(), first_edge.begin());

    EdgeTable table;
    const std::size_t edge_count = first_edge.back();
    table.vertices.resize(edge_count);
    table.cell_edges.resize(mesh.cell_count());
    table.cells.offsets.assign(edge_count + 1, 0);
    table.cells.values.resize(buckets.values.size());
    parallel_for(vertex_count, [&](std::size_t v) {
        std::size_t edge = first_edge[v];
        for (std::size_t i = buckets.offsets[v]; i < buckets.offsets[v + 1]; ++i) {
            const CellEdge& record = buckets.values[i];
            if (i > buckets.offsets[v] && record.larger != buckets.values[i - 1].larger) ++edge;
            table.vertices[edge] = {VertexId(v), VertexId(record.larger)};
            table.cell_edges[record.cell][record.local] = EdgeId(edge);
            table.cells.values[i] = CellId(record.cell);
            table.cells.offsets[edge + 1] = i + 1;
        }
    });

    table.boundary.assign(edge_count, 0);
    for (const HalfFaceId h : mesh.half_faces()) {
        if (!mesh.is_boundary(h)) continue;
        for_each_edge(table, h, [&](EdgeId e) { table.boundary[e.index()] = 1; });
    }
    table.vertex_edges = rows_by_counting<EdgeId>(vertex_count, [&](const auto& emit) {
        for (std::size_t e = 0; e < edge_count; ++e) {
            for (const VertexId v : table.vertices[e]) emit(v.index(), EdgeId(e));
        }
    });
    return table;
}

EdgeId EdgeTable::find(VertexId a, VertexId b) const {
    for (const EdgeId e : vertex_edges[a.index()]) {
        if (other(e, a) == b) return e;
    }
    return {};
}

namespace {

/// The cells of a vertex hang together through faces that contain it.
bool star_is_connected(const HexMesh& mesh, VertexId v, std::span<const CellId> star) {
    std::vector<CellId> reached = {star[0]};
    for (std::size_t i = 0; i < reached.size(); ++i) {
        for (int f = 0; f < 6; ++f) {
            const CellId next = mesh.neighbour(reached[i], f);
            if (!next.valid() || std::find(reached.begin(), reached.end(), next) != reached.end()) continue;
            const auto corners = mesh.face_vertices(HexMesh::half_face(reached[i], f));
            if (std::find(corners.begin(), corners.end(), v) != corners.end()) reached.push_back(next);
        }
    }
    return reached.size() == star.size();
}

void add(Diagnostics& diagnostics, const char* code, const char* message, const char* entity,
         std::vector<std::int64_t> ids) {
    if (ids.empty()) return;
    diagnostics.push_back(
        {Severity::warning, code, std::string(message) + ": " + list_ids(ids), entity, std::move(ids)});
}

}  // namespace

Diagnostics inspect(const HexMesh& mesh) {
    Diagnostics diagnostics;
    const auto stars = vertex_cells(mesh);
    std::vector<std::int64_t> unused, pinched, crowded;
    for (const VertexId v : mesh.vertices()) {
        const auto star = stars[v.index()];
        if (star.empty())
            unused.push_back(v.value());
        else if (!star_is_connected(mesh, v, star))
            pinched.push_back(v.value());
    }
    const EdgeTable edges = edge_table(mesh);
    std::vector<int> quads(edges.size(), 0);
    for (const HalfFaceId h : mesh.half_faces()) {
        if (!mesh.is_boundary(h)) continue;
        for_each_edge(edges, h, [&](EdgeId e) { ++quads[e.index()]; });
    }
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (quads[e] > 2) crowded.push_back(static_cast<std::int64_t>(e));
    }
    Components components(mesh.cell_count());
    for (const HalfFaceId h : mesh.half_faces()) {
        if (!mesh.is_boundary(h))
            components.join(HexMesh::cell_of(h).index(), HexMesh::cell_of(mesh.twin(h)).index());
    }
    std::size_t component_count = 0;
    for (const CellId c : mesh.cells()) component_count += components.is_root(c.index());

    add(diagnostics, "unused-vertices", "vertices that no hexahedron uses", "vertex", std::move(unused));
    add(diagnostics, "non-manifold-vertices", "vertices where hexahedra only touch", "vertex",
        std::move(pinched));
    add(diagnostics, "non-manifold-edges", "boundary edges with more than two boundary quads", "edge",
        std::move(crowded));
    if (component_count > 1)
        diagnostics.push_back({Severity::note,
                               "components",
                               "the mesh has " + std::to_string(component_count) + " components",
                               "cell",
                               {}});
    return diagnostics;
}

}  // namespace hex
