#include "improve/improve_cases.h"

#include <gtest/gtest.h>

#include <set>

namespace {

using hex::test::method;
using hex::test::shaken_grid;

TEST(Pillow, AddsOneHexahedronForEachBoundaryQuad) {
    const hex::HexMesh mesh = hex::test::grid(3, 4, 5);
    const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    const auto result = hex::improve(mesh, method("pillow", 1));
    ASSERT_EQ(result.mesh.cell_count(), mesh.cell_count() + boundary.size());
    ASSERT_EQ(result.mesh.vertex_count(), mesh.vertex_count() + boundary.boundary_vertices.size());
    for (const hex::CellId c : mesh.cells()) EXPECT_EQ(result.mesh.cell(c), mesh.cell(c));
    for (std::size_t q = 0; q < boundary.size(); ++q) {
        const hex::HexCell& cell = result.mesh.cell(hex::CellId(mesh.cell_count() + q));
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(cell[i], boundary.vertices[q][i]);
    }
}

TEST(Pillow, PutsNewVerticesAtTheOldPlacesInOrder) {
    const hex::HexMesh mesh = shaken_grid(4, 4, 4, 0.25, 1);
    const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    const auto result = hex::improve(mesh, method("pillow", 1));
    for (std::size_t i = 0; i < boundary.boundary_vertices.size(); ++i) {
        const hex::VertexId fresh(mesh.vertex_count() + i);
        EXPECT_EQ(result.mesh.position(fresh), mesh.position(boundary.boundary_vertices[i]));
    }
    for (const hex::VertexId v : mesh.vertices()) {
        if (!boundary.contains(v)) {
            EXPECT_EQ(result.mesh.position(v), mesh.position(v));
        }
    }
}

TEST(Pillow, LeavesNoElementWithTwoFacesOnTheBoundary) {
    const auto result = hex::improve(hex::test::grid(3, 3, 3), method("pillow", 1));
    for (const hex::CellId c : result.mesh.cells()) {
        int faces = 0;
        for (int f = 0; f < 6; ++f) faces += result.mesh.is_boundary(hex::HexMesh::half_face(c, f));
        EXPECT_LE(faces, 1) << c;
    }
}

TEST(Pillow, IsAFifthOfTheShortestBoundaryEdgeThickOnAFlatSide) {
    const auto result = hex::improve(hex::test::grid(4, 4, 4), method("pillow", 1));
    // Vertex (2, 2, 4) is in the middle of the top of 4 x 4 x 4 unit cubes.
    const hex::VertexId v(2 + 5 * (2 + 5 * 4));
    EXPECT_NEAR((result.mesh.position(v) - hex::Vec3(2, 2, 3.8)).norm(), 0.0, 1e-14);
}

TEST(Pillow, InvertsNothing) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const hex::HexMesh mesh = shaken_grid(5, 4, 3, 0.33, seed);
        const auto result = hex::improve(mesh, method("pillow", 1));
        const std::vector<double> before = hex::scaled_jacobians(mesh);
        const std::vector<double> after = hex::scaled_jacobians(result.mesh);
        for (std::size_t c = 0; c < after.size(); ++c) {
            if (c < before.size() && before[c] <= 0.0) continue;
            EXPECT_GT(after[c], 0.0) << "seed " << seed << ", cell " << c;
        }
    }
}

TEST(Pillow, ThinsTheLayerOfAPlateThatIsThinnerThanTheLayers) {
    // Edges of length 1 along the plate would make layers of 0.2 on both sides of a plate 0.1 thick.
    hex::HexMesh mesh = hex::test::grid(6, 6, 1);
    for (const hex::VertexId v : mesh.vertices()) {
        hex::Vec3 p = mesh.position(v);
        p.z() *= 0.1;
        mesh.set_position(v, p);
    }
    const auto result = hex::improve(mesh, method("pillow", 1));
    EXPECT_EQ(result.report.after.inverted, 0u);
    EXPECT_GT(result.report.after.min, 0.1);
    EXPECT_TRUE(result.report.diagnostics.empty());
}

TEST(Pillow, RepeatsLayers) {
    const hex::HexMesh mesh = hex::test::grid(3, 3, 3);
    const auto result = hex::improve(mesh, method("pillow", 3));
    EXPECT_EQ(result.mesh.cell_count(), 27u + 3u * 54u);
    EXPECT_EQ(result.report.after.inverted, 0u);
    ASSERT_EQ(result.report.history.size(), 3u);
    EXPECT_EQ(result.report.history[2].sweep, 3);
    // The layers lie one inside the other: no two vertices share a place.
    std::set<std::array<double, 3>> places;
    for (const hex::Vec3& p : result.mesh.positions()) places.insert({p.x(), p.y(), p.z()});
    EXPECT_EQ(places.size(), result.mesh.vertex_count());
}

TEST(Pillow, HandsPartIdsOn) {
    const hex::HexMesh plain = hex::test::grid(2, 1, 1);
    const hex::HexMesh mesh({plain.positions().begin(), plain.positions().end()},
                            {plain.cell_array().begin(), plain.cell_array().end()}, {7, 9});
    const auto result = hex::improve(mesh, method("pillow", 1));
    for (const hex::CellId c : result.mesh.cells()) {
        if (c.index() < 2) continue;
        const hex::CellId owner = result.mesh.neighbour(c, 0);
        EXPECT_EQ(result.mesh.part(c), mesh.part(owner));
    }
}

TEST(Pillow, GivesTheSameBytesForAnyNumberOfThreads) {
    const hex::HexMesh mesh = shaken_grid(6, 6, 2, 0.4, 3);
    const auto one = hex::improve(mesh, method("pillow", 2), hex::test::with_thread_count(1));
    const auto two = hex::improve(mesh, method("pillow", 2), hex::test::with_thread_count(2));
    EXPECT_TRUE(hex::test::identical(one.mesh, two.mesh));
}

}  // namespace
