/// Cells that stand for a surface: manifold boundary, the surface's topology, errors with a place.

#include "support/surfaces.h"

#include <hex/base/error.h>
#include <hex/polycube/voxel.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/volume/topology.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using hex::HexMesh;
using hex::PolygonSoup;
using hex::Vec3;

/// Euler characteristic of the boundary; expects a manifold.
int boundary_euler(const HexMesh& mesh) {
    const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    const hex::EdgeTable edges = hex::edge_table(mesh);
    for (const auto& finding : hex::inspect(mesh)) EXPECT_EQ(finding.code, "components");
    const auto boundary_edges = std::count(edges.boundary.begin(), edges.boundary.end(), char{1});
    return static_cast<int>(boundary.boundary_vertices.size()) - static_cast<int>(boundary_edges) +
           static_cast<int>(boundary.size());
}

double volume(const HexMesh& mesh) {
    double sum = 0.0;
    for (const hex::CellId c : mesh.cells()) {
        const auto p = mesh.corner_positions(c);
        sum += (p[1] - p[0]).cross(p[3] - p[0]).dot(p[4] - p[0]);
    }
    return sum;
}

/// A box with its edges along the axes, cut out of nothing: grid planes lie on its faces.
TEST(Voxel, ABoxIsMetExactly) {
    hex::VoxelOptions options;
    options.cell_size = 0.4;
    const auto result =
        hex::voxel_blocks(hex::make_triangle_mesh(hex::test::box_surface(2.0, 1.1, 0.3)), options);
    EXPECT_EQ(result.report.grid, (std::array<int, 3>{5, 3, 1}));
    EXPECT_EQ(result.cells.cell_count(), 15U);
    EXPECT_NEAR(volume(result.cells), 2.0 * 1.1 * 0.3, 1e-12);
    EXPECT_GT(hex::summarize(result.cells).min, 0.999);
}

/// Walls of .2 and a floor of .15 in a grid of .5: planes lie on every flat face.
TEST(Voxel, StepsOfASectionAreMetExactly) {
    const std::vector<hex::Vec2> section = {{0, 0},     {3, 0},     {3, 2},      {2.8, 2},
                                            {2.8, 0.2}, {0.2, 0.2}, {0.2, 1.37}, {0, 1.37}};
    PolygonSoup soup = hex::test::prism(section, 1.0);
    // The caps of `prism` are fans that leave a section like this: one polygon instead.
    PolygonSoup walls;
    walls.points = soup.points;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto t = soup.polygon(f);
        if (std::all_of(t.begin(), t.end(), [](std::uint32_t v) { return v < 16; })) walls.add_polygon(t);
    }
    walls.add_polygon(std::array<std::uint32_t, 8>{7, 6, 5, 4, 3, 2, 1, 0});
    walls.add_polygon(std::array<std::uint32_t, 8>{8, 9, 10, 11, 12, 13, 14, 15});
    walls.points.resize(16);
    const hex::TriangleMesh mesh = hex::make_triangle_mesh(walls);
    hex::VoxelOptions options;
    options.cell_size = 0.5;
    const auto result = hex::voxel_blocks(mesh, options);
    EXPECT_NEAR(volume(result.cells), hex::enclosed_volume(mesh), 1e-12);
    EXPECT_EQ(boundary_euler(result.cells), 2);
}

TEST(Voxel, KeepsTheTopology) {
    const auto ball = hex::voxel_blocks(hex::make_triangle_mesh(hex::test::ball(8)));
    EXPECT_EQ(boundary_euler(ball.cells), 2);
    EXPECT_NEAR(volume(ball.cells), 4.0 / 3.0 * std::numbers::pi, 0.15);
    const auto ring = hex::voxel_blocks(hex::make_triangle_mesh(hex::test::torus(40, 16)));
    EXPECT_EQ(boundary_euler(ring.cells), 0);
    EXPECT_EQ(ring.report.euler_characteristic, 0);
    EXPECT_EQ(ring.report.surfaces, 1U);
}

/// A shell with a ball loose in it: three surfaces, whichever way they are oriented.
TEST(Voxel, NestedShellsNeedNoOrientation) {
    for (const bool inside_out : {false, true}) {
        PolygonSoup soup = hex::test::ball(10);
        hex::test::append(soup, hex::test::ball(10), 0.75, Vec3::Zero(), inside_out);
        hex::test::append(soup, hex::test::ball(6), 0.5, Vec3(0.1, 0.05, 0.0), inside_out);
        const hex::TriangleMesh mesh = hex::make_triangle_mesh(soup);
        const auto result = hex::voxel_blocks(mesh);
        EXPECT_EQ(result.report.surfaces, 3U);
        EXPECT_EQ(boundary_euler(result.cells), 6);
        EXPECT_NEAR(volume(result.cells), 4.0 / 3.0 * std::numbers::pi * (1 - 0.421875 + 0.125), 0.2);
    }
}

