#include "least_squares.h"

#include "spline_rows.h"

#include <hex/base/parallel.h>

#include <Eigen/LU>

#include <numeric>

namespace spline {

using hex::Vec3;

LeastSquares::LeastSquares(const SparseRows& rows, std::span<const std::int32_t> variable,
                           std::size_t variables) {
    rows_.offsets.reserve(rows.offsets.size());
    std::vector<std::size_t> next(variables + 1, 0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const SparseRow row = rows[i];
        for (std::size_t k = 0; k < row.size(); ++k) {
            const std::int32_t v = variable[row.columns[k]];
            if (v < 0) continue;
            rows_.columns.push_back(static_cast<std::uint32_t>(v));
            rows_.values.push_back(row.values[k]);
            ++next[static_cast<std::size_t>(v) + 1];
        }
        rows_.offsets.push_back(rows_.columns.size());
    }
    std::partial_sum(next.begin(), next.end(), next.begin());
    by_variable_.offsets = next;
    by_variable_.columns.resize(rows_.columns.size());
    by_variable_.values.resize(rows_.columns.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        for (std::size_t k = rows_.offsets[i]; k < rows_.offsets[i + 1]; ++k) {
            const std::size_t place = next[rows_.columns[k]]++;
            by_variable_.columns[place] = static_cast<std::uint32_t>(i);
            by_variable_.values[place] = rows_.values[k];
        }
    }
}

double LeastSquares::evaluate(std::span<const Vec3> residuals, std::span<const SquareMetric> metrics,
                              double damping, std::span<const Vec3> x, std::span<Vec3> gradient) const {
    std::vector<Vec3> weighted(rows_.size());
    std::vector<double> values(rows_.size());
    hex::parallel_for(rows_.size(), [&](std::size_t i) {
        const Vec3 r = residuals[i] + combine(rows_[i], x);
        weighted[i] = metrics[i](r);
        values[i] = r.dot(weighted[i]);
    });
    hex::parallel_for(
        x.size(), [&](std::size_t v) { gradient[v] = damping * x[v] + combine(by_variable_[v], weighted); },
        64);
    double sum = std::accumulate(values.begin(), values.end(), 0.0);
    for (const Vec3& move : x) sum += damping * move.squaredNorm();
    return sum;
}

std::vector<Vec3> LeastSquares::solve(std::span<const Vec3> residuals, std::span<const SquareMetric> metrics,
                                      double damping, int steps, double tolerance) const {
    const std::size_t count = variable_count();
    std::vector<Vec3> x(count, Vec3::Zero()), r(count), z(count), p(count), product(count);
    std::vector<Vec3> weighted(rows_.size());
    std::vector<Eigen::Matrix3d> inverse(count);
    hex::parallel_for(rows_.size(), [&](std::size_t i) { weighted[i] = metrics[i](residuals[i]); });
    hex::parallel_for(
        count,
        [&](std::size_t v) {
            r[v] = -combine(by_variable_[v], weighted);
            // The diagonal block of the normal equations.
            Eigen::Matrix3d block = damping * Eigen::Matrix3d::Identity();
            const SparseRow column = by_variable_[v];
            for (std::size_t k = 0; k < column.size(); ++k) {
                const SquareMetric& metric = metrics[column.columns[k]];
                const double square = column.values[k] * column.values[k];
                block.diagonal().array() += square * metric.isotropic;
                block += square * metric.axial * metric.axis * metric.axis.transpose();
            }
            const double trace = block.trace();
            block.diagonal().array() += 1e-12 * trace;
            inverse[v] = trace > 0.0 ? Eigen::Matrix3d(block.inverse()) : Eigen::Matrix3d::Zero();
        },
        64);
    const auto dot = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
        return sum;
    };
    const auto precondition = [&] {
        for (std::size_t v = 0; v < count; ++v) z[v] = inverse[v] * r[v];
    };
    precondition();
    p = z;
    double rz = dot(r, z);
    const double enough = tolerance * tolerance * rz;
    for (int step = 0; step < steps && rz > enough; ++step) {
        hex::parallel_for(rows_.size(),
                          [&](std::size_t i) { weighted[i] = metrics[i](combine(rows_[i], p)); });
        hex::parallel_for(
            count, [&](std::size_t v) { product[v] = damping * p[v] + combine(by_variable_[v], weighted); },
            64);
        const double curvature = dot(p, product);
        if (!(curvature > 0.0)) break;
        const double length = rz / curvature;
        for (std::size_t v = 0; v < count; ++v) {
            x[v] += length * p[v];
            r[v] -= length * product[v];
        }
        precondition();
        const double next = dot(r, z);
        const double ratio = next / rz;
        for (std::size_t v = 0; v < count; ++v) p[v] = z[v] + ratio * p[v];
        rz = next;
    }
    return x;
}

}  // namespace spline
