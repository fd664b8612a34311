#include "spline_samples.h"
#include "tensor_determinant.h"

#include <spline/jacobian.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

#include <random>

namespace spline::test {
namespace {

using hex::Vec3;

/// A tricubic element: the unit cube with every point moved by up to `amount` in each direction.
std::array<Vec3, 64> shaken_cube(double amount, std::mt19937& random) {
    std::uniform_real_distribution<double> shift(-amount, amount);
    std::array<Vec3, 64> points;
    for (std::size_t p = 0; p < 64; ++p) {
        points[p] =
            Vec3(static_cast<double>(p % 4), static_cast<double>(p / 4 % 4), static_cast<double>(p / 16)) /
            3.0;
        for (double& x : points[p]) x += shift(random);
    }
    return points;
}

double determinant_at(const std::array<Vec3, 64>& points, const Vec3& at) {
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    std::array<std::array<double, 4>, 3> value, slope;
    for (std::size_t a = 0; a < 3; ++a) {
        value[a] = bernstein(at[static_cast<Eigen::Index>(a)]);
        slope[a] = bernstein_derivative(at[static_cast<Eigen::Index>(a)]);
    }
    for (std::size_t p = 0; p < 64; ++p) {
        const std::size_t i = p % 4, j = p / 4 % 4, k = p / 16;
        jacobian.col(0) += slope[0][i] * value[1][j] * value[2][k] * points[p];
        jacobian.col(1) += value[0][i] * slope[1][j] * value[2][k] * points[p];
        jacobian.col(2) += value[0][i] * value[1][j] * slope[2][k] * points[p];
    }
    return jacobian.determinant();
}

double least_sample(const std::array<Vec3, 64>& points, int n) {
    double least = 1e300;
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) least = std::min(least, determinant_at(points, Vec3(i, j, k) / n));
    return least;
}

BezierSpline one_element(const std::array<Vec3, 64>& points) {
    BezierSpline s;
    s.elements.emplace_back();
    for (std::size_t p = 0; p < 64; ++p) {
        s.control_points.push_back(points[p]);
        s.weights.push_back(1.0);
        s.rows.columns.push_back(static_cast<std::uint32_t>(p));
        s.rows.values.push_back(1.0);
        s.rows.offsets.push_back(p + 1);
        s.elements[0][p] = static_cast<std::uint32_t>(p);
    }
    return s;
}

TEST(Jacobian, OfABoxIsItsVolume) {
    std::array<Vec3, 8> corners;
    for (std::size_t c = 0; c < 8; ++c) {
        const auto& uvw = hex::hexahedron::corner_uvw[c];
        corners[c] = Vec3(2.0 * uvw[0], 3.0 * uvw[1] + 0.5 * uvw[0], 0.25 * uvw[2]);
    }
    const ElementJacobian box = bound_jacobian(corners);
    EXPECT_EQ(box.verdict, JacobianVerdict::positive);
    EXPECT_NEAR(box.lower, 1.5, 1e-9);
    EXPECT_DOUBLE_EQ(box.smallest, 1.5);
    std::swap(corners[0], corners[4]), std::swap(corners[1], corners[5]);
    std::swap(corners[2], corners[6]), std::swap(corners[3], corners[7]);
    EXPECT_EQ(bound_jacobian(corners).verdict, JacobianVerdict::negative);
}

TEST(Jacobian, FindsAFoldBetweenPositiveCorners) {
    // Folded along the middle of edge u, where Verdict's nine numbers see nothing: the determinant of the map
    // (u, v, w) -> ((a - u)^2 like) is exactly -0.5 at u = 1/2 of this Bezier cubic.
    std::array<Vec3, 64> points;
    const std::array<double, 4> x = {0.0, 1.0, 0.0, 1.0};  // x' = 3, -3, 3 in Bernstein form: -0.0 ... at 1/2
    for (std::size_t p = 0; p < 64; ++p)
        points[p] = Vec3(x[p % 4], static_cast<double>(p / 4 % 4) / 3, static_cast<double>(p / 16) / 3);
    // x' at 1/2 is (3 - 6 + 3) / 4 = 0: not negative, not positive.
    ElementJacobian fold = bound_jacobian(std::span<const Vec3, 64>(points));
    EXPECT_EQ(fold.verdict, JacobianVerdict::undecided);
    for (std::size_t p = 0; p < 64; ++p) {
        if (p % 4 == 1) points[p][0] += 0.1;
    }
    fold = bound_jacobian(std::span<const Vec3, 64>(points));
    ASSERT_EQ(fold.verdict, JacobianVerdict::negative);
    EXPECT_LT(determinant_at(points, fold.at), 0.0);
    EXPECT_NEAR(determinant_at(points, fold.at), fold.smallest, 1e-12);
    for (std::size_t p = 0; p < 64; ++p) {
        if (p % 4 == 1) points[p][0] -= 0.101;
    }
    EXPECT_EQ(bound_jacobian(std::span<const Vec3, 64>(points)).verdict, JacobianVerdict::positive);
}

TEST(Jacobian, VerdictsAgreeWithDenseSampling) {
    std::mt19937 random(5);
    std::array<int, 3> seen{};
    for (int trial = 0; trial < 60; ++trial) {
        const auto points = shaken_cube(0.03 + 0.003 * trial, random);
        const ElementJacobian bound = bound_jacobian(std::span<const Vec3, 64>(points));
        const double least = least_sample(points, 12);
        ++seen[static_cast<std::size_t>(bound.verdict)];
        EXPECT_LE(bound.lower, least);
        if (bound.verdict == JacobianVerdict::positive) {
            EXPECT_GT(bound.lower, 0.0);
        }
        if (least < 0.0) {
            EXPECT_EQ(bound.verdict, JacobianVerdict::negative);
        }
        if (bound.verdict == JacobianVerdict::negative) {
            EXPECT_NEAR(determinant_at(points, bound.at), bound.smallest, 1e-10);
        }
    }
    EXPECT_GT(seen[0], 10);
    EXPECT_GT(seen[1], 10);
    EXPECT_EQ(seen[2], 0);
}

TEST(Jacobian, OfHexahedraAgreesWithDenseSampling) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> shift(-0.6, 0.6);
    int negative = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::array<Vec3, 8> corners;
        for (std::size_t c = 0; c < 8; ++c) {
            const auto& uvw = hex::hexahedron::corner_uvw[c];
            corners[c] = Vec3(uvw[0], uvw[1], uvw[2]) + Vec3(shift(random), shift(random), shift(random));
        }
        double least = 1e300;
        for (int k = 0; k <= 10; ++k)
            for (int j = 0; j <= 10; ++j)
                for (int i = 0; i <= 10; ++i) {
                    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
                    const Vec3 at = Vec3(i, j, k) / 10.0;
                    for (std::size_t c = 0; c < 8; ++c)
                        for (Eigen::Index a = 0; a < 3; ++a) {
                            double weight = 1.0;
                            for (Eigen::Index b = 0; b < 3; ++b) {
                                const bool upper =
                                    hex::hexahedron::corner_uvw[c][static_cast<std::size_t>(b)] == 1;
                                weight *= b == a ? (upper ? 1.0 : -1.0) : (upper ? at[b] : 1.0 - at[b]);
                            }
                            jacobian.col(a) += weight * corners[c];
                        }
                    least = std::min(least, jacobian.determinant());
                }
        const ElementJacobian bound = bound_jacobian(corners);
        EXPECT_LE(bound.lower, least + 1e-15);
        EXPECT_EQ(bound.verdict == JacobianVerdict::negative, bound.smallest < 0.0);
        if (least < 0.0) {
            EXPECT_EQ(bound.verdict, JacobianVerdict::negative);
        }
        if (bound.verdict == JacobianVerdict::positive) {
            EXPECT_GT(least, 0.0);
        }
        negative += bound.verdict == JacobianVerdict::negative;
    }
    EXPECT_GT(negative, 20);
    EXPECT_LT(negative, 190);
}

