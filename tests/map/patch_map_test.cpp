#include "map/cases.h"

#include <hex/base/error.h>
#include <hex/map/patch_map.h>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace hex {
namespace {

using test::distance_to_surface;

/// An open mesh that is one patch; corners and chains given by hand.
struct Sheet {
    TriangleMesh mesh;
    Patch patch;
};

Sheet sheet(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles,
            const std::array<Chain, 4>& chains) {
    PolygonSoup soup;
    soup.points = points;
    for (const auto& t : triangles) soup.add_polygon(t);
    Sheet result;
    result.mesh = make_triangle_mesh(soup, {.closed = false});
    result.patch.part = 1;
    result.patch.triangles.resize(triangles.size());
    std::iota(result.patch.triangles.begin(), result.patch.triangles.end(), 0);
    result.patch.loops = {{chains.begin(), chains.end()}};
    for (std::size_t k = 0; k < 4; ++k) result.patch.corners[k] = chains[k].front();
    result.patch.euler_characteristic = 1;
    result.patch.four_sided = true;
    return result;
}

/// (n+1)^2 points over the unit square, moved by `move`.
Sheet grid_sheet(int n, const std::function<Vec3(int, int)>& at) {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    const auto id = [n](int i, int j) { return i + (n + 1) * j; };
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) points.push_back(at(i, j));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const auto v = [&](int di, int dj) { return static_cast<std::uint32_t>(id(i + di, j + dj)); };
            triangles.push_back({v(0, 0), v(1, 0), v(1, 1)});
            triangles.push_back({v(0, 0), v(1, 1), v(0, 1)});
        }
    std::array<Chain, 4> chains;
    for (int i = 0; i <= n; ++i) {
        chains[0].push_back(id(i, 0));
        chains[1].push_back(id(n, i));
        chains[2].push_back(id(n - i, n));
        chains[3].push_back(id(0, n - i));
    }
    return sheet(points, triangles, chains);
}

double signed_area(const PatchParameterization& flat, std::size_t t) {
    const auto& v = flat.triangles[t];
    const Vec2 a = flat.uv[static_cast<std::size_t>(v[0])];
    const Vec2 e = flat.uv[static_cast<std::size_t>(v[1])] - a;
    const Vec2 f = flat.uv[static_cast<std::size_t>(v[2])] - a;
    return 0.5 * (e.x() * f.y() - e.y() * f.x());
}

/// One-to-one: all triangles are counter-clockwise (exactly), and together they are the unit square.
void expect_bijective(const PatchParameterization& flat) {
    using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
    double total = 0.0;
    for (std::size_t t = 0; t < flat.triangles.size(); ++t) {
        std::array<Exact::Point_2, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2& uv = flat.uv[static_cast<std::size_t>(flat.triangles[t][k])];
            p[k] = Exact::Point_2(uv.x(), uv.y());
        }
        EXPECT_EQ(CGAL::orientation(p[0], p[1], p[2]), CGAL::LEFT_TURN) << "triangle " << t;
        total += signed_area(flat, t);
    }
    EXPECT_NEAR(total, 1.0, 1e-12);
    EXPECT_EQ(flat.flipped, 0U);
}

/// Samples lie on the triangles of the patch, and each vertex is the image of its own parameters.
void expect_inverts(const Sheet& s) {
    const PatchMap map(s.mesh, s.patch);
    const PatchParameterization& flat = map.parameterization();
    BoundingBox box;
    for (const Vec3& p : flat.points) box.add(p);
    for (int j = 0; j <= 8; ++j)
        for (int i = 0; i <= 8; ++i) {
            const Vec3 p = map.point(i / 8.0, j / 8.0);
            EXPECT_LT(distance_to_surface(p, s.mesh), 1e-13 * box.diagonal()) << i << ' ' << j;
        }
    for (std::size_t v = 0; v < flat.uv.size(); ++v)
        EXPECT_LT((map.point(flat.uv[v].x(), flat.uv[v].y()) - flat.points[v]).norm(), 1e-7 * box.diagonal())
            << v;
}

TEST(PatchMap, PlanarSquareIsTheIdentity) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> jitter(-0.02, 0.02);
    const Sheet s = grid_sheet(8, [&](int i, int j) {
        const bool border = i == 0 || i == 8 || j == 0 || j == 8;
        return Vec3(i / 8.0 + (border ? 0 : jitter(random)), j / 8.0 + (border ? 0 : jitter(random)), 0);
    });
    const PatchMap map(s.mesh, s.patch);
    const PatchParameterization& flat = map.parameterization();
    EXPECT_EQ(flat.weights, PatchWeights::discrete_conformal);
    for (std::size_t v = 0; v < flat.uv.size(); ++v)
        EXPECT_LT((flat.uv[v] - flat.points[v].head<2>()).norm(), 1e-14);
    for (int j = 0; j <= 10; ++j)
        for (int i = 0; i <= 10; ++i)
            EXPECT_LT((map.point(i / 10.0, j / 10.0) - Vec3(i / 10.0, j / 10.0, 0)).norm(), 1e-14);
}

TEST(PatchMap, CornersAndOrientation) {
    const Sheet s = grid_sheet(3, [](int i, int j) { return Vec3(2 * i, j, i * j); });
    const PatchMap map(s.mesh, s.patch);
    EXPECT_EQ(map.point(0, 0), Vec3(0, 0, 0));
    EXPECT_EQ(map.point(1, 0), Vec3(6, 0, 0));
    EXPECT_EQ(map.point(1, 1), Vec3(6, 3, 9));
    EXPECT_EQ(map.point(0, 1), Vec3(0, 3, 0));
    EXPECT_LT((map.point(0.25, 0) - Vec3(1.5, 0, 0)).norm(), 1e-15);
    EXPECT_LT((map.point(0, 0.25) - Vec3(0, 0.75, 0)).norm(), 1e-15);
    expect_bijective(map.parameterization());
}

