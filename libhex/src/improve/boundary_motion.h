/// \file boundary_motion.h
/// Where vertices may go: inside anywhere; on the boundary along it, as their feature class says; on the
/// given surface, when there is one.
#pragma once

#include "improve/boundary_guide.h"

#include <hex/feature/feature_set.h>

namespace hex::improving {

class BoundaryMotion {
  public:
    /// \param guide to the surface; may be null. Keeps references to everything given.
    BoundaryMotion(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                   const FeatureSet& features, const BoundaryGuide* guide);

    /// False for feature corners, and for vertices on a corner of the surface.
    bool is_fixed(VertexId v) const;

    /// From a boundary vertex to where smoothing wants it (paper, smoothing): a smooth vertex to
    /// the area-weighted mean of the centres of its quads, without the part along its normal; a crease vertex
    /// to the length-weighted mean of the middles of its two sharp edges, along its tangent.
    Vec3 smoothing_displacement(VertexId v) const;

    /// The part of a displacement that keeps a boundary vertex on the boundary to first order: in its tangent
    /// plane, or along its crease; zero for a fixed one.
    Vec3 tangential(VertexId v, const Vec3& displacement) const;

    /// The place at or near p where the vertex may be: on its part of the surface; p itself without a
    /// surface. Not for interior vertices. Call for one vertex from one thread at a time.
    Vec3 constrained(VertexId v, const Vec3& p);

  private:
    Vec3 area_normal(VertexId v) const;
    /// The other ends of the two sharp edges of a crease vertex.
    std::array<VertexId, 2> crease_neighbours(VertexId v) const;

    const HexMesh& mesh_;
    const EdgeTable& edges_;
    const BoundaryQuads& boundary_;
    const FeatureSet& features_;
    const BoundaryGuide* guide_;
    std::vector<std::optional<std::uint32_t>> item_;  // where each vertex's last place was on its part
};

}  // namespace hex::improving