TEST(Jacobian, RationalElementsAreDecidedByTheirNumerator) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> weight(0.5, 1.5);
    for (const double amount : {0.02, 0.25}) {
        BezierSpline s = one_element(shaken_cube(amount, random));
        for (double& w : s.weights) w = weight(random);
        const JacobianReport report = certify(s);
        const auto points = bezier_points(s);
        double least = 1e300;
        for (int q = 0; q < 1000; ++q) {
            const Vec3 at = Vec3(q % 10, q / 10 % 10, q / 100) / 9.0;
            least = std::min(least, evaluate(s, points, 0, at).jacobian.determinant());
        }
        EXPECT_EQ(report.proved(), least > 0.0);
        if (!report.negative.empty()) {
            EXPECT_LT(evaluate(s, points, 0, report.elements[0].at).jacobian.determinant(), 0.0);
        }
    }
}

TEST(Jacobian, GradientAgreesWithFiniteDifferences) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    auto points = shaken_cube(0.2, random);
    std::vector<double> weights(729), coefficients(729);
    for (double& w : weights) w = any(random);
    TensorDeterminant<3> determinant;
    const auto value = [&] {
        determinant.set_points(points);
        determinant.coefficients(coefficients.data());
        double sum = 0.0;
        for (std::size_t i = 0; i < 729; ++i) sum += weights[i] * coefficients[i];
        return sum;
    };
    value();
    std::array<Vec3, 64> gradient;
    gradient.fill(Vec3::Zero());
    std::vector<double> used = weights;
    determinant.add_gradient(used.data(), gradient);
    for (std::size_t p = 0; p < 64; p += 7) {
        for (Eigen::Index a = 0; a < 3; ++a) {
            const double h = 0.1, x = points[p][a];  // linear in one coordinate: exact for any step
            points[p][a] = x + h;
            const double above = value();
            points[p][a] = x - h;
            const double below = value();
            points[p][a] = x;
            EXPECT_NEAR((above - below) / (2 * h), gradient[p][a], 1e-6);
        }
    }
}

TEST(Jacobian, ASmoothEdgeWithOneElementIsSingularAndNamed) {
    SplineOptions options;
    const hex::HexMesh grid = hex::test::grid(3, 3, 3);
    const JacobianReport smooth = certify(build(grid, options).spline);
    EXPECT_TRUE(smooth.proved());
    EXPECT_EQ(smooth.singular, 20U) << "all but the body and the six elements amid a face";
    EXPECT_EQ(smooth.lower, 0.0);
    options.features = hex::FeatureSource::angle;
    const JacobianReport sharp = certify(build(grid, options).spline);
    EXPECT_TRUE(sharp.proved());
    EXPECT_EQ(sharp.singular, 0U);
    EXPECT_GT(sharp.lower, 0.0);
}

TEST(Jacobian, TheSameForAnyNumberOfThreads) {
    const BezierSpline s = build(hex::test::fan(5, 2)).spline;
    hex::Context one, two;
    one.threads = 1;
    two.threads = 2;
    const JacobianReport a = certify(s, {}, one), b = certify(s, {}, two);
    ASSERT_EQ(a.elements.size(), b.elements.size());
    EXPECT_EQ(a.lower, b.lower);
    for (std::size_t e = 0; e < a.elements.size(); ++e) EXPECT_EQ(a.elements[e].lower, b.elements[e].lower);
}

}  // namespace
}  // namespace spline::test
