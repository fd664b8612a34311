#include <hex/map/transfinite.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace hex {
namespace {

/// A trilinear map of the unit cube with the corners of a random, strongly bent block.
struct Trilinear {
    std::array<Vec3, 8> corner;
    explicit Trilinear(unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> number(-1.0, 1.0);
        for (Vec3& c : corner) c = Vec3(number(random), number(random), number(random));
    }
    Vec3 operator()(double u, double v, double w) const {
        Vec3 p = Vec3::Zero();
        for (std::size_t c = 0; c < 8; ++c)
            p += ((c & 1) != 0 ? u : 1 - u) * ((c & 2) != 0 ? v : 1 - v) * ((c & 4) != 0 ? w : 1 - w) *
                 corner[c];
        return p;
    }
};

bool inside(int i, int n) {
    return i > 0 && i < n;
}

TEST(Transfinite, FaceReproducesBilinearMaps) {
    const Trilinear map(1);
    FaceGrid face(5, 3);
    for (int j = 0; j <= 3; ++j)
        for (int i = 0; i <= 5; ++i)
            if (!inside(i, 5) || !inside(j, 3)) face(i, j) = map(i / 5.0, j / 3.0, 0);
    fill_inside(face);
    for (int j = 0; j <= 3; ++j)
        for (int i = 0; i <= 5; ++i) EXPECT_LT((face(i, j) - map(i / 5.0, j / 3.0, 0)).norm(), 1e-15);
}

TEST(Transfinite, BlockReproducesTrilinearMaps) {
    for (unsigned seed = 0; seed < 10; ++seed) {
        const Trilinear map(seed);
        BlockGrid block(4, 3, 5);
        const auto exact = [&](int i, int j, int k) { return map(i / 4.0, j / 3.0, k / 5.0); };
        for (int k = 0; k <= 5; ++k)
            for (int j = 0; j <= 3; ++j)
                for (int i = 0; i <= 4; ++i)
                    if (!inside(i, 4) || !inside(j, 3) || !inside(k, 5)) block(i, j, k) = exact(i, j, k);
        fill_inside(block);
        for (int k = 0; k <= 5; ++k)
            for (int j = 0; j <= 3; ++j)
                for (int i = 0; i <= 4; ++i) EXPECT_LT((block(i, j, k) - exact(i, j, k)).norm(), 4e-15);
    }
}

/// The error of the formula is (1-Pu)(1-Pv)(1-Pw) X, with P the linear blends; it vanishes for every sum of
/// functions of two of the three coordinates.
TEST(Transfinite, BlockReproducesSumsOfFunctionsOfTwoCoordinates) {
    const auto exact = [](int i, int j, int k) {
        const double u = i / 6.0, v = j / 6.0, w = k / 6.0;
        return Vec3(std::sin(3 * u * v) + w * w, std::exp(v * w) - u, std::cos(3 * u + w) + v * v * v);
    };
    BlockGrid block(6, 6, 6);
    for (int k = 0; k <= 6; ++k)
        for (int j = 0; j <= 6; ++j)
            for (int i = 0; i <= 6; ++i)
                if (!inside(i, 6) || !inside(j, 6) || !inside(k, 6)) block(i, j, k) = exact(i, j, k);
    fill_inside(block);
    for (int k = 1; k < 6; ++k)
        for (int j = 1; j < 6; ++j)
            for (int i = 1; i < 6; ++i) EXPECT_LT((block(i, j, k) - exact(i, j, k)).norm(), 1e-14);
}

TEST(Transfinite, FaceErrorIsThatOfTheCoonsPatch) {
    // u^2 v^2 - (its Coons interpolant) = (u^2 - u)(v^2 - v), by the same remainder formula.
    FaceGrid face(4, 4);
    for (int j = 0; j <= 4; ++j)
        for (int i = 0; i <= 4; ++i) {
            const double u = i / 4.0, v = j / 4.0;
            if (!inside(i, 4) || !inside(j, 4)) face(i, j) = Vec3(u, v, u * u * v * v);
        }
    fill_inside(face);
    for (int j = 1; j < 4; ++j)
        for (int i = 1; i < 4; ++i) {
            const double u = i / 4.0, v = j / 4.0;
            EXPECT_NEAR(u * u * v * v - face(i, j).z(), (u * u - u) * (v * v - v), 1e-15);
        }
}

}  // namespace
}  // namespace hex
