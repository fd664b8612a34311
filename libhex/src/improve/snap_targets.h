/// \file snap_targets.h
/// Where on a surface the boundary vertices of a mesh that is not on it yet should go.
#pragma once

#include <hex/surface/mesh_types.h>
#include <hex/volume/topology.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace hex::improving {

/// Where a boundary vertex should go, and how freely.
struct SnapTarget {
    enum class Kind : std::uint8_t {
        smooth,  ///< it may slide across `axis`, in the tangent plane
        edge,    ///< it may slide along `axis`
        corner,  ///< it may not slide
    };
    Vec3 point = Vec3::Zero();
    Vec3 axis = Vec3::Zero();  ///< unit
    Kind kind = Kind::smooth;
};

/// Each component of the boundary of a mesh has a component of the surface to go to, that to which most of it
/// is nearest. Closest points are looked for there, and must face the same way as the boundary does: on a
/// thin wall the closest point as such may be on the other side. It does not matter which way the surface is
/// oriented.
class SnapTargets {
  public:
    SnapTargets(const TriangleMesh& surface, const HexMesh& mesh, const BoundaryQuads& boundary);
    ~SnapTargets();
    SnapTargets(const SnapTargets&) = delete;
    SnapTargets& operator=(const SnapTargets&) = delete;

    /// Targets of all boundary vertices for the mesh as it is now; one a mesh vertex. Where the quads at a
    /// vertex go to parts of the surface with different normals, the target is the point that is nearest to
    /// all their tangent planes (the quadric of Garland and Heckbert, Surface simplification using quadric
    /// error metrics, SIGGRAPH 1997): on the sharp edge or in the corner between them. Not where a quad would
    /// have an angle of nearly 180 degrees so.
    void aim(const HexMesh& mesh, std::vector<SnapTarget>& targets) const;

    /// Length of the surface's diagonal.
    double diagonal() const;

  private:
    SnapTarget closest(VertexId v, const Vec3& p, const Vec3& normal) const;
    SnapTarget target_of(const HexMesh& mesh, VertexId v) const;

    struct State;
    std::unique_ptr<State> state_;
    const BoundaryQuads& boundary_;
};

}  // namespace hex::improving
