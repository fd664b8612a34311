#include "spline_samples.h"

#include <spline/jacobian.h>
#include <spline/repair.h>
#include <spline/spline.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace spline::test {
namespace {

class ExactnessOf : public testing::TestWithParam<Sample> {};
INSTANTIATE_TEST_SUITE_P(Samples, ExactnessOf, testing::ValuesIn(samples()),
                         [](const auto& parameter) { return parameter.param.name; });

/// A sample's spline with 0 to 3 levels of local refinement.
BezierSpline refined_spline(const Sample& sample, std::size_t levels) {
    SplineOptions options;
    const hex::HexMesh mesh =
        sample.valence == 4 ? hex::test::shuffled_grid(4, 4, 4, 7) : hex::test::fan(sample.valence, 2);
    options.features = sample.sharp ? hex::FeatureSource::angle : hex::FeatureSource::none;
    options.global_refinements = sample.valence == 4 ? 0 : 1;
    options.refinement = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {0, 9}};
    options.refinement.resize(levels);
    return build(mesh, options).spline;
}

/// Integrals over [0,1] of products of the cubic Bernstein polynomials.
Eigen::Matrix4d gram_of_cubics() {
    const auto binomial = [](int n, int k) {
        double value = 1.0;
        for (int i = 0; i < k; ++i) value = value * (n - i) / (i + 1);
        return value;
    };
    Eigen::Matrix4d gram;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) gram(i, j) = binomial(3, i) * binomial(3, j) / binomial(6, i + j) / 7.0;
    return gram;
}

TEST_P(ExactnessOf, FunctionsAreLinearlyIndependent) {
    // The smallest eigenvalue of the mass matrix over the parameters, scaled to a unit diagonal.
    const Eigen::Matrix4d gram = gram_of_cubics();
    for (const std::size_t levels : {std::size_t{3}}) {
        const BezierSpline s = refined_spline(GetParam(), levels);
        const auto count = static_cast<Eigen::Index>(s.function_count());
        Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(count, count);
        ExtractionGatherer gather(s);
        for (std::size_t e = 0; e < s.element_count(); ++e) {
            const ElementExtraction& element = gather(e);
            const double volume = std::pow(0.125, s.element_level[e]);
            Eigen::MatrixXd rows(static_cast<Eigen::Index>(element.functions.size()), 64);
            for (Eigen::Index r = 0; r < rows.rows(); ++r)
                for (Eigen::Index p = 0; p < 64; ++p)
                    rows(r, p) =
                        element.coefficients[static_cast<std::size_t>(r)][static_cast<std::size_t>(p)];
            Eigen::Matrix<double, 64, 64> tensor;
            for (int p = 0; p < 64; ++p)
                for (int q = 0; q < 64; ++q)
                    tensor(p, q) = gram(p % 4, q % 4) * gram(p / 4 % 4, q / 4 % 4) * gram(p / 16, q / 16);
            const Eigen::MatrixXd local = volume * rows * tensor * rows.transpose();
            for (Eigen::Index r = 0; r < rows.rows(); ++r)
                for (Eigen::Index c = 0; c < rows.rows(); ++c)
                    mass(element.functions[static_cast<std::size_t>(r)],
                         element.functions[static_cast<std::size_t>(c)]) += local(r, c);
        }
        const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
        const Eigen::MatrixXd scaled = scale.asDiagonal() * mass * scale.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
        EXPECT_GT(solver.eigenvalues()[0], 1e-5) << levels << " levels";
    }
}

/// For each function the integral of its gradient over the solid, and the bound of its rounding error.
struct GradientIntegral {
    hex::Vec3 value = hex::Vec3::Zero();
    double magnitude = 0.0;  ///< sum of the absolute values that are summed up
    std::size_t terms = 0;

    /// A sum of n terms has an error of at most n u times the sum of their magnitudes (Higham: Accuracy and
    /// stability of numerical algorithms, 2002, section 4.2). The terms themselves are products of a
    /// coefficient and two derivatives, each a sum of 64 terms over Bezier points, which are sums over 64
    /// control points at most: 2 (64 + 64). Truncation over three levels makes coefficients by three sums of
    /// 64 terms at most, and leaves out, or gives to another, up to 64 coefficients of 1e-15, 9 u each: 3 *
    /// 64 + 9 * 64. Weights, slopes and cofactors add less than 76.
    double bound() const {
        constexpr double u = 0x1p-53;
        return u * static_cast<double>(terms + 256 + 768 + 76) * magnitude;
    }
};

