/// The energies of `untangle`: gradients against finite differences, minima, behaviour at folds.

#include "improve/improve_cases.h"

#include <hex/improve/corner_energies.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using hex::HexCorners;
using hex::Vec3;

/// A box of the given sides whose corners are shaken by up to `amount`.
HexCorners shaken_box(const Vec3& sides, double amount, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-amount, amount);
    HexCorners corners;
    for (std::size_t c = 0; c < 8; ++c)
        for (Eigen::Index d = 0; d < 3; ++d)
            corners[c][d] =
                sides[d] * hex::hexahedron::corner_uvw[c][static_cast<std::size_t>(d)] + shift(random);
    return corners;
}

template <class Value>
void expect_gradient(const HexCorners& at, const HexCorners& gradient, const Value& value) {
    constexpr double h = 1e-6;
    double scale = 1.0;
    for (const Vec3& g : gradient) scale = std::max(scale, g.norm());
    for (std::size_t c = 0; c < 8; ++c) {
        for (Eigen::Index d = 0; d < 3; ++d) {
            HexCorners plus = at, minus = at;
            plus[c][d] += h;
            minus[c][d] -= h;
            EXPECT_NEAR(gradient[c][d], (value(plus) - value(minus)) / (2.0 * h), 1e-6 * scale);
        }
    }
}

TEST(FoldoverEnergy, GradientIsThatOfFiniteDifferencesAlsoWhereFolded) {
    const Vec3 box(1.0, 2.0, 0.5);
    int folded = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const HexCorners corners = shaken_box(box, seed <= 10 ? 0.1 : 0.6, seed);
        folded += hex::FoldoverEnergy::smallest_determinant(corners, box) < 0.0;
        const hex::FoldoverEnergy energy{.epsilon = 0.3, .size_weight = 0.7};
        HexCorners gradient;
        gradient.fill(Vec3::Zero());
        (void)energy.evaluate(corners, box, &gradient);
        expect_gradient(corners, gradient,
                        [&](const HexCorners& p) { return energy.evaluate(p, box, nullptr); });
    }
    EXPECT_GE(folded, 5);
}

TEST(FoldoverEnergy, ReferenceBoxIsItsMinimum) {
    const Vec3 box(1.0, 2.0, 0.5);
    const hex::FoldoverEnergy energy{.epsilon = 0.0, .size_weight = 1.0};
    HexCorners gradient;
    gradient.fill(Vec3::Zero());
    EXPECT_NEAR(energy.evaluate(shaken_box(box, 0.0, 1), box, &gradient), 8.0 * 5.0, 1e-12);
    for (const Vec3& g : gradient) EXPECT_LT(g.norm(), 1e-12);
    for (unsigned seed = 1; seed <= 20; ++seed)
        EXPECT_GT(energy.evaluate(shaken_box(box, 0.05, seed), box, nullptr), 40.0);
}

TEST(FoldoverEnergy, FoldedIsInfiniteWithoutRegularisationAndFiniteWithIt) {
    HexCorners corners = shaken_box(Vec3::Ones(), 0.0, 1);
    corners[0] = Vec3(2.0, 2.0, 2.0);
    ASSERT_LT(hex::FoldoverEnergy::smallest_determinant(corners, Vec3::Ones()), 0.0);
    EXPECT_TRUE(std::isinf(hex::FoldoverEnergy{.epsilon = 0.0}.evaluate(corners, Vec3::Ones(), nullptr)));
    EXPECT_TRUE(std::isfinite(hex::FoldoverEnergy{.epsilon = 0.1}.evaluate(corners, Vec3::Ones(), nullptr)));
}

TEST(QualityBarrier, GradientIsThatOfFiniteDifferences) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const HexCorners corners = shaken_box(Vec3(1.0, 3.0, 0.5), 0.15, seed);
        const hex::QualityBarrier barrier{.floor = hex::scaled_jacobian(corners) - 0.1};
        HexCorners gradient;
        gradient.fill(Vec3::Zero());
        (void)barrier.evaluate(corners, &gradient);
        expect_gradient(corners, gradient, [&](const HexCorners& p) { return barrier.evaluate(p, nullptr); });
    }
}

TEST(QualityMean, GradientIsThatOfFiniteDifferences) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const HexCorners corners = shaken_box(Vec3(1.0, 3.0, 0.5), 0.15, seed);
        const hex::QualityMean mean{.floor = hex::scaled_jacobian(corners) - 0.1, .barrier_weight = 0.05};
        HexCorners gradient;
        gradient.fill(Vec3::Zero());
        (void)mean.evaluate(corners, &gradient);
        expect_gradient(corners, gradient, [&](const HexCorners& p) { return mean.evaluate(p, nullptr); });
    }
}

TEST(ShortEdgeEnergy, GradientIsThatOfFiniteDifferences) {
    const Vec3 box(1.0, 3.0, 0.5);
    const hex::ShortEdgeEnergy energy{.share = 0.9, .weight = 0.7};
    int short_ones = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const HexCorners corners = shaken_box(box, 0.2, seed);
        HexCorners gradient;
        gradient.fill(Vec3::Zero());
        short_ones += energy.evaluate(corners, box, &gradient) > 0.01;
        expect_gradient(corners, gradient,
                        [&](const HexCorners& p) { return energy.evaluate(p, box, nullptr); });
    }
    EXPECT_GE(short_ones, 10);
}

TEST(ShortEdgeEnergy, IsNothingForLongEdgesAndInfiniteForNone) {
    const hex::ShortEdgeEnergy energy;
    EXPECT_EQ(energy.evaluate(shaken_box(Vec3(0.3, 0.6, 0.9), 0.0, 1), Vec3(1.0, 2.0, 3.0), nullptr), 0.0);
    HexCorners corners = shaken_box(Vec3::Ones(), 0.0, 1);
    corners[1] = corners[0];
    EXPECT_TRUE(std::isinf(energy.evaluate(corners, Vec3::Ones(), nullptr)));
}

TEST(QualityMean, IsAtLeastTheDefectOfTheScaledJacobianAndZeroForABox) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const HexCorners corners = shaken_box(Vec3::Ones(), 0.3, seed);
        const double defect = 1.0 - hex::scaled_jacobian(corners);
        const double value =
            hex::QualityMean{.floor = -1.0, .barrier_weight = 0.0}.evaluate(corners, nullptr);
        EXPECT_GE(value, defect);
        EXPECT_LE(value, std::pow(9.0, 1.0 / 6.0) * defect);
    }
    EXPECT_LT(hex::QualityMean({.floor = -1.0, .barrier_weight = 0.0})
                  .evaluate(shaken_box(Vec3(1.0, 2.0, 0.5), 0.0, 1), nullptr),
              2e-3);
}

TEST(QualityBarrier, IsFiniteExactlyAboveItsFloor) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const HexCorners corners = shaken_box(Vec3::Ones(), 0.4, seed);
        const double quality = hex::scaled_jacobian(corners);
        EXPECT_TRUE(std::isfinite(hex::QualityBarrier{.floor = quality - 1e-6}.evaluate(corners, nullptr)));
        EXPECT_TRUE(std::isinf(hex::QualityBarrier{.floor = quality + 1e-6}.evaluate(corners, nullptr)));
    }
}

}  // namespace
