#include "surface/large_polygon.h"

#include <hex/base/error.h>
#include <hex/surface/cgal_bridge.h>
#include <hex/surface/polygon_soup.h>

#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>

#include <array>
#include <string>
#include <vector>

namespace hex {
namespace {

/// Remembers which polygon each new triangle comes from: CGAL calls it while it splits a face in place.
struct SourceKeeper : CGAL::Polygon_mesh_processing::Triangulate_faces::Default_visitor<PolyMesh> {
    using Face = boost::graph_traits<PolyMesh>::face_descriptor;

    explicit SourceKeeper(PolyMesh& poly_mesh) : mesh(&poly_mesh) {}
    void before_subface_creations(Face face) {
        part = mesh->data(face).part;
        source = mesh->data(face).source;
    }
    void after_subface_created(Face face) {
        mesh->data(face).part = part;
        mesh->data(face).source = source;
    }

    PolyMesh* mesh;
    int part = 1;
    std::int64_t source = -1;
};

using Face = PolyMesh::FaceHandle;
using Corners = std::array<PolyMesh::VertexHandle, 3>;

[[noreturn]] void cannot_split(std::int64_t polygon) {
    throw Error(ErrorKind::bad_input,
                "polygon " + std::to_string(polygon) + " cannot be split into triangles", {},
                "it may be flat or cross itself");
}

bool is_large(const PolyMesh& mesh, Face face) {
    return mesh.valence(face) > surface::large_polygon;
}

/// Splits these faces in place.
void split_faces(PolyMesh& mesh, const std::vector<Face>& faces) {
    // CGAL replaces a face by removing it first; OpenMesh can only mark what is removed.
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
    namespace PMP = CGAL::Polygon_mesh_processing;
    PMP::triangulate_faces(faces, mesh,
                           PMP::parameters::vertex_point_map(vertex_point_map(mesh))
                               .geom_traits(CgalKernel())
                               .visitor(SourceKeeper(mesh)));
    mesh.garbage_collection();
}

/// A triangle as it is; the triangles of a large polygon.
std::vector<Corners> triangles_of(const PolyMesh& mesh, Face face) {
    std::vector<PolyMesh::VertexHandle> corners(mesh.cfv_begin(face), mesh.cfv_end(face));
    if (corners.size() == 3) return {{corners[0], corners[1], corners[2]}};
    std::vector<Vec3> points;
    if (is_large(mesh, face))
        for (const auto v : corners) points.push_back(to_eigen(mesh.point(v)));
    std::vector<Corners> result;
    if (!points.empty())
        for (const auto& [a, b, c] : surface::triangles_of_large_polygon(points))
            result.push_back({corners[a], corners[b], corners[c]});
    if (result.empty()) cannot_split(mesh.data(face).source);
    return result;
}

}  // namespace

TriangleMesh triangulate(const PolyMesh& mesh) {
    PolyMesh split = mesh;
    std::int64_t polygon_count = 0;
    std::vector<Face> polygons;
    for (const auto f : split.faces()) {
        split.data(f).source = polygon_count++;
        if (split.valence(f) != 3 && !is_large(split, f)) polygons.push_back(f);
    }
    if (!polygons.empty()) split_faces(split, polygons);

    // Triangles of one polygon together, polygons in their order: counting by source.
    std::vector<std::size_t> first(static_cast<std::size_t>(polygon_count) + 1, 0);
    for (const auto f : split.faces()) ++first[static_cast<std::size_t>(split.data(f).source) + 1];
    for (std::size_t p = 0; p + 1 < first.size(); ++p) first[p + 1] += first[p];
    std::vector<Face> order(split.n_faces());
    for (const auto f : split.faces()) order[first[static_cast<std::size_t>(split.data(f).source)]++] = f;

    TriangleMesh triangles;
    triangles.reserve(split.n_vertices(), split.n_edges(), split.n_faces());
    for (const auto v : split.vertices()) triangles.add_vertex(split.point(v));
    for (const auto f : order) {
        for (const Corners& corners : triangles_of(split, f)) {
            std::array<TriangleMesh::VertexHandle, 3> handles;
            for (std::size_t i = 0; i < 3; ++i) handles[i] = TriangleMesh::VertexHandle(corners[i].idx());
            const auto face = triangles.add_face(handles.data(), handles.size());
            if (!face.is_valid())
                throw Error(ErrorKind::bad_input, "the triangles of polygon " +
                                                      std::to_string(split.data(f).source) +
                                                      " do not fit together");
            triangles.data(face).part = split.data(f).part;
            triangles.data(face).source = split.data(f).source;
        }
    }
    return triangles;
}

}  // namespace hex
