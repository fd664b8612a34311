/// \file snap_targets.h
/// Where on a surface the boundary vertices of a mesh that is not on it yet should go.
#pragma once

#include <hex/surface/mesh_types.h>
#include <hex/volume/topology.h>

#include <memory>
#include <vector>

namespace hex::improving {

/// Where a boundary vertex should go, and how freely.
struct SnapTarget {
    Vec3 point = Vec3::Zero();
    /// Unit vector: with `along` false the vertex may slide across it, in the tangent plane; with `along`
    /// true it may slide along it. Zero: it may not slide.
    Vec3 axis = Vec3::Zero();
    bool along = false;
};

/// Closest points of a surface that face the same way as the boundary does: on a thin wall the closest point
/// as such may be on the other side. Queries are thread-safe.
class SnapTargets {
  public:
    explicit SnapTargets(const TriangleMesh& surface);
    ~SnapTargets();
    SnapTargets(const SnapTargets&) = delete;
    SnapTargets& operator=(const SnapTargets&) = delete;

    /// \param normal unit outward normal of the boundary at p; zero: any closest point will do
    SnapTarget closest(const Vec3& p, const Vec3& normal) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Unit outward normals of the boundary at its vertices, means of those of the quads weighted by area; zero
/// inside. One a mesh vertex.
std::vector<Vec3> boundary_normals(const HexMesh& mesh, const BoundaryQuads& boundary);

}  // namespace hex::improving
