#include "volume/counting_rows.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/feature/feature_set.h>

#include <algorithm>
#include <string>

namespace hex {
namespace {

/// Boundary quads at each edge of the table: two on a manifold boundary, none inside.
CompressedRows<QuadId> edge_quads(const EdgeTable& edges, const BoundaryQuads& boundary) {
    return rows_by_counting<QuadId>(edges.size(), [&](const auto& emit) {
        for (std::size_t q = 0; q < boundary.size(); ++q) {
            const HalfFaceId h = boundary.half_faces[q];
            const auto& cell_edges = edges.cell_edges[HexMesh::cell_of(h).index()];
            const auto& corners = hexahedron::face_corners[static_cast<std::size_t>(HexMesh::local_face(h))];
            for (std::size_t i = 0; i < 4; ++i) {
                const int local = hexahedron::edge_between(corners[i], corners[(i + 1) % 4]);
                emit(cell_edges[static_cast<std::size_t>(local)].index(), QuadId(q));
            }
        }
    });
}

/// Unit outward normal of a quad from the cross product of its diagonals, twice the vector area: it weighs
/// all four corners alike, wherever the quad is cut into triangles. Zero for a quad without area.
Vec3 quad_normal(const HexMesh& mesh, const std::array<VertexId, 4>& quad) {
    const Vec3 area = (mesh.position(quad[2]) - mesh.position(quad[0]))
                          .cross(mesh.position(quad[3]) - mesh.position(quad[1]));
    const double length = area.norm();
    return length > 0.0 ? Vec3(area / length) : Vec3(Vec3::Zero());
}

}  // namespace

std::size_t FeatureSet::sharp_edge_count() const {
    return static_cast<std::size_t>(
        std::count_if(sharp_edge.begin(), sharp_edge.end(), [](char flag) { return flag != 0; }));
}

FeatureSet no_features(const HexMesh&, const EdgeTable& edges, const BoundaryQuads& boundary) {
    return classify(edges, boundary, std::vector<char>(edges.size(), 0));
}

FeatureSet features_by_angle(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                             double cosine) {
    if (!(cosine >= -1.0 && cosine <= 1.0))
        throw Error(ErrorKind::usage, "the cosine of the feature angle must lie in [-1, 1]");
    std::vector<Vec3> normals(boundary.size());
    parallel_for(normals.size(),
                 [&](std::size_t q) { normals[q] = quad_normal(mesh, boundary.vertices[q]); });
    const CompressedRows<QuadId> quads = edge_quads(edges, boundary);
    std::vector<char> sharp(edges.size(), 0);
    parallel_for(sharp.size(), [&](std::size_t e) {
        const auto around = quads[e];
        if (around.size() == 2) {
            const Vec3& a = normals[around[0].index()];
            const Vec3& b = normals[around[1].index()];
            const bool both_known = !a.isZero(0.0) && !b.isZero(0.0);
            sharp[e] = both_known && a.dot(b) < cosine;
        } else {
            sharp[e] = around.size() > 2;
        }
    });
    return classify(edges, boundary, std::move(sharp));
}

std::vector<char> flags_of_sharp(const HexMesh& mesh, std::span<const std::int64_t> vertices) {
    std::vector<char> listed(mesh.vertex_count(), 0);
    for (const std::int64_t v : vertices) {
        if (v < 0 || v >= static_cast<std::int64_t>(mesh.vertex_count()))
            throw Error(ErrorKind::bad_input, "sharp vertex " + std::to_string(v) + " does not exist", {},
                        "the mesh has " + std::to_string(mesh.vertex_count()) +
                            " vertices, counted from 0; give the ids of this mesh");
        listed[static_cast<std::size_t>(v)] = 1;
    }
    return listed;
}

FeatureSet features_from_vertices(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                                  std::span<const std::int64_t> vertices) {
    const std::vector<char> listed = flags_of_sharp(mesh, vertices);
    std::vector<char> sharp(edges.size(), 0);
    parallel_for(sharp.size(), [&](std::size_t e) {
        const auto& [a, b] = edges.vertices[e];
        sharp[e] = edges.boundary[e] && listed[a.index()] && listed[b.index()];
    });
    return classify(edges, boundary, std::move(sharp));
}

FeatureSet classify(const EdgeTable& edges, const BoundaryQuads& boundary, std::vector<char> sharp_edge) {
    FeatureSet features;
    features.vertex.assign(boundary.on_boundary.size(), VertexFeature::interior);
    parallel_for(features.vertex.size(), [&](std::size_t v) {
        if (!boundary.on_boundary[v]) return;
        std::size_t sharp = 0;
        for (const EdgeId e : edges.vertex_edges[v]) sharp += sharp_edge[e.index()] != 0;
        features.vertex[v] = sharp == 0   ? VertexFeature::smooth
                             : sharp == 2 ? VertexFeature::crease
                                          : VertexFeature::corner;
    });
    features.sharp_edge = std::move(sharp_edge);
    return features;
}

}  // namespace hex
