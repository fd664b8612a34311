/// \file jacobian_penalty.h
/// A smooth penalty on elements that are not, or hardly, positive: the squared amount by which Bernstein
/// coefficients of the Jacobian determinant fall below a margin, over the element's volume. Zero exactly when
/// every coefficient reaches it, and then the element is proved positive.
#pragma once

#include <hex/base/linear_algebra.h>
#include <spline/bezier.h>
#include <spline/jacobian.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace spline {

class JacobianPenalty {
  public:
    /// Of some elements of a polynomial spline. An element whose `verdicts` entry is positive is only kept
    /// from getting worse: its margin is at most `keep` of its least coefficient. The margin of the others is
    /// `margin` times their volume, or `reach` times the amount by which they fail, where that is less: what
    /// hardly folds then need not become thick. Coefficients that are zero by construction (singular edges)
    /// do not count.
    JacobianPenalty(const BezierSpline& spline, std::vector<std::uint32_t> elements,
                    std::span<const ElementJacobian> verdicts, double margin, double keep,
                    double reach = INFINITY);

    /// The penalty at other positions of the control points. Where `variable[f]` >= 0 the derivatives by
    /// control point f are added to gradient[variable[f]].
    double evaluate(std::span<const hex::Vec3> control_points, std::span<const std::int32_t> variable,
                    std::vector<hex::Vec3>& gradient) const;

    std::span<const std::uint32_t> elements() const { return elements_; }

  private:
    double element_penalty(std::size_t i, std::span<const hex::Vec3> control_points,
                           std::array<hex::Vec3, 64>& gradient) const;

    const BezierSpline& spline_;
    std::vector<std::uint32_t> elements_;
    std::vector<double> volumes_, margins_, weights_;
    std::vector<std::vector<std::uint16_t>> excused_;  ///< coefficients that do not count
};

/// The 64 points of an element of a polynomial spline with other control points.
std::array<hex::Vec3, 64> element_points(const BezierSpline& spline, std::size_t element,
                                         std::span<const hex::Vec3> control_points);

}  // namespace spline
