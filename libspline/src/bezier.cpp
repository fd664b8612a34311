#include <hex/base/parallel.h>
#include <spline/bezier.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace spline {

bool BezierSpline::rational() const {
    return std::any_of(weights.begin(), weights.end(), [](double w) { return w != 1.0; });
}

const ElementExtraction& ExtractionGatherer::operator()(std::size_t element) {
    const auto& points = spline_.elements[element];
    auto& functions = extraction_.functions;
    std::size_t terms = 0;
    for (const std::uint32_t p : points) terms += spline_.rows[p].size();

    // Distinct functions by open addressing; the table holds places in `functions`, plus one.
    const std::size_t capacity = std::bit_ceil(std::max<std::size_t>(256, terms));
    table_.assign(capacity, 0);
    const auto place = [&](std::uint32_t function) -> std::uint32_t& {
        std::size_t slot = (function * 2654435761U) & (capacity - 1);
        while (table_[slot] != 0 && functions[table_[slot] - 1] != function)
            slot = (slot + 1) & (capacity - 1);
        return table_[slot];
    };
    functions.clear();
    for (const std::uint32_t p : points) {
        for (const std::uint32_t f : spline_.rows[p].columns) {
            std::uint32_t& entry = place(f);
            if (entry != 0) continue;
            functions.push_back(f);
            entry = static_cast<std::uint32_t>(functions.size());
        }
    }
    std::sort(functions.begin(), functions.end());
    table_.assign(capacity, 0);
    for (std::size_t i = 0; i < functions.size(); ++i) {
        std::size_t slot = (functions[i] * 2654435761U) & (capacity - 1);
        while (table_[slot] != 0) slot = (slot + 1) & (capacity - 1);
        table_[slot] = static_cast<std::uint32_t>(i + 1);
    }
    extraction_.coefficients.assign(functions.size(), {});
    for (std::size_t p = 0; p < 64; ++p) {
        const SparseRow row = spline_.rows[points[p]];
        for (std::size_t i = 0; i < row.size(); ++i)
            extraction_.coefficients[place(row.columns[i]) - 1][p] = row.values[i];
    }
    return extraction_;
}

std::vector<BezierPoint> bezier_points(const BezierSpline& spline) {
    std::vector<BezierPoint> points(spline.rows.size());
    hex::parallel_for(points.size(), [&](std::size_t p) {
        const SparseRow row = spline.rows[p];
        BezierPoint homogeneous = BezierPoint::Zero();
        for (std::size_t i = 0; i < row.size(); ++i) {
            const double scaled = row.values[i] * spline.weights[row.columns[i]];
            homogeneous.head<3>() += scaled * spline.control_points[row.columns[i]];
            homogeneous[3] += scaled;
        }
        homogeneous.head<3>() /= homogeneous[3];
        points[p] = homogeneous;
    });
    return points;
}

std::array<double, 4> bernstein(double t) {
    const double s = 1.0 - t;
    return {s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t};
}

std::array<double, 4> bernstein_derivative(double t) {
    const double s = 1.0 - t;
    return {-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t};
}

ElementPoint evaluate(const BezierSpline& spline, const std::vector<BezierPoint>& points, std::size_t element,
                      const hex::Vec3& uvw) {
    std::array<std::array<double, 4>, 3> value, slope;
    for (std::size_t a = 0; a < 3; ++a) {
        value[a] = bernstein(uvw[static_cast<Eigen::Index>(a)]);
        slope[a] = bernstein_derivative(uvw[static_cast<Eigen::Index>(a)]);
    }
    // Column 0: the homogeneous point; columns 1..3: its derivatives.
    Eigen::Matrix4d sums = Eigen::Matrix4d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t i = 0; i < 4; ++i) {
                BezierPoint q = points[spline.elements[element][i + 4 * j + 16 * k]];
                q.head<3>() *= q[3];
                sums.col(0) += value[0][i] * value[1][j] * value[2][k] * q;
                sums.col(1) += slope[0][i] * value[1][j] * value[2][k] * q;
                sums.col(2) += value[0][i] * slope[1][j] * value[2][k] * q;
                sums.col(3) += value[0][i] * value[1][j] * slope[2][k] * q;
            }
        }
    }
    ElementPoint result;
    const double weight = sums(3, 0);
    result.point = sums.col(0).head<3>() / weight;
    for (Eigen::Index a = 0; a < 3; ++a)
        result.jacobian.col(a) = (sums.col(a + 1).head<3>() - sums(3, a + 1) * result.point) / weight;
    return result;
}

BezierSummary summarize(const BezierSpline& spline) {
    struct Partial {
        std::size_t least = SIZE_MAX, most = 0, total = 0;
        double error = 0.0, smallest = INFINITY;
    };
    constexpr std::size_t chunk_size = 256;
    const std::size_t count = spline.element_count();
    std::vector<Partial> partials((count + chunk_size - 1) / chunk_size);
    hex::parallel_for(
        partials.size(),
        [&](std::size_t chunk) {
            Partial& partial = partials[chunk];
            std::vector<std::uint32_t> functions;
            for (std::size_t e = chunk * chunk_size; e < std::min(count, (chunk + 1) * chunk_size); ++e) {
                functions.clear();
                for (const std::uint32_t p : spline.elements[e]) {
                    const SparseRow row = spline.rows[p];
                    functions.insert(functions.end(), row.columns.begin(), row.columns.end());
                    double sum = 0.0;
                    for (const double c : row.values) {
                        sum += c;
                        partial.smallest = std::min(partial.smallest, c);
                    }
                    partial.error = std::max(partial.error, std::abs(sum - 1.0));
                }
                std::sort(functions.begin(), functions.end());
                const auto distinct = static_cast<std::size_t>(
                    std::unique(functions.begin(), functions.end()) - functions.begin());
                partial.least = std::min(partial.least, distinct);
                partial.most = std::max(partial.most, distinct);
                partial.total += distinct;
            }
        },
        1);
    BezierSummary summary;
    summary.control_points = spline.function_count();
    summary.elements = count;
    if (count == 0) return summary;
    Partial all;
    for (const Partial& p : partials) {
        all.least = std::min(all.least, p.least);
        all.most = std::max(all.most, p.most);
        all.total += p.total;
        all.error = std::max(all.error, p.error);
        all.smallest = std::min(all.smallest, p.smallest);
    }
    summary.functions_min = all.least;
    summary.functions_max = all.most;
    summary.functions_mean = static_cast<double>(all.total) / static_cast<double>(count);
    summary.partition_of_unity_error = all.error;
    summary.smallest_coefficient = all.smallest;
    return summary;
}

}  // namespace spline
