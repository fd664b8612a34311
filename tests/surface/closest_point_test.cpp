/// The search for closest points.

#include "surface/search_set.h"

#include <hex/base/error.h>
#include <hex/surface/closest_point.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

namespace {

using hex::Vec3;
using Triangle = std::array<Vec3, 3>;

/// Triangles of very different sizes and shapes, some of them slivers.
std::vector<Triangle> random_triangles(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1.0, 1.0), exponent(-4.0, 0.0);
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 centre(place(random), place(random), place(random));
        const double size = std::pow(10.0, exponent(random));
        const double thickness = i % 5 == 0 ? 1e-6 : 1.0;
        Triangle t;
        for (Vec3& corner : t)
            corner = centre + size * Vec3(place(random), thickness * place(random), place(random));
        triangles.push_back(t);
    }
    return triangles;
}

TEST(ClosestPoint, IsTheNearestOfAllTrianglesAndLiesOnIt) {
    const std::vector<Triangle> triangles = random_triangles(300, 1);
    const hex::ClosestPoint search(triangles);
    std::vector<std::unique_ptr<hex::ClosestPoint>> single;
    for (const Triangle& t : triangles)
        single.push_back(std::make_unique<hex::ClosestPoint>(std::span<const Triangle>(&t, 1)));
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-2.0, 2.0);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p(place(random), place(random), place(random));
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& one : single) nearest = std::min(nearest, ((*one)(p).point - p).norm());
        const auto found = search(p);
        EXPECT_NEAR((found.point - p).norm(), nearest, 1e-12);
        EXPECT_LT((single[found.triangle]->operator()(found.point).point - found.point).norm(), 1e-9);
    }
}

TEST(ClosestPoint, OfFewTrianglesIsTheNearestWhereverItStarts) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-2.0, 2.0);
    for (std::size_t count = 1; count <= 40; ++count) {
        const std::vector<Triangle> triangles = random_triangles(count, 10 + static_cast<unsigned>(count));
        const hex::ClosestPoint search(triangles);
        std::vector<std::unique_ptr<hex::ClosestPoint>> single;
        for (const Triangle& t : triangles)
            single.push_back(std::make_unique<hex::ClosestPoint>(std::span<const Triangle>(&t, 1)));
        for (int i = 0; i < 20; ++i) {
            const Vec3 p(place(random), place(random), place(random));
            double nearest = std::numeric_limits<double>::infinity();
            for (const auto& one : single) nearest = std::min(nearest, ((*one)(p).point - p).norm());
            for (std::uint32_t hint = 0; hint < count; ++hint) {
                const auto found = search(p, hint);
                EXPECT_NEAR((found.point - p).norm(), nearest, 1e-12) << count << " from " << hint;
                EXPECT_NEAR(((*single[found.triangle])(p).point - p).norm(), nearest, 1e-12);
            }
        }
    }
}

TEST(ClosestPoint, MemoryOfAPointThatMovesChangesNothing) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> place(-1.0, 1.0), exponent(-6.0, 0.0);
    for (const std::size_t count : {1U, 3U, 20U, 2000U}) {
        const hex::TriangleSearch search(random_triangles(count, 7));
        for (int walk = 0; walk < 20; ++walk) {
            hex::TriangleSearch::Memory memory;
            Vec3 p(place(random), place(random), place(random));
            std::uint32_t hint = 0;
            for (int step = 0; step < 50; ++step) {
                const auto plain = search.closest(p, hint);
                const auto found = search.closest(p, hint, &memory);
                ASSERT_EQ(found.point, plain.point);
                ASSERT_EQ(found.item, plain.item);
                hint = found.item;
                // Mostly onto the surface, as in the use that this is made for.
                if (step % 3 > 0) p = found.point;
                p += std::pow(10.0, exponent(random)) * Vec3(place(random), place(random), place(random));
            }
        }
    }
}

TEST(ClosestPoint, OfOneTriangleIsNearerThanAnyPointOfIt) {
    for (const Triangle& t : random_triangles(100, 3)) {
        const hex::ClosestPoint search(std::span<const Triangle>(&t, 1));
        std::mt19937 random(4);
        std::uniform_real_distribution<double> place(-2.0, 2.0), share(0.0, 1.0);
        for (int i = 0; i < 20; ++i) {
            const Vec3 p(place(random), place(random), place(random));
            const double distance = (search(p).point - p).norm();
            for (int k = 0; k < 50; ++k) {
                double a = share(random), b = share(random);
                if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
                EXPECT_LE(distance, (t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]) - p).norm() + 1e-9);
            }
        }
    }
}

TEST(ClosestPoint, TrianglesWithoutAreaKeepTheirNumbersAndAreNotFound) {
    const Vec3 o = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY();
    const std::vector<Triangle> triangles = {{o, o, x}, {o, x, 2.0 * x}, {o, x, y}};
    const hex::ClosestPoint search(triangles);
    const auto found = search(Vec3(0.25, 0.25, 3.0));
    EXPECT_EQ(found.triangle, 2U);
    EXPECT_LT((found.point - Vec3(0.25, 0.25, 0.0)).norm(), 1e-15);
    EXPECT_THROW(hex::ClosestPoint(std::span<const Triangle>(triangles.data(), 2)), hex::Error);
}

}  // namespace
