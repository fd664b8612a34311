#include "spline_samples.h"

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
    for (const std::size_t levels : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
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

TEST_P(ExactnessOf, LinearPatchTest) {
    // For a function that vanishes on the boundary the integral of its gradient is zero: so the stiffness
    // matrix gives no force inside for a linear field. Holds only when functions and geometry are continuous,
    // across levels, too. The integrands are polynomials of degree 8 at most: five Gauss points are exact.
    constexpr std::array<double, 5> x = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                         0.9061798459386640};
    constexpr std::array<double, 5> w = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                         0.4786286704993665, 0.2369268850561891};
    const BezierSpline s = refined_spline(GetParam(), 3);
    const auto points = bezier_points(s);
    const auto boundary = boundary_functions(s);
    std::vector<hex::Vec3> integral(s.function_count(), hex::Vec3::Zero());
    ExtractionGatherer gather(s);
    for (std::size_t e = 0; e < s.element_count(); ++e) {
        const ElementExtraction& element = gather(e);
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
            std::array<hex::Vec3, 64> gradients;
            for (std::size_t p = 0; p < 64; ++p) {
                const std::size_t i = p % 4, j = p / 4 % 4, k = p / 16;
                gradients[p] = cofactors * hex::Vec3(slope[0][i] * value[1][j] * value[2][k],
                                                     value[0][i] * slope[1][j] * value[2][k],
                                                     value[0][i] * value[1][j] * slope[2][k]);
            }
            for (std::size_t f = 0; f < element.functions.size(); ++f)
                for (std::size_t p = 0; p < 64; ++p)
                    integral[element.functions[f]] += weight * element.coefficients[f][p] * gradients[p];
        }
    }
    double largest_inside = 0.0, largest_boundary = 0.0;
    for (std::size_t f = 0; f < integral.size(); ++f) {
        double& largest = boundary[f] != 0 ? largest_boundary : largest_inside;
        largest = std::max(largest, integral[f].norm());
    }
    EXPECT_LE(largest_inside, 1e-14);
    EXPECT_GT(largest_boundary, 1e-3) << "the measure sees forces where there are some";
}

}  // namespace
}  // namespace spline::test
