#include "jacobian_penalty.h"

#include "spline_rows.h"
#include "tensor_determinant.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <memory>

namespace spline {

using hex::Vec3;

std::array<Vec3, 64> element_points(const BezierSpline& spline, std::size_t element,
                                    std::span<const Vec3> control_points) {
    std::array<Vec3, 64> points;
    for (std::size_t p = 0; p < 64; ++p)
        points[p] = combine(spline.rows[spline.elements[element][p]], control_points);
    return points;
}

JacobianPenalty::JacobianPenalty(const BezierSpline& spline, std::vector<std::uint32_t> elements,
                                 std::span<const ElementJacobian> verdicts, double margin, double keep,
                                 double reach)
    : spline_(spline),
      elements_(std::move(elements)),
      volumes_(elements_.size()),
      margins_(elements_.size()),
      weights_(elements_.size(), 1.0),
      excused_(elements_.size()) {
    hex::parallel_for(
        elements_.size(),
        [&](std::size_t i) {
            TensorDeterminant<3> determinant;
            determinant.set_points(element_points(spline_, elements_[i], spline_.control_points));
            std::array<double, 729> coefficients;
            determinant.coefficients(coefficients.data());
            const double rounding = determinant.rounding_bound();
            double sum = 0.0, least = 1e300;
            const ElementJacobian& verdict = verdicts[elements_[i]];
            for (std::size_t c = 0; c < coefficients.size(); ++c) {
                sum += std::abs(coefficients[c]);
                if (verdict.singular != 0 && std::abs(coefficients[c]) <= rounding) {
                    excused_[i].push_back(static_cast<std::uint16_t>(c));
                    continue;
                }
                least = std::min(least, coefficients[c]);
            }
            volumes_[i] = std::max(sum / 729.0, 1e-300);
            margins_[i] = margin * volumes_[i];
            if (verdict.verdict == JacobianVerdict::positive && least > 0.0)
                margins_[i] = std::min(margins_[i], keep * least);
            // A small margin is as dear as a large one, but not beyond what rounding lets one see.
            if (const double enough = reach * std::abs(verdict.lower);
                verdict.verdict != JacobianVerdict::positive && enough < margins_[i]) {
                const double less = std::max(enough / margins_[i], 1e-8);
                margins_[i] *= less;
                weights_[i] = 1.0 / (less * less);
            }
        },
        8);
}

double JacobianPenalty::element_penalty(std::size_t i, std::span<const Vec3> control_points,
                                        std::array<Vec3, 64>& gradient) const {
    TensorDeterminant<3> determinant;
    determinant.set_points(element_points(spline_, elements_[i], control_points));
    if (determinant.quick_lower_bound() >= margins_[i]) return 0.0;
    std::array<double, 729> coefficients;
    determinant.coefficients(coefficients.data());
    for (const std::uint16_t c : excused_[i]) coefficients[c] = margins_[i];
    double sum = 0.0;
    const double scale = weights_[i] / (volumes_[i] * volumes_[i]);
    for (double& c : coefficients) {
        const double missing = std::max(0.0, margins_[i] - c);
        sum += missing * missing;
        c = -2.0 * scale * missing;
    }
    if (sum == 0.0) return 0.0;
    gradient.fill(Vec3::Zero());
    determinant.add_gradient(coefficients.data(), gradient);
    return scale * sum;
}

double JacobianPenalty::evaluate(std::span<const Vec3> control_points, std::span<const std::int32_t> variable,
                                 std::vector<Vec3>& gradient) const {
    std::vector<double> values(elements_.size());
    std::vector<std::unique_ptr<std::array<Vec3, 64>>> gradients(elements_.size());
    hex::parallel_for(
        elements_.size(),
        [&](std::size_t i) {
            std::array<Vec3, 64> by_point;
            values[i] = element_penalty(i, control_points, by_point);
            if (values[i] > 0.0) gradients[i] = std::make_unique<std::array<Vec3, 64>>(by_point);
        },
        4);
    double sum = 0.0;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        if (!gradients[i]) continue;
        sum += values[i];
        for (std::size_t p = 0; p < 64; ++p) {
            const SparseRow row = spline_.rows[spline_.elements[elements_[i]][p]];
            for (std::size_t k = 0; k < row.size(); ++k) {
                const std::int32_t v = variable[row.columns[k]];
                if (v >= 0) gradient[static_cast<std::size_t>(v)] += row.values[k] * (*gradients[i])[p];
            }
        }
    }
    return sum;
}

}  // namespace spline
