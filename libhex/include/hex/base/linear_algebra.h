/// \file linear_algebra.h
/// The few linear algebra types that public interfaces speak.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <limits>

namespace hex {

/// A point or direction in the plane.
using Vec2 = Eigen::Vector2d;
/// A point or direction in space, in the unit of the input.
using Vec3 = Eigen::Vector3d;

/// Axis-aligned bounding box of points; empty until a point is added.
struct BoundingBox {
    /// Smallest coordinate on each axis; +infinity when empty.
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
    /// Largest coordinate on each axis; -infinity when empty.
    Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());

    /// Widens the box so that it contains the point.
    void add(const Vec3& point) {
        lower = lower.cwiseMin(point);
        upper = upper.cwiseMax(point);
    }
    /// No point was added yet.
    bool empty() const { return lower.x() > upper.x(); }
    /// Length of the diagonal, the scale that tolerances and distances in percent refer to; 0 when empty.
    double diagonal() const { return empty() ? 0.0 : (upper - lower).norm(); }
};

}  // namespace hex
