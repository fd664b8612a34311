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

/// Exact predicates, coordinates in double precision: ours go to it and back without a change.
using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
/// Index-based half-edge mesh with property maps; polygons of any number of corners.
using CgalSurfaceMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;
/// Pointer-based half-edge mesh whose vertices, half-edges and facets have an `id()`.
using CgalPolyhedron = CGAL::Polyhedron_3<CgalKernel, CGAL::Polyhedron_items_with_id_3>;

/// Name of the face property map that carries part ids in a CGAL::Surface_mesh made by us: "f:part" (int).
inline constexpr const char* part_property = "f:part";

/// Vertex point property map of an OpenMesh mesh in full double precision (CGAL's own rounds to float on
/// `put`).
template <class Mesh>
class VertexPointMap {
  public:
    /// A vertex of the mesh.
    using key_type = typename boost::graph_traits<Mesh>::vertex_descriptor;
    /// Its position.
    using value_type = CgalKernel::Point_3;
    /// A copy: OpenMesh stores points of another type.
    using reference = value_type;
    /// Says to CGAL and Boost that both get() and put() work.
    using category = boost::read_write_property_map_tag;

    /// Keeps a pointer to the mesh, which must outlive the map.
    explicit VertexPointMap(Mesh& mesh) : mesh_(&mesh) {}

    /// Position of a vertex.
    friend value_type get(const VertexPointMap& map, key_type vertex) {
        const auto& p = map.mesh_->point(vertex);
        return {p[0], p[1], p[2]};
    }
    /// Moves a vertex.
    friend void put(const VertexPointMap& map, key_type vertex, const value_type& p) {
        map.mesh_->set_point(vertex, OpenMesh::Vec3d(p.x(), p.y(), p.z()));
    }

  private:
    Mesh* mesh_;
};

/// The map of `mesh`, a TriangleMesh or a PolyMesh, to be passed to CGAL.
template <class Mesh>
VertexPointMap<Mesh> vertex_point_map(Mesh& mesh) {
    return VertexPointMap<Mesh>(mesh);
}

/// The triangles as a CGAL::Surface_mesh, vertices (isolated ones, too) and faces in the same order. Part ids
/// are in its property map `part_property`.
CgalSurfaceMesh to_surface_mesh(const TriangleMesh& mesh);
/// The polygons as a CGAL::Surface_mesh, in the same way.
CgalSurfaceMesh to_surface_mesh(const PolyMesh& mesh);
/// The triangles as a CGAL::Polyhedron_3, vertices and facets in the same order, but without isolated
/// vertices, which it cannot hold. The `id()` of a facet is its part id, that of a vertex its place among the
/// vertices that are left.
CgalPolyhedron to_polyhedron(const TriangleMesh& mesh);
/// The polygons as a CGAL::Polyhedron_3, in the same way.
CgalPolyhedron to_polyhedron(const PolyMesh& mesh);

/// Back to OpenMesh, with the part ids of `part_property`, 1 where the mesh does not have it. The surface may
/// be open. Faces that are no triangles are triangulated. Garbage of removed elements is skipped. Throws
/// Error{bad_input} as make_triangle_mesh() does.
TriangleMesh from_cgal(const CgalSurfaceMesh& mesh);
/// Back to OpenMesh in the same way; the part id of a face is the `id()` of its facet, which is -1 where
/// nobody has set it.
TriangleMesh from_cgal(const CgalPolyhedron& mesh);

}  // namespace hex