/// Two balls through each other are two bodies, and so is one as small as a grain.
TEST(Voxel, BodiesThatMeetAreMeshedEachByItself) {
    PolygonSoup soup = hex::test::ball(8);
    hex::test::append(soup, hex::test::ball(8), 1.0, Vec3(0.9, 0, 0));
    hex::test::append(soup, hex::test::ball(4), 1e-3, Vec3(0, 3, 0));
    const auto result = hex::voxel_blocks(hex::make_triangle_mesh(soup));
    EXPECT_EQ(result.report.bodies, 3U);
    EXPECT_EQ(result.report.surfaces, 3U);
    EXPECT_EQ(boundary_euler(result.cells), 6);
    EXPECT_NEAR(volume(result.cells), 2.0 * 4.0 / 3.0 * std::numbers::pi, 0.4);
}

/// Neither the first nor the last of three, and less than the others together.
TEST(Voxel, TheGridReportedIsThatOfTheBodyWithTheMostCells) {
    const auto box = [](double x, double y) { return hex::test::box_surface(x, y, 1.0); };
    PolygonSoup soup = box(4.0, 2.0);
    hex::test::append(soup, box(3.0, 2.0), 1.0, Vec3(0, 10, 0));
    hex::test::append(soup, box(5.0, 2.0), 1.0, Vec3(0, 20, 0));
    hex::test::append(soup, box(2.0, 2.0), 1.0, Vec3(0, 30, 0));
    hex::VoxelOptions options;
    options.cell_size = 0.5;
    const auto report = hex::voxel_blocks(hex::make_triangle_mesh(soup), options).report;
    EXPECT_EQ(report.bodies, 4U);
    EXPECT_EQ(report.grid, (std::array<int, 3>{10, 4, 2}));
}

/// However it is turned, a thin plate is one piece without holes, and a thin gap stays open.
TEST(Voxel, ThinPlatesInAnyPosition) {
    for (const double angle : {0.1, 0.5}) {
        PolygonSoup soup = hex::test::box_surface(4.0, 3.0, 0.08);
        for (Vec3& p : soup.points) p = Eigen::AngleAxisd(angle, Vec3(0.3, 1.0, 0.4).normalized()) * p;
        const auto result = hex::voxel_blocks(hex::make_triangle_mesh(soup));
        EXPECT_EQ(boundary_euler(result.cells), 2) << angle;
    }
    PolygonSoup pair = hex::test::box_surface(1.0, 1.0, 0.5);
    hex::test::append(pair, hex::test::box_surface(1.0, 1.0, 0.5), 1.0, Vec3(0, 0, 0.53));
    const auto result = hex::voxel_blocks(hex::make_triangle_mesh(pair));
    EXPECT_EQ(result.report.surfaces, 2U);
    EXPECT_EQ(boundary_euler(result.cells), 4);
}

/// A needle on a ball, far thinner than a cell, is followed to its tip.
TEST(Voxel, FollowsThinParts) {
    PolygonSoup soup = hex::test::ball(10);
    std::size_t top = 0;
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        if (soup.points[v].z() > soup.points[top].z()) top = v;
    soup.points[top] = Vec3(0, 0, 2.0);
    const auto result = hex::voxel_blocks(hex::make_triangle_mesh(soup));
    EXPECT_EQ(boundary_euler(result.cells), 2);
    EXPECT_GT(result.report.grown, 0U);
    EXPECT_GT(hex::bounding_box(result.cells).upper.z(), 2.0 - result.report.cell_size);
}

TEST(Voxel, NamesThePlaceThatNoGridResolves) {
    PolygonSoup soup = hex::test::ball(6);
    hex::test::append(soup, hex::test::ball(2), 1e-3, Vec3(0.25, 0, 0), true);
    hex::VoxelOptions options;
    options.most_cells = 8000;
    try {
        (void)hex::voxel_blocks(hex::make_triangle_mesh(soup), options);
        FAIL() << "a void of a thousandth of the size was met";
    } catch (const hex::Error& error) {
        EXPECT_EQ(error.kind(), hex::ErrorKind::no_result);
        EXPECT_NE(error.where().find("(0.25, "), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("thinner"), std::string::npos) << error.what();
    }
}

TEST(Voxel, RefusesNonsense) {
    const hex::TriangleMesh box = hex::make_triangle_mesh(hex::test::box_surface(1, 1, 1));
    hex::VoxelOptions options;
    options.cell_size = -1.0;
    EXPECT_THROW((void)hex::voxel_blocks(box, options), hex::Error);
    options = {};
    options.target_cells = 0;
    EXPECT_THROW((void)hex::voxel_blocks(box, options), hex::Error);
    EXPECT_THROW((void)hex::voxel_blocks(hex::TriangleMesh()), hex::Error);
    EXPECT_THROW((void)hex::voxel_blocks(hex::make_triangle_mesh(hex::test::box_surface(1, 1, 0))),
                 hex::Error);
}

}  // namespace
