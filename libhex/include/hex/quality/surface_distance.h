/// \file surface_distance.h
/// How far the boundary of a hexahedral mesh and a surface are apart, in both directions.
#pragma once

#include <hex/base/context.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

namespace hex {

/// Lengths in the unit of the mesh; `percent` turns them into percent of the surface's diagonal.
struct SurfaceDistance {
    double diagonal = 0.0;           ///< of the surface
    double vertex_max = 0.0;         ///< of a boundary vertex of the mesh from the surface
    double vertex_mean = 0.0;        ///< over the boundary vertices
    VertexId farthest_vertex;        ///< the first that has vertex_max
    double to_surface_max = 0.0;     ///< boundary vertices and face centres of the mesh, from the surface
    double to_surface_mean = 0.0;    ///< over the same points, not weighted
    double from_surface_max = 0.0;   ///< vertices and triangle centres of the surface, from the boundary
    double from_surface_mean = 0.0;  ///< over the same points, not weighted

    /// Largest of both directions.
    double max() const { return to_surface_max > from_surface_max ? to_surface_max : from_surface_max; }
    /// A length in percent of the surface's diagonal; 0 when that is 0.
    double percent(double length) const { return diagonal > 0.0 ? 100.0 * length / diagonal : 0.0; }
};

/// Measured at the samples that the fields name, exactly from there (CGAL AABB tree): a lower bound of the
/// Hausdorff distance. The boundary faces count as two triangles each, over the diagonal 0-2. Isolated
/// vertices of the surface are left out. Throws Error{bad_input} when one of the two has no triangle with an
/// area, and Error{cancelled}.
SurfaceDistance surface_distance(const HexMesh& mesh, const TriangleMesh& surface,
                                 const Context& context = {});

}  // namespace hex