TEST(PatchMap, TwoTriangles) {
    const Sheet s = grid_sheet(1, [](int i, int j) { return Vec3(i, j, i * j); });
    expect_bijective(parameterize(s.mesh, s.patch));
    expect_inverts(s);
}

/// A strip: every vertex is on the border, corner 1 has a single triangle.
TEST(PatchMap, NoInteriorVertices) {
    std::vector<Vec3> points;
    const int n = 6;
    for (int i = 0; i <= n; ++i) points.emplace_back(i * i, 0, std::sin(i));
    for (int i = 0; i <= n; ++i) points.emplace_back(i * i + 0.3, 1 + 0.1 * i, 0);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < 6; ++i) {
        triangles.push_back({i, i + 1, i + 7});
        triangles.push_back({i + 1, i + 8, i + 7});
    }
    Chain top = {13, 12, 11, 10, 9, 8, 7};
    const Sheet s = sheet(points, triangles, {Chain{0, 1, 2, 3, 4, 5, 6}, Chain{6, 13}, top, Chain{7, 0}});
    const PatchParameterization flat = parameterize(s.mesh, s.patch);
    EXPECT_EQ(flat.split_edges, 0U);
    expect_bijective(flat);
    expect_inverts(s);
}

/// The triangle at corner 0 is cut off by an edge between its two sides.
TEST(PatchMap, CornerWithASingleTriangle) {
    const Sheet s = sheet({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(3, 0, 0), Vec3(3, 3, 1), Vec3(0, 3, 0),
                           Vec3(0, 1, 0), Vec3(1.5, 1.5, 1)},
                          {{0, 1, 5}, {1, 2, 6}, {2, 3, 6}, {3, 4, 6}, {4, 5, 6}, {5, 1, 6}},
                          {Chain{0, 1, 2}, Chain{2, 3}, Chain{3, 4}, Chain{4, 5, 0}});
    expect_bijective(parameterize(s.mesh, s.patch));
    expect_inverts(s);
}

/// An edge joins two vertices of one side, with a vertex behind it: without a cut all that is behind it would
/// collapse to a line.
TEST(PatchMap, EdgesAlongASideAreCut) {
    const Sheet s =
        sheet({Vec3(0, 0, 0), Vec3(1, -1, 0), Vec3(3, -1, 0), Vec3(4, 0, 0), Vec3(4, 4, 0), Vec3(0, 4, 0),
               Vec3(2, -0.5, 0.2), Vec3(2, 2, 0.5)},
              {{0, 1, 6}, {1, 2, 6}, {2, 3, 6}, {0, 6, 3}, {0, 3, 7}, {3, 4, 7}, {4, 5, 7}, {5, 0, 7}},
              {Chain{0, 1, 2, 3}, Chain{3, 4}, Chain{4, 5}, Chain{5, 0}});
    const PatchParameterization flat = parameterize(s.mesh, s.patch);
    EXPECT_EQ(flat.split_edges, 1U);
    expect_bijective(flat);
    expect_inverts(s);
}

/// An ear: a triangle with all its vertices on one side.
TEST(PatchMap, EarsAreCut) {
    const Sheet s =
        sheet({Vec3(0, 0, 0), Vec3(2, -1, 0), Vec3(4, 0, 0), Vec3(4, 4, 0), Vec3(0, 4, 0)},
              {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}, {Chain{0, 1, 2}, Chain{2, 3}, Chain{3, 4}, Chain{4, 0}});
    const PatchParameterization flat = parameterize(s.mesh, s.patch);
    EXPECT_EQ(flat.split_edges, 1U);
    expect_bijective(flat);
    expect_inverts(s);
}

/// Crumpled sheets with very obtuse triangles: cotangents alone flip some of them.
TEST(PatchMap, ObtuseTrianglesAreNotFlipped) {
    int needed_mean_value = 0;
    for (unsigned seed = 0; seed < 30; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> number(-1.0, 1.0);
        const Sheet s = grid_sheet(7, [&](int i, int j) {
            return Vec3(i + 1.5 * number(random), j + 0.3 * number(random), 3 * number(random));
        });
        const PatchParameterization flat = parameterize(s.mesh, s.patch);
        if (flat.weights == PatchWeights::mean_value) ++needed_mean_value;
        EXPECT_NE(flat.weights, PatchWeights::uniform);
        expect_bijective(flat);
        expect_inverts(s);
    }
    EXPECT_GT(needed_mean_value, 0);
}

/// Triangles without area have no angles: the map must still exist.
TEST(PatchMap, TrianglesWithoutArea) {
    const Sheet s = grid_sheet(4, [](int i, int j) {
        // The inner rows collapse onto one line, some of their vertices onto one point.
        const bool inner = i > 0 && i < 4 && j > 0 && j < 4;
        return inner ? Vec3(2, i == 1 ? 2 : i, 0) : Vec3(i, j, 0);
    });
    const PatchMap map(s.mesh, s.patch);
    for (int j = 0; j <= 16; ++j)
        for (int i = 0; i <= 16; ++i)
            EXPECT_LT(distance_to_surface(map.point(i / 16.0, j / 16.0), s.mesh), 1e-13);
}

TEST(PatchMap, NotFourSidedIsAnError) {
    Sheet s = grid_sheet(2, [](int i, int j) { return Vec3(i, j, 0); });
    s.patch.four_sided = false;
    EXPECT_THROW(parameterize(s.mesh, s.patch), Error);
}

}  // namespace
}  // namespace hex
