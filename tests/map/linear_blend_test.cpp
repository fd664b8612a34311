#include <hex/map/linear_blend.h>

#include <gtest/gtest.h>

#include <cmath>

namespace hex {
namespace {

constexpr int n = 32;

bool inside(int i) {
    return i > 0 && i < n;
}

/// Straight along all three axes, bent in between.
Vec3 trilinear(double u, double v, double w) {
    return {u + 0.5 * v * w, 2 * v - 0.3 * u * v * w, w + 0.7 * u * v};
}

/// Straight along u only.
Vec3 ruled(double u, double v, double w) {
    return {(1 - u) * std::sin(3 * v) + u * w * w, v + u * std::cos(w), w - 0.2 * u * v * v};
}

template <class Exact>
BlockGrid filled(const Exact& exact) {
    BlockGrid block(n, n, n);
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i)
                if (!inside(i) || !inside(j) || !inside(k))
                    block(i, j, k) = exact(i / double{n}, j / double{n}, k / double{n});
    blend_linearly(block);
    return block;
}

TEST(LinearBlend, ReproducesTrilinearBlocks) {
    const BlockGrid block = filled(trilinear);
    for (int k = 1; k < n; ++k)
        for (int j = 1; j < n; ++j)
            for (int i = 1; i < n; ++i)
                EXPECT_LT((block(i, j, k) - trilinear(i / double{n}, j / double{n}, k / double{n})).norm(),
                          1e-15);
}

TEST(LinearBlend, ReproducesBilinearFaces) {
    FaceGrid face(n, n);
    const auto exact = [](int i, int j) { return trilinear(i / double{n}, j / double{n}, 0.4); };
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            if (!inside(i) || !inside(j)) face(i, j) = exact(i, j);
    blend_linearly(face);
    for (int j = 1; j < n; ++j)
        for (int i = 1; i < n; ++i) EXPECT_LT((face(i, j) - exact(i, j)).norm(), 1e-15);
}

/// The line to the nearest side counts most: the error of a block that is straight along u only vanishes
/// towards u = 0 and 1.
TEST(LinearBlend, MeetsTheSides) {
    const BlockGrid block = filled(ruled);
    const auto error = [&](int i) {
        return (block(i, n / 2, n / 2) - ruled(i / double{n}, 0.5, 0.5)).norm();
    };
    EXPECT_GT(error(n / 2), 0.1);
    EXPECT_LT(error(1), error(n / 8));
    EXPECT_LT(error(n - 1), error(n - n / 8));
}

}  // namespace
}  // namespace hex
