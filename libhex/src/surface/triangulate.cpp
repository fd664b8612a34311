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

}  // namespace

TriangleMesh triangulate(const PolyMesh& mesh) {
    PolyMesh split = mesh;
    std::int64_t polygon_count = 0;
    bool has_polygons = false;
    for (const auto f : split.faces()) {
        split.data(f).source = polygon_count++;
        has_polygons = has_polygons || split.valence(f) != 3;
    }
    if (has_polygons) {
        // CGAL replaces a face by removing it first; OpenMesh can only mark what is removed.
        split.request_vertex_status();
        split.request_edge_status();
        split.request_halfedge_status();
        split.request_face_status();
        namespace PMP = CGAL::Polygon_mesh_processing;
        PMP::triangulate_faces(split, PMP::parameters::vertex_point_map(vertex_point_map(split))
                                          .geom_traits(CgalKernel())
                                          .visitor(SourceKeeper(split)));
        split.garbage_collection();
    }

    // Triangles of one polygon together, polygons in their order: counting by source.
    std::vector<std::size_t> first(static_cast<std::size_t>(polygon_count) + 1, 0);
    for (const auto f : split.faces()) {
        if (split.valence(f) != 3)
            throw Error(ErrorKind::bad_input,
                        "polygon " + std::to_string(split.data(f).source) + " cannot be split into triangles",
                        {}, "it may be flat or cross itself");
        ++first[static_cast<std::size_t>(split.data(f).source) + 1];
    }
    for (std::size_t p = 0; p + 1 < first.size(); ++p) first[p + 1] += first[p];
    std::vector<PolyMesh::FaceHandle> order(split.n_faces());
    for (const auto f : split.faces()) order[first[static_cast<std::size_t>(split.data(f).source)]++] = f;

    TriangleMesh triangles;
    triangles.reserve(split.n_vertices(), split.n_edges(), split.n_faces());
    for (const auto v : split.vertices()) triangles.add_vertex(split.point(v));
    for (const auto f : order) {
        std::array<TriangleMesh::VertexHandle, 3> corners;
        auto corner = corners.begin();
        for (const auto v : split.fv_range(f)) *corner++ = TriangleMesh::VertexHandle(v.idx());
        const auto face = triangles.add_face(corners.data(), corners.size());
        if (!face.is_valid())
            throw Error(
                ErrorKind::bad_input,
                "the triangles of polygon " + std::to_string(split.data(f).source) + " do not fit together");
        triangles.data(face).part = split.data(f).part;
        triangles.data(face).source = split.data(f).source;
    }
    return triangles;
}

}  // namespace hex
