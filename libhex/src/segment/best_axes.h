/// \file best_axes.h
/// The three orthogonal directions that a surface's normals agree with best.
#pragma once

#include <hex/base/linear_algebra.h>

#include <vector>

namespace hex {

/// The rotation that turns these directions to the coordinate axes. It raises the sum of area times the
/// fourth powers of the components of the normal (largest where every normal is an axis) to a local
/// maximum, from the best of a fixed set of starts; the identity when no rotation is better by more than a
/// thousandth of the whole area. Linear in the number of triangles, deterministic.
Eigen::Matrix3d best_axes(const std::vector<Vec3>& normals, const std::vector<double>& areas);

}  // namespace hex
