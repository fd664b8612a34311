#include <hex/base/parallel.h>
#include <spline/level_mesh.h>

#include <algorithm>

namespace spline {

using hex::CellId;
using hex::EdgeId;
using hex::HalfFaceId;
using hex::HexMesh;
using hex::VertexFeature;
using hex::VertexId;

FaceTable face_table(const HexMesh& mesh) {
    FaceTable table;
    table.of_half_face.resize(mesh.half_face_count());
    table.half_faces.reserve(mesh.half_face_count() / 2);
    for (const HalfFaceId h : mesh.half_faces()) {
        const HalfFaceId twin = mesh.twin(h);
        if (twin.valid() && twin < h) {
            table.of_half_face[h.index()] = table.of_half_face[twin.index()];
        } else {
            table.of_half_face[h.index()] = static_cast<std::uint32_t>(table.half_faces.size());
            table.half_faces.push_back(h);
        }
    }
    return table;
}

namespace {

/// Boundary quads joined across edges that are not sharp.
std::vector<std::int32_t> find_patches(const LevelMesh& level) {
    const hex::BoundaryQuads& boundary = level.boundary;
    std::vector<std::vector<std::size_t>> quads_of_edge(level.edges.size());
    std::vector<std::array<EdgeId, 4>> edges_of_quad(boundary.size());
    for (std::size_t q = 0; q < boundary.size(); ++q) {
        const HalfFaceId h = boundary.half_faces[q];
        const auto& corners = hex::hexahedron::face_corners[static_cast<std::size_t>(HexMesh::local_face(h))];
        for (std::size_t i = 0; i < 4; ++i) {
            const int local = hex::hexahedron::edge_between(corners[i], corners[(i + 1) % 4]);
            const EdgeId e =
                level.edges.cell_edges[HexMesh::cell_of(h).index()][static_cast<std::size_t>(local)];
            edges_of_quad[q][i] = e;
            quads_of_edge[e.index()].push_back(q);
        }
    }
    std::vector<std::int32_t> patch(boundary.size(), -1);
    std::int32_t count = 0;
    std::vector<std::size_t> stack;
    for (std::size_t first = 0; first < boundary.size(); ++first) {
        if (patch[first] >= 0) continue;
        patch[first] = count;
        stack = {first};
        while (!stack.empty()) {
            const std::size_t q = stack.back();
            stack.pop_back();
            for (const EdgeId e : edges_of_quad[q]) {
                if (level.features.sharp_edge[e.index()] != 0) continue;
                for (const std::size_t other : quads_of_edge[e.index()]) {
                    if (patch[other] >= 0) continue;
                    patch[other] = count;
                    stack.push_back(other);
                }
            }
        }
        ++count;
    }
    return patch;
}

}  // namespace

LevelMesh coarsest_level(HexMesh mesh, hex::EdgeTable edges, hex::BoundaryQuads boundary,
                         hex::FeatureSet features) {
    LevelMesh level;
    level.faces = face_table(mesh);
    level.stars = hex::vertex_cells(mesh);
    level.open_vertex.assign(mesh.vertex_count(), 0);
    level.open_edge.assign(edges.size(), 0);
    level.mesh = std::move(mesh);
    level.edges = std::move(edges);
    level.boundary = std::move(boundary);
    level.features = std::move(features);
    level.patch_of_quad = find_patches(level);
    return level;
}

namespace {

bool is_regular(const LevelMesh& level, VertexId v) {
    const auto edges = level.edges.vertex_edges[v.index()];
    for (const EdgeId e : edges) {
        if (level.is_extraordinary(e)) return false;
    }
    if (level.features.vertex[v.index()] == VertexFeature::interior) return true;

    const std::size_t quads = level.boundary.vertex_quads[v.index()].size();
    const std::size_t cells = level.stars[v.index()].size();
    std::size_t sharp = 0, sharp_with_one_cell = 0;
    bool other_edges_have_two = true;
    for (const EdgeId e : edges) {
        if (level.edges.boundary[e.index()] == 0) continue;
        const std::size_t around = level.edges.cells[e.index()].size();
        if (level.features.sharp_edge[e.index()] != 0) {
            ++sharp;
            sharp_with_one_cell += around == 1;
        } else {
            other_edges_have_two = other_edges_have_two && around == 2;
        }
    }
    switch (level.features.vertex[v.index()]) {
        case VertexFeature::smooth:
            return quads == 4 && cells == 4 && sharp == 0 && other_edges_have_two;
        case VertexFeature::crease:
            return quads == 4 && cells == 2 && sharp == 2 && sharp_with_one_cell == 2 && other_edges_have_two;
        default:
            return quads == 3 && cells == 1 && sharp == 3;
    }
}

}  // namespace

std::vector<char> regular_vertices(const LevelMesh& level) {
    std::vector<char> regular(level.mesh.vertex_count());
    hex::parallel_for(regular.size(), [&](std::size_t v) { regular[v] = is_regular(level, VertexId(v)); });
    return regular;
}

std::vector<ElementClass> classify_elements(const LevelMesh& level) {
    std::vector<char> on_extraordinary_edge(level.mesh.vertex_count(), 0);
    for (std::size_t e = 0; e < level.edges.size(); ++e) {
        if (!level.is_extraordinary(EdgeId(e))) continue;
        for (const VertexId v : level.edges.vertices[e]) on_extraordinary_edge[v.index()] = 1;
    }
    std::vector<ElementClass> classes(level.mesh.cell_count());
    hex::parallel_for(classes.size(), [&](std::size_t c) {
        ElementClass found = ElementClass::regular;
        for (const VertexId v : level.mesh.cell(CellId(c))) {
            if (level.boundary.contains(v)) {
                found = ElementClass::boundary;
                break;
            }
            if (on_extraordinary_edge[v.index()] != 0) found = ElementClass::irregular;
        }
        classes[c] = found;
    });
    return classes;
}

std::map<int, std::size_t> extraordinary_edges(const LevelMesh& level) {
    std::map<int, std::size_t> by_valence;
    for (std::size_t e = 0; e < level.edges.size(); ++e) {
        if (level.is_extraordinary(EdgeId(e))) ++by_valence[static_cast<int>(level.edges.cells[e].size())];
    }
    return by_valence;
}

}  // namespace spline
