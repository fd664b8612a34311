#include <hex/surface/cgal_bridge.h>
#include <hex/surface/polygon_soup.h>

#include <CGAL/Polyhedron_incremental_builder_3.h>

#include <unordered_map>
#include <vector>

namespace hex {
namespace {

CgalKernel::Point_3 to_cgal(const OpenMesh::Vec3d& p) {
    return {p[0], p[1], p[2]};
}
Vec3 to_vec3(const CgalKernel::Point_3& p) {
    return {p.x(), p.y(), p.z()};
}

template <class Mesh>
CgalSurfaceMesh surface_mesh_of(const Mesh& mesh) {
    using Size = CgalSurfaceMesh::size_type;
    CgalSurfaceMesh result;
    result.reserve(static_cast<Size>(mesh.n_vertices()), static_cast<Size>(mesh.n_edges()),
                   static_cast<Size>(mesh.n_faces()));
    for (const auto v : mesh.vertices()) result.add_vertex(to_cgal(mesh.point(v)));
    auto parts = result.add_property_map<CgalSurfaceMesh::Face_index, int>(part_property, 1).first;
    std::vector<CgalSurfaceMesh::Vertex_index> corners;
    for (const auto f : mesh.faces()) {
        corners.clear();
        for (const auto v : mesh.fv_range(f)) corners.emplace_back(static_cast<Size>(v.idx()));
        parts[result.add_face(corners)] = mesh.data(f).part;
    }
    return result;
}

/// Feeds the faces of an OpenMesh mesh to CGAL's builder, leaving out isolated vertices.
template <class Mesh>
class PolyhedronBuilder : public CGAL::Modifier_base<CgalPolyhedron::HalfedgeDS> {
  public:
    explicit PolyhedronBuilder(const Mesh& mesh) : mesh_(mesh) {}
    void operator()(CgalPolyhedron::HalfedgeDS& structure) override {
        CGAL::Polyhedron_incremental_builder_3<CgalPolyhedron::HalfedgeDS> builder(structure, true);
        builder.begin_surface(mesh_.n_vertices(), mesh_.n_faces());
        std::vector<std::size_t> index(mesh_.n_vertices());
        std::size_t used = 0;
        for (const auto v : mesh_.vertices()) {
            if (mesh_.is_isolated(v)) continue;
            index[static_cast<std::size_t>(v.idx())] = used;
            builder.add_vertex(to_cgal(mesh_.point(v)))->id() = used++;
        }
        for (const auto f : mesh_.faces()) {
            const auto facet = builder.begin_facet();
            facet->id() = static_cast<std::size_t>(mesh_.data(f).part);
            for (const auto v : mesh_.fv_range(f))
                builder.add_vertex_to_facet(index[static_cast<std::size_t>(v.idx())]);
            builder.end_facet();
        }
        builder.end_surface();
    }

  private:
    const Mesh& mesh_;
};

template <class Mesh>
CgalPolyhedron polyhedron_of(const Mesh& mesh) {
    CgalPolyhedron polyhedron;
    PolyhedronBuilder<Mesh> builder(mesh);
    polyhedron.delegate(builder);
    return polyhedron;
}

}  // namespace

CgalSurfaceMesh to_surface_mesh(const TriangleMesh& mesh) {
    return surface_mesh_of(mesh);
}
CgalSurfaceMesh to_surface_mesh(const PolyMesh& mesh) {
    return surface_mesh_of(mesh);
}
CgalPolyhedron to_polyhedron(const TriangleMesh& mesh) {
    return polyhedron_of(mesh);
}
CgalPolyhedron to_polyhedron(const PolyMesh& mesh) {
    return polyhedron_of(mesh);
}

TriangleMesh from_cgal(const CgalSurfaceMesh& mesh) {
    PolygonSoup soup;
    std::unordered_map<CgalSurfaceMesh::size_type, std::uint32_t> index;
    for (const auto v : mesh.vertices()) {
        index[v] = static_cast<std::uint32_t>(soup.points.size());
        soup.points.push_back(to_vec3(mesh.point(v)));
    }
    const auto [parts, has_parts] = mesh.property_map<CgalSurfaceMesh::Face_index, int>(part_property);
    std::vector<std::uint32_t> polygon;
    for (const auto f : mesh.faces()) {
        polygon.clear();
        for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) polygon.push_back(index.at(v));
        soup.add_polygon(polygon, has_parts ? parts[f] : 1);
    }
    return make_triangle_mesh(soup, {.closed = false});
}

TriangleMesh from_cgal(const CgalPolyhedron& mesh) {
    PolygonSoup soup;
    std::unordered_map<const CgalPolyhedron::Vertex*, std::uint32_t> index;
    for (auto v = mesh.vertices_begin(); v != mesh.vertices_end(); ++v) {
        index[&*v] = static_cast<std::uint32_t>(soup.points.size());
        soup.points.push_back(to_vec3(v->point()));
    }
    std::vector<std::uint32_t> polygon;
    for (auto f = mesh.facets_begin(); f != mesh.facets_end(); ++f) {
        polygon.clear();
        auto h = f->facet_begin();
        do polygon.push_back(index.at(&*h->vertex()));
        while (++h != f->facet_begin());
        soup.add_polygon(polygon, static_cast<int>(f->id()));
    }
    return make_triangle_mesh(soup, {.closed = false});
}

}  // namespace hex
