/// \file linear_algebra.h
/// The few linear algebra types that public interfaces speak.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <limits>

namespace hex {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// Axis-aligned bounding box of points; empty until a point is added.
struct BoundingBox {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());

    void add(const Vec3& point) {
        lower = lower.cwiseMin(point);
        upper = upper.cwiseMax(point);
    }
    bool empty() const { return lower.x() > upper.x(); }
    /// Length of the diagonal, the scale that tolerances and distances in percent refer to; 0 when empty.
    double diagonal() const { return empty() ? 0.0 : (upper - lower).norm(); }
};

}  // namespace hex
