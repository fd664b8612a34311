/// Boundary vertices on a given surface.

#include "improve/improve_cases.h"

#include <hex/surface/polygon_soup.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using hex::Vec3;
using hex::test::method;

/// Triangulated sphere of radius 1: an octahedron, divided `depth` times.
hex::PolygonSoup sphere(int depth) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) {
                std::array<Vec3, 3> t = {Vec3(x, 0, 0), Vec3(0, y, 0), Vec3(0, 0, z)};
                if (x * y * z < 0.0) std::swap(t[1], t[2]);
                triangles.push_back(t);
            }
    for (int i = 0; i < depth; ++i) {
        std::vector<std::array<Vec3, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        triangles = finer;
    }
    std::map<std::array<long, 3>, std::uint32_t> number;
    hex::PolygonSoup soup;
    for (const auto& t : triangles) {
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::array<long, 3> key = {std::lround(1e6 * t[i].x()), std::lround(1e6 * t[i].y()),
                                             std::lround(1e6 * t[i].z())};
            const auto [found, fresh] = number.emplace(key, static_cast<std::uint32_t>(soup.points.size()));
            if (fresh) soup.points.push_back(t[i]);
            corners[i] = found->second;
        }
        soup.add_polygon(corners);
    }
    return soup;
}

/// Distance of a point to a triangle surface by trying every triangle.
double distance_to(const hex::PolygonSoup& soup, const Vec3& p) {
    double best = 1e300;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto t = soup.polygon(f);
        const Vec3 &a = soup.points[t[0]], &b = soup.points[t[1]], &c = soup.points[t[2]];
        const auto to_segment = [&](const Vec3& q, const Vec3& r) {
            const double s = std::clamp((p - q).dot(r - q) / (r - q).squaredNorm(), 0.0, 1.0);
            return (q + s * (r - q) - p).norm();
        };
        best = std::min({best, to_segment(a, b), to_segment(b, c), to_segment(c, a)});
        const Vec3 n = (b - a).cross(c - a).normalized();
        const Vec3 foot = p - (p - a).dot(n) * n;
        const auto inside = [&](const Vec3& q, const Vec3& r) {
            return (r - q).cross(foot - q).dot(n) >= 0.0;
        };
        if (inside(a, b) && inside(b, c) && inside(c, a)) best = std::min(best, std::abs((p - a).dot(n)));
    }
    return best;
}

/// A cube of n^3 cells blown up to a ball of radius `radius`.
hex::HexMesh ball(int n, double radius) {
    hex::HexMesh mesh = hex::test::grid(n, n, n);
    for (const hex::VertexId v : mesh.vertices()) {
        const Vec3 p = 2.0 / n * mesh.position(v) - Vec3::Ones();
        const double cube = p.cwiseAbs().maxCoeff();
        mesh.set_position(v, p.norm() > 0.0 ? Vec3(radius * cube / p.norm() * p) : p);
    }
    return mesh;
}

class OnSurface : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, OnSurface, testing::Values("smooth", "optimize"));

TEST_P(OnSurface, BoundaryVerticesComeToASphereAndStay) {
    const hex::PolygonSoup soup = sphere(3);
    const hex::TriangleMesh surface = hex::make_triangle_mesh(soup);
    const hex::HexMesh mesh = ball(5, 0.97);
    hex::ImproveOptions options = method(GetParam(), 5, 0.2);
    options.features = hex::FeatureSource::none;
    options.surface = &surface;
    const auto result = hex::improve(mesh, options);
    for (const hex::VertexId v : hex::boundary_quads(mesh).boundary_vertices)
        EXPECT_LT(distance_to(soup, result.mesh.position(v)), 1e-12) << v;
    EXPECT_EQ(result.report.after.inverted, 0u);
    EXPECT_TRUE(result.report.diagnostics.empty());
}

TEST_P(OnSurface, ASharpEdgeOfTheSurfaceHoldsItsVerticesEvenWithoutMeshFeatures) {
    const hex::PolygonSoup soup = hex::test::box_surface(5, 4, 3, 2);
    const hex::TriangleMesh surface = hex::make_triangle_mesh(soup);
    const hex::HexMesh mesh = hex::test::shaken_grid(5, 4, 3, 0.3, 1);
    hex::ImproveOptions options = method(GetParam(), 20, 0.3);
    options.features = hex::FeatureSource::none;
    options.surface = &surface;
    const auto result = hex::improve(mesh, options);
    const Vec3 top(5, 4, 3);
    for (const hex::VertexId v : mesh.vertices()) {
        for (Eigen::Index d = 0; d < 3; ++d) {
            const double before = mesh.position(v)[d];
            if (before == 0.0 || before == top[d]) {
                EXPECT_NEAR(result.mesh.position(v)[d], before, 1e-13) << v;
            }
        }
    }
    EXPECT_GT(result.report.after.mean, result.report.before.mean);
}

TEST_P(OnSurface, AVertexThatCannotComeIsReported) {
    // A surface far too large: to come to it the outer vertices of this flat plate would have to fold it.
    hex::PolygonSoup soup = hex::test::box_surface(1, 1, 1);
    for (Vec3& p : soup.points) p = 40.0 * (p - Vec3(0.5, 0.5, 0.5));
    const hex::TriangleMesh surface = hex::make_triangle_mesh(soup);
    hex::HexMesh mesh = hex::test::grid(3, 3, 1);
    for (const hex::VertexId v : mesh.vertices()) mesh.set_position(v, mesh.position(v) + Vec3(3, 15, -19));
    hex::ImproveOptions options = method(GetParam(), 0);
    options.surface = &surface;
    const auto result = hex::improve(mesh, options);
    EXPECT_EQ(result.report.after.inverted, 0u);
    ASSERT_EQ(result.report.diagnostics.size(), 1u);
    EXPECT_EQ(result.report.diagnostics[0].code, "off-surface");
    EXPECT_FALSE(result.report.diagnostics[0].ids.empty());
}

}  // namespace