/// The integrands are polynomials of degree 8 at most in each parameter: five Gauss points are exact.
std::vector<GradientIntegral> integrate_gradients(const BezierSpline& s) {
    constexpr std::array<double, 5> x = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                         0.9061798459386640};
    constexpr std::array<double, 5> w = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                         0.4786286704993665, 0.2369268850561891};
    const auto points = bezier_points(s);
    std::vector<GradientIntegral> integrals(s.function_count());
    ExtractionGatherer gather(s);
    for (std::size_t e = 0; e < s.element_count(); ++e) {
        std::array<hex::Vec3, 64> by_point;
        std::array<double, 64> magnitude{};
        by_point.fill(hex::Vec3::Zero());
        for (std::size_t q = 0; q < 125; ++q) {
            const std::array<std::size_t, 3> at = {q % 5, q / 5 % 5, q / 25};
            hex::Vec3 uvw;
            std::array<std::array<double, 4>, 3> value, slope;
            double weight = 1.0;
            for (std::size_t a = 0; a < 3; ++a) {
                const double t = 0.5 * (x[at[a]] + 1.0);
                uvw[static_cast<Eigen::Index>(a)] = t;
                value[a] = bernstein(t);
                slope[a] = bernstein_derivative(t);
                weight *= 0.5 * w[at[a]];
            }
            const Eigen::Matrix3d jacobian = evaluate(s, points, e, uvw).jacobian;
            // The cofactors: determinant times inverse transpose, without a division.
            Eigen::Matrix3d cofactors;
            cofactors.col(0) = jacobian.col(1).cross(jacobian.col(2));
            cofactors.col(1) = jacobian.col(2).cross(jacobian.col(0));
            cofactors.col(2) = jacobian.col(0).cross(jacobian.col(1));
            std::array<hex::Vec3, 64> slopes;
            hex::Vec3 sizes = hex::Vec3::Zero();  // what the columns of the Jacobian are summed up from
            for (std::size_t p = 0; p < 64; ++p) {
                const std::size_t i = p % 4, j = p / 4 % 4, k = p / 16;
                slopes[p] = {slope[0][i] * value[1][j] * value[2][k], value[0][i] * slope[1][j] * value[2][k],
                             value[0][i] * value[1][j] * slope[2][k]};
                sizes += points[s.elements[e][p]].head<3>().norm() * slopes[p].cwiseAbs();
            }
            const hex::Vec3 areas(sizes[1] * sizes[2], sizes[2] * sizes[0], sizes[0] * sizes[1]);
            for (std::size_t p = 0; p < 64; ++p) {
                by_point[p] += weight * (cofactors * slopes[p]);
                magnitude[p] += 2.0 * weight * areas.dot(slopes[p].cwiseAbs());
            }
        }
        const ElementExtraction& element = gather(e);
        for (std::size_t f = 0; f < element.functions.size(); ++f) {
            GradientIntegral& integral = integrals[element.functions[f]];
            if (integral.terms == 0) integral.terms = 125;
            for (std::size_t p = 0; p < 64; ++p) {
                const double coefficient = element.coefficients[f][p];
                if (coefficient == 0.0) continue;
                integral.value += coefficient * by_point[p];
                integral.magnitude += std::abs(coefficient) * magnitude[p];
                ++integral.terms;
            }
        }
    }
    return integrals;
}

/// Refined to three levels as above; with the middle of its control points at the origin, so that magnitudes
/// are not those of a place far away.
BezierSpline centred_spline(const Sample& sample) {
    BezierSpline s = refined_spline(sample, 3);
    hex::Vec3 middle = hex::Vec3::Zero();
    for (const hex::Vec3& p : s.control_points) middle += p / static_cast<double>(s.function_count());
    for (hex::Vec3& p : s.control_points) p -= middle;
    return s;
}

TEST_P(ExactnessOf, LinearPatchTest) {
    // For a function that vanishes on the boundary the integral of its gradient is zero: so the stiffness
    // matrix gives no force inside for a linear field. Holds only when functions and geometry are continuous,
    // across levels, too.
    const BezierSpline s = centred_spline(GetParam());
    const auto boundary = boundary_functions(s);
    const auto integrals = integrate_gradients(s);
    double largest_of_boundary = 0.0, largest_bound = 0.0;
    for (std::size_t f = 0; f < integrals.size(); ++f) {
        if (boundary[f] != 0) {
            largest_of_boundary = std::max(largest_of_boundary, integrals[f].value.norm());
        } else {
            EXPECT_LE(integrals[f].value.norm(), integrals[f].bound()) << "function " << f;
            largest_bound = std::max(largest_bound, integrals[f].bound());
        }
    }
    EXPECT_GT(largest_of_boundary, 1e-3) << "the measure sees forces where there are some";
    EXPECT_LT(largest_bound, 1e-6 * largest_of_boundary) << "and the bound is small against them";
}

TEST(Exactness, ThePatchTestFailsWhereFunctionsJump) {
    // One irregular element alone refined, without closure.
    SplineOptions options;
    options.closure = false;
    options.global_refinements = 1;
    options.refinement = {{0}};
    const BezierSpline s = build(hex::test::fan(5, 2), options).spline;
    const auto boundary = boundary_functions(s);
    const auto integrals = integrate_gradients(s);
    double most = 0.0;
    for (std::size_t f = 0; f < integrals.size(); ++f) {
        if (boundary[f] == 0) most = std::max(most, integrals[f].value.norm() / integrals[f].bound());
    }
    EXPECT_GT(most, 1e6);
}

}  // namespace
}  // namespace spline::test
