/// Method `snap`: onto the surface, and never through an inverted element.

#include "improve/improve_cases.h"
#include "support/surfaces.h"

#include <hex/base/error.h>
#include <hex/polycube/voxel.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using hex::HexMesh;
using hex::Vec3;
using hex::VertexId;

hex::ImproveOptions snap_to(const hex::TriangleMesh& surface) {
    hex::ImproveOptions options;
    options.method = "snap";
    options.surface = &surface;
    return options;
}

/// Cells for a surface, coarse.
HexMesh cells_for(const hex::TriangleMesh& surface, std::size_t count = 1200) {
    hex::VoxelOptions options;
    options.target_cells = count;
    options.cell_size = 0.2;
    return hex::voxel_blocks(surface, options).cells;
}

double hexahedron_volume(const HexMesh& mesh, hex::CellId c) {
    const auto p = mesh.corner_positions(c);
    return ((p[6] - p[0])
                .dot((p[1] - p[0]).cross(p[2] - p[5]) + (p[4] - p[0]).cross(p[5] - p[7]) +
                     (p[3] - p[0]).cross(p[7] - p[2]))) /
           6.0;
}

TEST(Snap, ABallBecomesRound) {
    const hex::TriangleMesh ball = hex::make_triangle_mesh(hex::test::ball(16));
    const auto result = hex::improve(cells_for(ball), snap_to(ball));
    EXPECT_GT(result.report.after.min, 0.3);
    double farthest = 0.0;
    for (const VertexId v : hex::boundary_quads(result.mesh).boundary_vertices)
        farthest = std::max(farthest, std::abs(result.mesh.position(v).norm() - 1.0));
    EXPECT_LT(farthest, 0.01);  // what the triangles cut off
}

/// Edges and corners along the axes are met, whichever way the surface is oriented.
TEST(Snap, ABoxKeepsItsEdges) {
    for (const bool inside_out : {false, true}) {
        hex::PolygonSoup soup = hex::test::box_surface(1.0, 1.3, 0.7, 3);
        if (inside_out) {
            for (std::size_t f = 0; f < soup.size(); ++f)
                std::swap(soup.corners[soup.offsets[f]], soup.corners[soup.offsets[f] + 1]);
        }
        const hex::TriangleMesh box = hex::make_triangle_mesh(soup);
        HexMesh cells = cells_for(box);
        for (const VertexId v : cells.vertices()) cells.set_position(v, 1.03 * cells.position(v));
        const auto result = hex::improve(cells, snap_to(box));
        EXPECT_GT(result.report.after.min, 0.4);
        double volume = 0.0;
        for (const hex::CellId c : result.mesh.cells()) volume += hexahedron_volume(result.mesh, c);
        EXPECT_NEAR(volume, 1.0 * 1.3 * 0.7, 0.002);
    }
}

TEST(Snap, NothingIsInvertedOnTheWay) {
    const hex::TriangleMesh ring = hex::make_triangle_mesh(hex::test::torus(40, 16));
    hex::VoxelOptions voxels;
    voxels.cell_size = 0.5;
    const auto report = hex::improve(hex::voxel_blocks(ring, voxels).cells, snap_to(ring)).report;
    ASSERT_GE(report.history.size(), 10U);
    for (const auto& record : report.history) {
        EXPECT_EQ(record.inverted, 0U) << record.sweep;
        EXPECT_GT(record.min, 0.0) << record.sweep;
    }
    EXPECT_GT(report.after.min, 0.2);
}

/// Two walls closer to each other than a cell: each side finds its own.
TEST(Snap, SidesOfAThinPlateStayApart) {
    const Vec3 sides(2.0, 2.0, 0.05);
    const Eigen::AngleAxisd turn(0.4, Vec3(0.2, 1.0, 0.1).normalized());
    hex::PolygonSoup soup = hex::test::box_surface(sides.x(), sides.y(), sides.z(), 4);
    for (Vec3& p : soup.points) p = turn * p;
    const auto distance_to_plate = [&](const Vec3& p) {
        const Vec3 q = turn.inverse() * p;
        const Vec3 nearest = q.cwiseMax(Vec3::Zero()).cwiseMin(sides);
        const double inside = std::min(nearest.minCoeff(), (sides - nearest).minCoeff());
        return std::max((q - nearest).norm(), inside);
    };
    const hex::TriangleMesh plate = hex::make_triangle_mesh(soup);
    const auto result = hex::improve(cells_for(plate), snap_to(plate));
    EXPECT_EQ(result.report.after.inverted, 0U);
    double volume = 0.0;
    for (const hex::CellId c : result.mesh.cells()) volume += hexahedron_volume(result.mesh, c);
    EXPECT_NEAR(volume, 2.0 * 2.0 * 0.05, 0.006);  // 3 %
    for (const VertexId v : hex::boundary_quads(result.mesh).boundary_vertices)
        EXPECT_LT(distance_to_plate(result.mesh.position(v)), 0.01);
}

TEST(Snap, SameBytesForAnyNumberOfThreads) {
    const hex::TriangleMesh ball = hex::make_triangle_mesh(hex::test::ball(8));
    const HexMesh cells = cells_for(ball);
    const auto one = hex::improve(cells, snap_to(ball), hex::test::with_thread_count(1));
    const auto two = hex::improve(cells, snap_to(ball), hex::test::with_thread_count(2));
    EXPECT_TRUE(hex::test::identical(one.mesh, two.mesh));
}

TEST(Snap, NeedsASurfaceAndAValidMesh) {
    EXPECT_THROW((void)hex::improve(hex::test::grid(2, 2, 2), hex::test::method("snap")), hex::Error);
    const hex::TriangleMesh box = hex::make_triangle_mesh(hex::test::box_surface(2, 2, 2));
    HexMesh folded = hex::test::grid(2, 2, 2);
    folded.set_position(VertexId(13), Vec3(-1, -1, -1));
    try {
        (void)hex::improve(folded, snap_to(box));
        FAIL();
    } catch (const hex::Error& error) {
        EXPECT_EQ(error.kind(), hex::ErrorKind::bad_input);
    }
}

}  // namespace
