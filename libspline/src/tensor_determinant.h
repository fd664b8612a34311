/// \file tensor_determinant.h
/// The Jacobian determinant of a tensor-product Bezier element as a polynomial in Bernstein form.
///
/// For an element of degree P the determinant X_u . (X_v x X_w) has degree N = 3 P - 1 in each parameter. In
/// scaled Bernstein form (coefficients times their binomials) products of polynomials are convolutions, so
/// nothing is solved for and every coefficient is a weighted mean of products: rounding stays small.
#pragma once

#include <hex/base/linear_algebra.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace spline {

/// Number of coefficients along u, v, w: the degrees plus one.
template <std::size_t U, std::size_t V, std::size_t W>
struct TensorShape {
    static constexpr std::size_t u = U, v = V, w = W, count = U * V * W;
};

template <class A, class B>
using ProductShape = TensorShape<A::u + B::u - 1, A::v + B::v - 1, A::w + B::w - 1>;

/// out += factor a b, in scaled form.
template <class A, class B>
void multiply_add(double factor, const double* a, const double* b, double* out) {
    using Out = ProductShape<A, B>;
    for (std::size_t k = 0; k < A::w; ++k)
        for (std::size_t j = 0; j < A::v; ++j)
            for (std::size_t i = 0; i < A::u; ++i) {
                const double x = factor * a[i + A::u * (j + A::v * k)];
                for (std::size_t n = 0; n < B::w; ++n)
                    for (std::size_t m = 0; m < B::v; ++m) {
                        const double* in = b + B::u * (m + B::v * n);
                        double* to = out + i + Out::u * (j + m + Out::v * (k + n));
                        for (std::size_t l = 0; l < B::u; ++l) to[l] += x * in[l];
                    }
            }
}

/// The transpose of multiply_add as a map of a: a += factor (b^T out).
template <class A, class B>
void multiply_transposed_add(double factor, const double* out, const double* b, double* a) {
    using Out = ProductShape<A, B>;
    for (std::size_t k = 0; k < A::w; ++k)
        for (std::size_t j = 0; j < A::v; ++j)
            for (std::size_t i = 0; i < A::u; ++i) {
                double sum = 0.0;
                for (std::size_t n = 0; n < B::w; ++n)
                    for (std::size_t m = 0; m < B::v; ++m) {
                        const double* in = b + B::u * (m + B::v * n);
                        const double* from = out + i + Out::u * (j + m + Out::v * (k + n));
                        for (std::size_t l = 0; l < B::u; ++l) sum += from[l] * in[l];
                    }
                a[i + A::u * (j + A::v * k)] += factor * sum;
            }
}

constexpr double binomial(std::size_t n, std::size_t k) {
    double value = 1.0;
    for (std::size_t i = 0; i < k; ++i)
        value = value * static_cast<double>(n - i) / static_cast<double>(i + 1);
    return value;
}

/// The products of binomials that scale the coefficients of a shape.
template <class Shape>
constexpr std::array<double, Shape::count> binomials_of() {
    std::array<double, Shape::count> factors{};
    for (std::size_t k = 0; k < Shape::w; ++k)
        for (std::size_t j = 0; j < Shape::v; ++j)
            for (std::size_t i = 0; i < Shape::u; ++i)
                factors[i + Shape::u * (j + Shape::v * k)] =
                    binomial(Shape::u - 1, i) * binomial(Shape::v - 1, j) * binomial(Shape::w - 1, k);
    return factors;
}
template <class Shape>
inline constexpr std::array<double, Shape::count> binomials = binomials_of<Shape>();

/// Coefficients of the Jacobian determinant of one element of degree P, and their derivatives.
template <int P>
class TensorDeterminant {
  public:
    static constexpr std::size_t n = 3 * static_cast<std::size_t>(P);
    static constexpr std::size_t point_count = static_cast<std::size_t>((P + 1) * (P + 1) * (P + 1));
    static constexpr std::size_t coefficient_count = n * n * n;
    static constexpr std::size_t derivative_count = static_cast<std::size_t>(P * (P + 1) * (P + 1));

    /// Differences of `points` (i + (P+1) j + (P+1)^2 k) along the axes, times P: the Bernstein coefficients
    /// of the derivatives.
    void set_points(std::span<const hex::Vec3, point_count> points) {
        std::array<std::size_t, 3> next{};
        for (std::size_t k = 0; k < m; ++k)
            for (std::size_t j = 0; j < m; ++j)
                for (std::size_t i = 0; i < m; ++i) {
                    const std::size_t at = i + m * (j + m * k);
                    const std::array<bool, 3> inside = {i < P, j < P, k < P};
                    const std::array<std::size_t, 3> strides = {1, m, m * m};
                    for (std::size_t a = 0; a < 3; ++a) {
                        if (!inside[a]) continue;
                        const hex::Vec3 d = P * (points[at + strides[a]] - points[at]);
                        for (std::size_t c = 0; c < 3; ++c)
                            derivatives_[a][c][next[a]] = d[static_cast<Eigen::Index>(c)];
                        ++next[a];
                    }
                }
    }

    hex::Vec3 derivative(std::size_t axis, std::size_t i) const {
        return {derivatives_[axis][0][i], derivatives_[axis][1][i], derivatives_[axis][2][i]};
    }

