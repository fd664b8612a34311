/// \file surface_constraint.h
/// Keeps the boundary vertices of a hexahedral mesh on a triangle surface: each on the smooth region, the
/// sharp curve or the corner of the surface that it belongs to.
#pragma once

#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <memory>

namespace hex::improving {

/// The surface is cut along its sharp edges (dihedral angle with a cosine below `cosine`) into smooth
/// regions, and its sharp edges are cut at corners (where not exactly two of them meet) into curves. A
/// closest point is looked for only in the region or curve that a vertex belongs to, so a vertex cannot jump
/// around an edge to the next face. Part ids play no role here: the border of two patches that goes across a
/// smooth face does not hold a vertex back.
///
/// Closest points come from CGAL AABB trees, one a region and one a curve. Queries are thread-safe.
class SurfaceConstraint {
  public:
    SurfaceConstraint(const TriangleMesh& surface, double cosine);
    ~SurfaceConstraint();
    SurfaceConstraint(const SurfaceConstraint&) = delete;
    SurfaceConstraint& operator=(const SurfaceConstraint&) = delete;

    enum class Kind : std::uint8_t { region, curve, corner };

    /// The part of the surface that a vertex belongs to.
    struct Home {
        Kind kind = Kind::region;
        std::uint32_t index = 0;  ///< of the region, curve or corner
        std::uint32_t hint = 0;   ///< primitive of that region or curve near the last closest point
    };

    /// The corner within `reach` of p; or else the curve; or else the region nearest to p. With a negative
    /// reach always the region.
    Home find_home(const Vec3& p, double reach) const;

    /// Closest point to p on the vertex's home. `home.hint` makes the next search start from there.
    Vec3 project(const Vec3& p, Home& home) const;

    /// Length of the surface's diagonal.
    double diagonal() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace hex::improving
