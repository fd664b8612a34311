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
    FaceTraits {
      public:
        int part = 1;
        std::int64_t source = -1;
    };
};

/// Triangle surface. Vertex and face indices are those of the input file, isolated vertices included.
using TriangleMesh = OpenMesh::TriMesh_ArrayKernelT<SurfaceTraits>;
/// Polygon surface, as read.
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<SurfaceTraits>;

/// The same three numbers as an Eigen vector, and back.
inline Vec3 to_eigen(const OpenMesh::Vec3d& p) {
    return {p[0], p[1], p[2]};
}
inline OpenMesh::Vec3d to_openmesh(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

}  // namespace hex
