#include <hex/base/parallel.h>
#include <spline/bezier.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace spline {

bool BezierSpline::rational() const {
    return std::any_of(weights.begin(), weights.end(), [](double w) { return w != 1.0; });
}

std::span<const std::uint32_t> ElementFunctions::operator()(const BezierSpline& spline, std::size_t element) {
    const auto& points = spline.elements[element];
    std::size_t terms = 0;
    for (const std::uint32_t p : points) terms += spline.rows[p].size();
    terms_.resize(terms);

    // Distinct control points by open addressing: their number is far below that of the terms.
    constexpr std::uint32_t empty = 0xffffffff;
    const std::size_t capacity = std::bit_ceil(std::max<std::size_t>(256, terms));
    table_.assign(capacity, {empty, 0});
    found_.clear();
    std::size_t term = 0;
    for (const std::uint32_t p : points) {
        for (const std::uint32_t f : spline.rows[p].columns) {
            std::size_t slot = (f * 2654435761U) & (capacity - 1);
            while (table_[slot].function != f && table_[slot].function != empty)
                slot = (slot + 1) & (capacity - 1);
            if (table_[slot].function == empty) {
                table_[slot] = {f, static_cast<std::uint32_t>(found_.size())};
                found_.push_back(table_[slot]);
            }
            terms_[term++] = table_[slot].place;
        }
    }
    std::sort(found_.begin(), found_.end(),
              [](const Entry& a, const Entry& b) { return a.function < b.function; });
    functions_.resize(found_.size());
    rank_.resize(found_.size());
    for (std::size_t i = 0; i < found_.size(); ++i) {
        functions_[i] = found_[i].function;
        rank_[found_[i].place] = static_cast<std::uint32_t>(i);
    }
    for (std::uint32_t& place : terms_) place = rank_[place];
    return functions_;
}

const ElementExtraction& ExtractionGatherer::operator()(std::size_t element) {
    const auto functions = functions_of_(spline_, element);
    extraction_.functions.assign(functions.begin(), functions.end());
    extraction_.coefficients.assign(functions.size(), {});
    auto place = functions_of_.place_of_terms().begin();
    for (std::size_t p = 0; p < 64; ++p) {
        for (const double value : spline_.rows[spline_.elements[element][p]].values)
            extraction_.coefficients[*place++][p] = value;
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
    BezierSummary summary;
    summary.control_points = spline.function_count();
    summary.elements = spline.element_count();
    if (spline.element_count() == 0) return summary;

    struct Numbers {
        std::size_t least = SIZE_MAX, most = 0, total = 0;
    };
    constexpr std::size_t chunk_size = 256;
    std::vector<Numbers> chunks((spline.element_count() + chunk_size - 1) / chunk_size);
    hex::parallel_for(
        chunks.size(),
        [&](std::size_t chunk) {
            Numbers& numbers = chunks[chunk];
            ElementFunctions functions_of;
            const std::size_t end = std::min(spline.element_count(), (chunk + 1) * chunk_size);
            for (std::size_t e = chunk * chunk_size; e < end; ++e) {
                const std::size_t distinct = functions_of(spline, e).size();
                numbers.least = std::min(numbers.least, distinct);
                numbers.most = std::max(numbers.most, distinct);
                numbers.total += distinct;
            }
        },
        1);
    Numbers all;
    for (const Numbers& numbers : chunks) {
        all.least = std::min(all.least, numbers.least);
        all.most = std::max(all.most, numbers.most);
        all.total += numbers.total;
    }
    summary.functions_min = all.least;
    summary.functions_max = all.most;
    summary.functions_mean = static_cast<double>(all.total) / static_cast<double>(spline.element_count());

    struct Bounds {
        double error = 0.0, smallest = INFINITY;
    };
    const Bounds bounds = hex::parallel_reduce(
        spline.rows.size(), Bounds(),
        [&](Bounds value, std::size_t p) {
            double sum = 0.0;
            for (const double c : spline.rows[p].values) {
                sum += c;
                value.smallest = std::min(value.smallest, c);
            }
            value.error = std::max(value.error, std::abs(sum - 1.0));
            return value;
        },
        [](const Bounds& a, const Bounds& b) {
            return Bounds{std::max(a.error, b.error), std::min(a.smallest, b.smallest)};
        });
    summary.partition_of_unity_error = bounds.error;
    summary.smallest_coefficient = bounds.smallest;
    return summary;
}

}  // namespace spline
