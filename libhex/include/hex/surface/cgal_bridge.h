/// \file cgal_bridge.h
/// For developers who know CGAL: our meshes as CGAL meshes and back. Include only in .cpp files (CGAL is
/// heavy).
///
/// `hex::TriangleMesh` and `hex::PolyMesh` are models of CGAL's FaceGraph as they are (this header includes
/// CGAL's graph traits for OpenMesh), with one trap: CGAL 5.5's own `put(CGAL::vertex_point, ...)` for
/// OpenMesh rounds coordinates to float. Pass `vertex_point_map(mesh)` below as the named parameter
/// `vertex_point_map` wherever an algorithm moves or creates vertices.
#pragma once

#include <hex/surface/mesh_types.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Polyhedron_items_with_id_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/graph_traits_PolyMesh_ArrayKernelT.h>
#include <CGAL/boost/graph/graph_traits_TriMesh_ArrayKernelT.h>

namespace hex {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalSurfaceMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;
using CgalPolyhedron = CGAL::Polyhedron_3<CgalKernel, CGAL::Polyhedron_items_with_id_3>;

/// Name of the face property map that carries part ids in a CGAL::Surface_mesh made by us: "f:part" (int).
inline constexpr const char* part_property = "f:part";

/// Vertex point property map of an OpenMesh mesh in full double precision (CGAL's own rounds to float on
/// `put`).
template <class Mesh>
class VertexPointMap {
  public:
    using key_type = typename boost::graph_traits<Mesh>::vertex_descriptor;
    using value_type = CgalKernel::Point_3;
    using reference = value_type;
    using category = boost::read_write_property_map_tag;

    explicit VertexPointMap(Mesh& mesh) : mesh_(&mesh) {}

    friend value_type get(const VertexPointMap& map, key_type vertex) {
        const auto& p = map.mesh_->point(vertex);
        return {p[0], p[1], p[2]};
    }
    friend void put(const VertexPointMap& map, key_type vertex, const value_type& p) {
        map.mesh_->set_point(vertex, OpenMesh::Vec3d(p.x(), p.y(), p.z()));
    }

  private:
    Mesh* mesh_;
};

template <class Mesh>
VertexPointMap<Mesh> vertex_point_map(Mesh& mesh) {
    return VertexPointMap<Mesh>(mesh);
}

/// Conversions keep the order of vertices and faces; isolated vertices are kept by Surface_mesh and dropped
/// by Polyhedron_3 (which cannot hold them). Part ids travel in the property map `part_property` of
/// Surface_mesh, and in the `id()` of the facets of Polyhedron_3.
CgalSurfaceMesh to_surface_mesh(const TriangleMesh& mesh);
CgalSurfaceMesh to_surface_mesh(const PolyMesh& mesh);
CgalPolyhedron to_polyhedron(const TriangleMesh& mesh);
CgalPolyhedron to_polyhedron(const PolyMesh& mesh);

/// Back to OpenMesh. Faces that are no triangles are triangulated for TriangleMesh. Garbage of removed
/// elements is skipped.
TriangleMesh from_cgal(const CgalSurfaceMesh& mesh);
TriangleMesh from_cgal(const CgalPolyhedron& mesh);

}  // namespace hex