    /// A bound of the determinant from below that costs little, or no positive number: with A the mean
    /// Jacobian, all singular values of A^-1 J are at least 1 - s, s^2 the sum over the axes of the largest
    /// squared distance of A^-1 d from its mean.
    double quick_lower_bound() const {
        Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t c = 0; c < 3; ++c) {
                double sum = 0.0;
                for (const double x : derivatives_[a][c]) sum += x;
                mean(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(a)) =
                    sum / static_cast<double>(derivative_count);
            }
        const double determinant = mean.determinant();
        if (!(determinant > 1e-6 * mean.col(0).norm() * mean.col(1).norm() * mean.col(2).norm())) return 0.0;
        const Eigen::Matrix3d inverse = mean.inverse();
        double sum = 0.0;
        for (std::size_t a = 0; a < 3; ++a) {
            double largest = 0.0;
            for (std::size_t i = 0; i < derivative_count; ++i) {
                hex::Vec3 d = inverse * derivative(a, i);
                d[static_cast<Eigen::Index>(a)] -= 1.0;
                largest = std::max(largest, d.squaredNorm());
            }
            sum += largest;
        }
        if (!(sum < 0.98)) return 0.0;
        const double least = 1.0 - std::sqrt(sum);
        return determinant * least * least * least;
    }

    /// Bound of the rounding errors of `coefficients`: each is a mean of products of three derivatives,
    /// summed up in fewer than 300 operations.
    double rounding_bound() const {
        double product = 1.0;
        for (std::size_t a = 0; a < 3; ++a) {
            double largest = 0.0;
            for (std::size_t i = 0; i < derivative_count; ++i)
                largest = std::max(largest, derivative(a, i).squaredNorm());
            product *= std::sqrt(largest);
        }
        return 2.3e-16 * 600.0 * product;
    }

    /// The coefficients, u fastest. Keeps what `add_gradient` needs.
    void coefficients(double* result) {
        scale<0, Du>();
        scale<1, Dv>();
        scale<2, Dw>();
        for (auto& component : normal_) component.fill(0.0);
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t d = (c + 1) % 3, e = (c + 2) % 3;
            multiply_add<Dv, Dw>(1.0, scaled_[1][d].data(), scaled_[2][e].data(), normal_[c].data());
            multiply_add<Dv, Dw>(-1.0, scaled_[1][e].data(), scaled_[2][d].data(), normal_[c].data());
        }
        for (std::size_t i = 0; i < coefficient_count; ++i) result[i] = 0.0;
        for (std::size_t c = 0; c < 3; ++c)
            multiply_add<Du, Normal>(1.0, scaled_[0][c].data(), normal_[c].data(), result);
        for (std::size_t i = 0; i < coefficient_count; ++i) result[i] /= binomials<Result>[i];
    }

    /// Adds to `gradient` the derivatives by the points of sum of weights[i] * coefficient i, after
    /// `coefficients`. Destroys `weights`.
    void add_gradient(double* weights, std::span<hex::Vec3, point_count> gradient) const {
        for (std::size_t i = 0; i < coefficient_count; ++i) weights[i] /= binomials<Result>[i];
        std::array<std::array<std::array<double, derivative_count>, 3>, 3> sums{};
        for (std::size_t c = 0; c < 3; ++c) {
            multiply_transposed_add<Du, Normal>(1.0, weights, normal_[c].data(), sums[0][c].data());
            std::array<double, Normal::count> of_normal{};
            multiply_transposed_add<Normal, Du>(1.0, weights, scaled_[0][c].data(), of_normal.data());
            const std::size_t d = (c + 1) % 3, e = (c + 2) % 3;
            multiply_transposed_add<Dv, Dw>(1.0, of_normal.data(), scaled_[2][e].data(), sums[1][d].data());
            multiply_transposed_add<Dw, Dv>(1.0, of_normal.data(), scaled_[1][d].data(), sums[2][e].data());
            multiply_transposed_add<Dv, Dw>(-1.0, of_normal.data(), scaled_[2][d].data(), sums[1][e].data());
            multiply_transposed_add<Dw, Dv>(-1.0, of_normal.data(), scaled_[1][e].data(), sums[2][d].data());
        }
        spread<0, Du>(sums[0], gradient);
        spread<1, Dv>(sums[1], gradient);
        spread<2, Dw>(sums[2], gradient);
    }

  private:
    static constexpr std::size_t m = P + 1;
    using Du = TensorShape<P, m, m>;
    using Dv = TensorShape<m, P, m>;
    using Dw = TensorShape<m, m, P>;
    using Normal = ProductShape<Dv, Dw>;
    using Result = ProductShape<Du, Normal>;

    template <std::size_t Axis, class Shape>
    void scale() {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < derivative_count; ++i)
                scaled_[Axis][c][i] = derivatives_[Axis][c][i] * binomials<Shape>[i];
    }

    /// From the scaled derivatives to the points.
    template <std::size_t Axis, class Shape>
    static void spread(const std::array<std::array<double, derivative_count>, 3>& sums,
                       std::span<hex::Vec3, point_count> gradient) {
        constexpr std::size_t stride = Axis == 0 ? 1 : Axis == 1 ? m : m * m;
        std::size_t next = 0;
        for (std::size_t k = 0; k < Shape::w; ++k)
            for (std::size_t j = 0; j < Shape::v; ++j)
                for (std::size_t i = 0; i < Shape::u; ++i, ++next) {
                    const std::size_t at = i + m * (j + m * k);
                    hex::Vec3 d(sums[0][next], sums[1][next], sums[2][next]);
                    d *= P * binomials<Shape>[next];
                    gradient[at + stride] += d;
                    gradient[at] -= d;
                }
    }

    using Columns = std::array<std::array<std::array<double, derivative_count>, 3>, 3>;
    Columns derivatives_;  ///< [axis][xyz]
    Columns scaled_;
    std::array<std::array<double, Normal::count>, 3> normal_;  ///< X_v x X_w, scaled
};

}  // namespace spline
