/// \file fidelity_meter.h
/// How far the boundary of a hexahedral mesh and a surface are from each other.
#pragma once

#include "improve/surface_curves.h"

#include <memory>
#include <span>

namespace hex::improving {

/// Lengths in the units of the mesh.
struct Fidelity {
    /// Largest distance, of boundary vertices and quad centres to the surface, and of the vertices and
    /// triangle centroids of the surface to the boundary (quads cut along their first diagonal).
    double distance = 0.0;
    /// Mean distance of points on the sharp edges of the surface (five an edge) to the nearest boundary edge;
    /// 0 where nothing is sharp.
    double features = 0.0;

    bool within(const Fidelity& limits) const {
        return distance <= limits.distance && features <= limits.features;
    }
};

class FidelityMeter {
  public:
    /// Keeps references to everything given. An edge is sharp when its cosine is below `sharp_cosine`.
    FidelityMeter(const EdgeTable& edges, const BoundaryQuads& boundary, const GuideSurface& surface,
                  double sharp_cosine);
    ~FidelityMeter();
    FidelityMeter(const FidelityMeter&) = delete;
    FidelityMeter& operator=(const FidelityMeter&) = delete;

    /// Exact, by CGAL AABB trees; the same for any number of threads.
    Fidelity measure(std::span<const Vec3> positions) const;

  private:
    struct Trees;
    const EdgeTable& edges_;
    const BoundaryQuads& boundary_;
    std::unique_ptr<Trees> trees_;
    std::vector<Vec3> surface_samples_;
    std::vector<Vec3> feature_samples_;
};

}  // namespace hex::improving
