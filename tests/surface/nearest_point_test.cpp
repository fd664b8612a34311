#include "surface/nearest_point.h"

#include "surface/search_set.h"

#include <gtest/gtest.h>

#include <random>

namespace hex {
namespace {

using Corners = std::array<Vec3, 3>;

Vec3 random_point(std::mt19937& random) {
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    return {number(random), number(random), number(random)};
}

/// The best of many points of the triangle.
double sampled_distance(const Vec3& p, const Corners& t) {
    constexpr int count = 60;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= count; ++i)
        for (int j = 0; i + j <= count; ++j) {
            const double u = double(i) / count;
            const double v = double(j) / count;
            least = std::min(least, ((1.0 - u - v) * t[0] + u * t[1] + v * t[2] - p).norm());
        }
    return least;
}

void expect_nearest(const Vec3& p, const Corners& t) {
    const NearestPoint found = nearest_on_triangle(p, t[0], t[1], t[2]);
    const Vec3 foot = found.shares[0] * t[0] + found.shares[1] * t[1] + found.shares[2] * t[2];
    EXPECT_NEAR(found.shares[0] + found.shares[1] + found.shares[2], 1.0, 1e-12);
    for (const double share : found.shares) EXPECT_GE(share, -1e-12);
    EXPECT_NEAR((foot - p).squaredNorm(), found.squared, 1e-12);
    const double sampled = sampled_distance(p, t);
    EXPECT_LE(std::sqrt(found.squared), sampled + 1e-12);
    const double spacing =
        std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()}) / 60.0;
    EXPECT_GE(std::sqrt(found.squared), sampled - spacing);
}

TEST(NearestPoint, IsNearerThanAnyPointOfTheTriangle) {
    std::mt19937 random(1);
    for (int i = 0; i < 300; ++i)
        expect_nearest(random_point(random),
                       {random_point(random), random_point(random), random_point(random)});
}

TEST(NearestPoint, OfTrianglesWithoutAreaIsThatOfTheirSides) {
    std::mt19937 random(2);
    for (int i = 0; i < 100; ++i) {
        const Vec3 p = random_point(random);
        const Vec3 a = random_point(random);
        const Vec3 b = random_point(random);
        const Vec3 between = a + 0.3 * (b - a);
        for (const Corners& t : {Corners{a, a, b}, Corners{a, b, a}, Corners{b, a, a}, Corners{a, a, a},
                                 Corners{a, between, b}, Corners{between, a, b}, Corners{a, b, between}}) {
            expect_nearest(p, t);
            expect_nearest(t[1], t);
        }
    }
}

TEST(ItemSearch, FindsTheNearestFromAnyStartAmongTrianglesWithoutArea) {
    std::mt19937 random(3);
    std::vector<SearchTriangle> triangles;
    for (int i = 0; i < 60; ++i) {
        const Vec3 a = random_point(random);
        const Vec3 b = a + 0.3 * random_point(random);
        const Vec3 c = i % 3 == 0   ? a
                       : i % 3 == 1 ? Vec3(a + 0.5 * (b - a))
                                    : Vec3(a + 0.3 * random_point(random));
        triangles.push_back({a, b, c});
    }
    const TriangleSearch search(triangles);
    for (int i = 0; i < 50; ++i) {
        const Vec3 p = random_point(random);
        double least = std::numeric_limits<double>::infinity();
        for (const SearchTriangle& t : triangles)
            least = std::min(least, nearest_on_triangle(p, t[0], t[1], t[2]).squared);
        EXPECT_NEAR((search.closest(p).point - p).squaredNorm(), least, 1e-12);
        for (const std::uint32_t hint : {0U, 1U, 2U, 30U, 59U})
            EXPECT_NEAR((search.closest(p, hint).point - p).squaredNorm(), least, 1e-12);
    }
}

}  // namespace
}  // namespace hex
