#include "improve/shrink_set.h"

#include "volume/counting_rows.h"

#include <algorithm>

namespace hex::improving {
namespace {

Vec3 unit_normal(const HexMesh& mesh, HalfFaceId h) {
    const auto quad = mesh.face_vertices(h);
    return (mesh.position(quad[2]) - mesh.position(quad[0]))
        .cross(mesh.position(quad[3]) - mesh.position(quad[1]))
        .normalized();
}

bool is_flagged(const HexMesh& mesh, const std::vector<char>& flagged, CellId cell, int face) {
    const CellId next = mesh.neighbour(cell, face);
    return next.valid() && flagged[next.index()] != 0;
}

/// Whether the faces of the flagged cells at v are one fan around it, or none.
bool is_one_fan(const HexMesh& mesh, const std::vector<char>& flagged, VertexId v,
                std::span<const CellId> cells) {
    // The two neighbours of v in each face.
    std::vector<std::array<VertexId, 2>> fan;
    for (const CellId c : cells) {
        if (!flagged[c.index()]) continue;
        for (int f = 0; f < hexahedron::face_count; ++f) {
            if (is_flagged(mesh, flagged, c, f)) continue;
            const auto quad = mesh.face_vertices(HexMesh::half_face(c, f));
            const auto i = static_cast<std::size_t>(std::find(quad.begin(), quad.end(), v) - quad.begin());
            if (i < 4) fan.push_back({quad[(i + 1) % 4], quad[(i + 3) % 4]});
        }
    }
    if (fan.empty()) return true;
    // Each face continues where the one before ends; a pinch closes the round too early, or leaves a choice.
    const VertexId start = fan[0][0];
    VertexId end = fan[0][1];
    std::size_t passed = 1;
    while (end != start) {
        const auto next = [&](const auto& face) { return face[0] == end; };
        if (std::count_if(fan.begin(), fan.end(), next) != 1) return false;
        end = (*std::find_if(fan.begin(), fan.end(), next))[1];
        if (++passed > fan.size()) return false;
    }
    return passed == fan.size();
}

}  // namespace

std::vector<char> cells_with_flat_edges(const HexMesh& mesh, double cosine) {
    std::vector<char> flagged(mesh.cell_count(), 0);
    for (const CellId c : mesh.cells()) {
        for (const auto& faces : hexahedron::edge_faces) {
            const HalfFaceId a = HexMesh::half_face(c, faces[0]);
            const HalfFaceId b = HexMesh::half_face(c, faces[1]);
            if (mesh.is_boundary(a) && mesh.is_boundary(b) &&
                unit_normal(mesh, a).dot(unit_normal(mesh, b)) >= cosine)
                flagged[c.index()] = 1;
        }
    }
    return flagged;
}

void grow_to_manifold(const HexMesh& mesh, std::vector<char>& flagged) {
    const CompressedRows<CellId> cells = vertex_cells(mesh);
    std::vector<VertexId> waiting;
    const auto wait_at = [&](CellId c) {
        const auto& corners = mesh.cell(c);
        waiting.insert(waiting.end(), corners.begin(), corners.end());
    };
    for (const CellId c : mesh.cells())
        if (flagged[c.index()]) wait_at(c);
    while (!waiting.empty()) {
        const VertexId v = waiting.back();
        waiting.pop_back();
        if (is_one_fan(mesh, flagged, v, cells[v.index()])) continue;
        for (const CellId c : cells[v.index()]) {
            if (flagged[c.index()]) continue;
            flagged[c.index()] = 1;
            wait_at(c);
        }
    }
}

BoundaryQuads faces_around(const HexMesh& mesh, const std::vector<char>& flagged) {
    BoundaryQuads faces;
    faces.quad_of_half_face.resize(mesh.cell_count() * hexahedron::face_count);
    faces.on_boundary.assign(mesh.vertex_count(), 0);
    for (const CellId c : mesh.cells()) {
        if (!flagged[c.index()]) continue;
        for (int f = 0; f < hexahedron::face_count; ++f) {
            if (is_flagged(mesh, flagged, c, f)) continue;
            const HalfFaceId h = HexMesh::half_face(c, f);
            faces.quad_of_half_face[h.index()] = QuadId(faces.half_faces.size());
            faces.half_faces.push_back(h);
            faces.vertices.push_back(mesh.face_vertices(h));
            for (const VertexId v : faces.vertices.back()) faces.on_boundary[v.index()] = 1;
        }
    }
    for (const VertexId v : mesh.vertices())
        if (faces.contains(v)) faces.boundary_vertices.push_back(v);
    faces.vertex_quads = rows_by_counting<QuadId>(mesh.vertex_count(), [&](const auto& emit) {
        for (std::size_t q = 0; q < faces.size(); ++q)
            for (const VertexId v : faces.vertices[q]) emit(v.index(), QuadId(q));
    });
    return faces;
}

}  // namespace hex::improving
