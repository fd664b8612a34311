/// \file part_targets.h
/// Where on the part points of the boundary belong, and how the squared distance grows around there.
#pragma once

#include "least_squares.h"

#include <hex/surface/closest_point.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace spline {

/// A place on the part and the metric of distances from it. Along a smooth surface, along a sharp edge, a
/// point may slide at little cost: second order approximations of the squared distance.
/// Source: Wang, Pottmann, Liu: Fitting B-spline curves to point clouds by curvature-based squared distance
/// minimization, ACM TOG 25, 2006.
struct PartTarget {
    hex::Vec3 point;
    SquareMetric metric;
};

class Part {
  public:
    /// Cost of sliding, of the cost of leaving.
    static constexpr double sliding = 0.001;

    explicit Part(const hex::TriangleMesh& mesh);

    /// Points with their areas: vertices and triangle centres, of large surfaces evenly many.
    struct Sample {
        hex::Vec3 point;
        double area;
    };
    const std::vector<Sample>& samples() const { return samples_; }

    const hex::ClosestPoint& search() const { return search_; }

    /// For `p`, whose closest point is `foot`.
    PartTarget target(const hex::Vec3& p, const hex::ClosestPoint::Answer& foot) const;

    /// For a point of a crease that runs along the unit vector `tangent`: on a sharp edge nearer than
    /// `radius` that runs along with it.
    std::optional<PartTarget> crease_target(const hex::Vec3& p, const hex::Vec3& tangent,
                                            double radius) const;

  private:
    hex::ClosestPoint search_;
    std::vector<std::uint8_t> sharp_sides_;  ///< bit k: the edge from corner k to k + 1 of the triangle
    std::vector<std::array<hex::Vec3, 2>> sharp_edges_;
    std::optional<hex::ClosestOnSegments> sharp_search_;
    std::vector<Sample> samples_;
};

}  // namespace spline
