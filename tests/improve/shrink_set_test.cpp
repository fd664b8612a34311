/// Layers around some elements only.

#include "improve/shrink_set.h"

#include "improve/improve_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace {

using hex::HexMesh;
using hex::Vec3;
using hex::VertexId;
namespace improving = hex::improving;

/// Half a cylinder along y: the two upper edges of the grid lie on its round side, all others are sharp.
HexMesh half_cylinder(int nx, int ny, int nz) {
    HexMesh mesh = hex::test::grid(nx, ny, nz);
    for (const VertexId v : mesh.vertices()) {
        const Vec3 p = mesh.position(v);
        const Vec3 flat(2.0 * p.x() / nx - 1.0, 0.0, p.z() / nz);
        const double length = flat.norm();
        const double share = length > 0.0 ? flat.cwiseAbs().maxCoeff() / length : 1.0;
        mesh.set_position(v, {share * flat.x(), p.y() / ny, share * flat.z()});
    }
    return mesh;
}

std::ptrdiff_t count(const std::vector<char>& flags) {
    return std::count(flags.begin(), flags.end(), char{1});
}

/// Edges of the quads that are not in two of them.
std::size_t pinches(const hex::BoundaryQuads& quads) {
    std::map<std::pair<VertexId, VertexId>, int> edges;
    for (const auto& quad : quads.vertices)
        for (std::size_t i = 0; i < 4; ++i) ++edges[std::minmax(quad[i], quad[(i + 1) % 4])];
    std::size_t bad = 0;
    for (const auto& [edge, number] : edges) bad += number != 2;
    return bad;
}

TEST(LocalPillow, TakesTheFlatEdgesAwayAndLeavesTheRest) {
    const HexMesh mesh = half_cylinder(4, 6, 4);
    constexpr double cosine = 0.6;
    const std::vector<char> flat = improving::cells_with_flat_edges(mesh, cosine);
    ASSERT_EQ(count(flat), 12);
    hex::ImproveOptions options = hex::test::method("pillow");
    options.local_layer = true;
    options.feature_cosine = cosine;
    const auto result = hex::improve(mesh, options);
    // Two rows of six cells have 4 x 6 + 2 faces each.
    EXPECT_EQ(result.mesh.cell_count(), mesh.cell_count() + 52);
    EXPECT_EQ(result.report.after.inverted, 0U);
    EXPECT_EQ(count(improving::cells_with_flat_edges(result.mesh, cosine)), 0);
    EXPECT_EQ(pinches(hex::boundary_quads(result.mesh)), 0U);
    EXPECT_EQ(hex::boundary_quads(result.mesh).size(), hex::boundary_quads(mesh).size());
    // Cells of the same place are the same where no layer is.
    std::size_t moved = 0;
    for (const hex::CellId c : mesh.cells())
        moved += mesh.corner_positions(c) != result.mesh.corner_positions(c);
    EXPECT_EQ(moved, 12U);
}

TEST(LocalPillow, DoesNothingWhereEveryEdgeIsSharp) {
    hex::ImproveOptions options = hex::test::method("pillow", 3);
    options.local_layer = true;
    const HexMesh mesh = hex::test::grid(3, 3, 3);
    EXPECT_TRUE(hex::test::identical(hex::improve(mesh, options).mesh, mesh));
}

TEST(ShrinkSet, GrowsUntilNothingIsPinched) {
    const HexMesh mesh = hex::test::grid(4, 4, 4);
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 random(seed);
        std::vector<char> flagged(mesh.cell_count(), 0);
        for (char& flag : flagged) flag = random() % 8 == 0;
        const std::vector<char> before = flagged;
        improving::grow_to_manifold(mesh, flagged);
        for (std::size_t c = 0; c < flagged.size(); ++c) EXPECT_GE(flagged[c], before[c]);
        EXPECT_EQ(pinches(improving::faces_around(mesh, flagged)), 0U) << seed;
    }
}

TEST(ShrinkSet, OneCellNeedsNoNeighbour) {
    const HexMesh mesh = hex::test::grid(3, 3, 3);
    for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
        std::vector<char> flagged(mesh.cell_count(), 0);
        flagged[c] = 1;
        improving::grow_to_manifold(mesh, flagged);
        EXPECT_EQ(count(flagged), 1);
        EXPECT_EQ(improving::faces_around(mesh, flagged).size(), 6U);
    }
}

TEST(ShrinkSet, AllCellsHaveTheBoundaryOfTheMesh) {
    const HexMesh mesh = hex::test::shuffled_grid(3, 4, 5, 2);
    const hex::BoundaryQuads whole = hex::boundary_quads(mesh);
    const hex::BoundaryQuads faces = improving::faces_around(mesh, std::vector<char>(mesh.cell_count(), 1));
    EXPECT_EQ(faces.half_faces, whole.half_faces);
    EXPECT_EQ(faces.vertices, whole.vertices);
    EXPECT_EQ(faces.boundary_vertices, whole.boundary_vertices);
    EXPECT_EQ(faces.on_boundary, whole.on_boundary);
    EXPECT_EQ(faces.vertex_quads.values, whole.vertex_quads.values);
    EXPECT_EQ(faces.vertex_quads.offsets, whole.vertex_quads.offsets);
}

}  // namespace
