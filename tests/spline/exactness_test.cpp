#include "spline_samples.h"

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

}  // namespace
}  // namespace spline::test
