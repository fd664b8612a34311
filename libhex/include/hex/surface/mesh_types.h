/// \file mesh_types.h
/// The OpenMesh half-edge meshes of the surface stages: double precision, with a part id on each face.
#pragma once

#include <hex/base/linear_algebra.h>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <cstdint>

namespace hex {

/// Traits of our OpenMesh meshes. Every face carries, via `mesh.data(face)`:
/// - `part`: part id of the file it came from (1-based by convention; the patch id in a segmented surface);
/// - `source`: index of the polygon of the input it is, or was triangulated from.
struct SurfaceTraits : OpenMesh::DefaultTraitsDouble {
    /// What OpenMesh stores with each face.
    FaceTraits {
      public:
        /// Part id; 1 where the input has none.
        int part = 1;
        /// Index of the polygon of the input; -1 for a face that was not made from one.
        std::int64_t source = -1;
    };
};

/// Triangle surface. Vertex indices are those of the input, isolated vertices included, and so are face
/// indices when the input has triangles only; `source` tells which polygon a triangle is from.
using TriangleMesh = OpenMesh::TriMesh_ArrayKernelT<SurfaceTraits>;
/// Polygon surface, as read.
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<SurfaceTraits>;

/// The same three numbers as an Eigen vector.
inline Vec3 to_eigen(const OpenMesh::Vec3d& p) {
    return {p[0], p[1], p[2]};
}
/// The same three numbers as an OpenMesh vector.
inline OpenMesh::Vec3d to_openmesh(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

}  // namespace hex
