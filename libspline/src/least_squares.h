/// \file least_squares.h
/// Sums of squares of points that are combinations of movable points, minimised by conjugate gradients.
#pragma once

#include <hex/base/linear_algebra.h>
#include <spline/sparse_rows.h>

#include <span>
#include <vector>

namespace spline {

/// The square r^T (isotropic I + axial axis axis^T) r of a vector r. Not negative: isotropic >= 0 and
/// isotropic + axial >= 0 for a unit axis.
struct SquareMetric {
    hex::Vec3 axis = hex::Vec3::Zero();
    double isotropic = 0.0, axial = 0.0;

    hex::Vec3 operator()(const hex::Vec3& r) const { return isotropic * r + axial * axis.dot(r) * axis; }
};

/// Rows of combinations, sorted by column, too.
class LeastSquares {
  public:
    /// Columns of `rows` for which `variable` is negative do not move, and are left out.
    LeastSquares(const SparseRows& rows, std::span<const std::int32_t> variable, std::size_t variables);

    std::size_t variable_count() const { return by_variable_.size(); }

    /// The moves x, one a variable, with the least sum of squares of (row i . x + residuals[i]) in
    /// metrics[i], and of damping times x; by preconditioned conjugate gradients from zero, ended after
    /// `steps` or when the residual has fallen by `tolerance`. The same for any number of threads.
    std::vector<hex::Vec3> solve(std::span<const hex::Vec3> residuals, std::span<const SquareMetric> metrics,
                                 double damping, int steps, double tolerance) const;

    /// Half the gradient of the sum at moves x, which must not be longer than the variables; returns the sum.
    double evaluate(std::span<const hex::Vec3> residuals, std::span<const SquareMetric> metrics,
                    double damping, std::span<const hex::Vec3> x, std::span<hex::Vec3> gradient) const;

  private:
    SparseRows rows_;
    SparseRows by_variable_;  ///< the transpose
};

}  // namespace spline
