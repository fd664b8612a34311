#include "support/meshes.h"

#include <hex/base/error.h>
#include <hex/feature/feature_set.h>
#include <hex/surface/polygon_soup.h>
#include <spline/spline.h>
#include <spline/surface_features.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace spline::test {
namespace {

using hex::Vec3;

hex::TriangleMesh box(double x, double y, double z, int n = 1) {
    return hex::make_triangle_mesh(hex::test::box_surface(x, y, z, n));
}

/// The edges that the angle between boundary quads makes sharp.
std::vector<VertexPair> sharp_by_angle(const hex::HexMesh& mesh) {
    const hex::EdgeTable edges = hex::edge_table(mesh);
    const auto features = hex::features_by_angle(mesh, edges, hex::boundary_quads(mesh), 0.8);
    std::vector<VertexPair> pairs;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (features.sharp_edge[e] != 0)
            pairs.push_back({edges.vertices[e][0].value(), edges.vertices[e][1].value()});
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// A polygon of n corners at the bottom, a smaller one above it, and sides at 45 degrees.
hex::TriangleMesh frustum(int n, double height) {
    hex::PolygonSoup soup;
    std::vector<std::uint32_t> bottom, top;
    for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / n;
        const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
        const double inner = 1.0 - height / std::cos(std::numbers::pi / n);
        soup.points.push_back(out);
        soup.points.push_back(inner * out + height * Vec3::UnitZ());
        bottom.insert(bottom.begin(), static_cast<std::uint32_t>(2 * i));
        top.push_back(static_cast<std::uint32_t>(2 * i + 1));
    }
    soup.add_polygon(bottom);
    soup.add_polygon(top);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
        const std::uint32_t next = (i + 1) % static_cast<std::uint32_t>(n);
        soup.add_polygon(std::array<std::uint32_t, 4>{2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
    }
    return hex::make_triangle_mesh(soup);
}

TEST(SurfaceFeatures, EdgesOfABox) {
    EXPECT_EQ(sharp_segments(box(3, 4, 5), 0.8).size(), 12U);
    EXPECT_EQ(sharp_segments(box(3, 4, 5, 3), 0.8).size(), 36U);
    const hex::HexMesh mesh = hex::test::shuffled_grid(3, 4, 5, 1);
    EXPECT_EQ(sharp_by_angle(mesh).size(), 48U);
    EXPECT_EQ(edges_along(mesh, sharp_segments(box(3, 4, 5), 0.8)), sharp_by_angle(mesh));
    EXPECT_EQ(edges_between_patches(mesh, box(3, 4, 5)), sharp_by_angle(mesh));
    EXPECT_TRUE(edges_along(mesh, {}).empty());
    EXPECT_TRUE(edges_along(mesh, sharp_segments(box(9, 9, 9), 0.8)).size() == 12U)
        << "three edges at the one corner that both boxes have, as far as the mesh goes";
}

TEST(SurfaceFeatures, WeakEdgesJoinCorners) {
    // Sides of a heptagon at 45 degrees meet at 35.7 degrees: not below 0.8, but from corner to corner.
    EXPECT_EQ(sharp_segments(frustum(7, 0.2), 0.8).size(), 21U);
    // Those of a polygon with twenty sides are flat parts of a cone.
    EXPECT_EQ(sharp_segments(frustum(20, 0.2), 0.8).size(), 40U);
}

TEST(SurfaceFeatures, ShortRidgesAreNoise) {
    // A ridge of two edges on the upper side; both its ends are open.
    hex::PolygonSoup soup = hex::test::box_surface(4, 4, 4, 8);
    for (Vec3& p : soup.points)
        if (p.x() == 2.0 && std::abs(p.y() - 2.0) < 0.6 && p.z() == 4.0) p.z() = 4.22;
    const hex::TriangleMesh ridge = hex::make_triangle_mesh(soup);
    EXPECT_EQ(sharp_segments(ridge, 0.8).size(), 96U);
    EXPECT_GT(sharp_segments(ridge, 0.95).size(), 96U) << "its foot is a closed line";
}

TEST(SurfaceFeatures, OnlyOneSideOfAThinRowIsSharp) {
    hex::HexMesh mesh = hex::test::grid(4, 4, 4);
    for (const hex::VertexId v : mesh.vertices()) {
        Vec3 p = mesh.position(v);
        if (p.x() == 1.0) p.x() = 0.1;
        mesh.set_position(v, p);
    }
    EXPECT_EQ(edges_along(mesh, sharp_segments(box(4, 4, 4), 0.8)), sharp_by_angle(mesh));
}

TEST(SurfaceFeatures, BordersOfParts) {
    const hex::HexMesh grid = hex::test::grid(4, 2, 2);
    std::vector<int> parts;
    for (const hex::CellId c : grid.cells()) parts.push_back(c.index() % 4 < 2 ? 1 : 7);
    const hex::HexMesh mesh({grid.positions().begin(), grid.positions().end()},
                            {grid.cell_array().begin(), grid.cell_array().end()}, parts);
    const auto edges = edges_between_parts(mesh);
    EXPECT_EQ(edges.size(), 8U) << "around the middle";
    for (const auto& edge : edges)
        for (const std::int64_t v : edge) EXPECT_EQ(v % 5, 2);
    EXPECT_TRUE(edges_between_parts(grid).empty());
}

TEST(SurfaceFeatures, TheSplineHasThem) {
    const hex::HexMesh mesh = hex::test::grid(3, 3, 3);
    SplineOptions by_angle, by_edges;
    by_angle.features = hex::FeatureSource::angle;
    by_edges.feature_edges = edges_along(mesh, sharp_segments(box(3, 3, 3), 0.8));
    EXPECT_EQ(build(mesh, by_edges).spline.rows.values, build(mesh, by_angle).spline.rows.values);
    by_edges.feature_edges = {{0, 5}};
    EXPECT_THROW(build(mesh, by_edges), hex::Error) << "no edge";
    by_edges.feature_edges = {{0, 64}};
    EXPECT_THROW(build(mesh, by_edges), hex::Error) << "no vertex";
}

}  // namespace
}  // namespace spline::test
