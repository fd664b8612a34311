#include "support/meshes.h"

#include <hex/quality/mesh_defects.h>

#include <gtest/gtest.h>

namespace hex {
namespace {

HexMesh with_moved_copy(const Vec3& by, double gap = 0.0) {
    const HexMesh one = test::grid(2, 1, 1);
    std::vector<Vec3> points(one.positions().begin(), one.positions().end());
    std::vector<HexCell> cells(one.cell_array().begin(), one.cell_array().end());
    const std::size_t vertices = points.size(), count = cells.size();
    for (std::size_t v = 0; v < vertices; ++v) points.push_back(points[v] + by + Vec3(gap, 0, 0));
    for (std::size_t c = 0; c < count; ++c) {
        HexCell cell = cells[c];
        for (VertexId& v : cell) v = VertexId(v.index() + vertices);
        cells.push_back(cell);
    }
    return {points, cells};
}

TEST(MeshDefects, AGridHasNone) {
    const MeshDefects defects = find_defects(test::shuffled_grid(4, 3, 5, 1));
    EXPECT_TRUE(defects.watertight());
    EXPECT_TRUE(defects.unused.empty());
    EXPECT_TRUE(defects.duplicates.empty());
    EXPECT_TRUE(defects.pinched.empty());
    EXPECT_FALSE(defects.several_components);
}

TEST(MeshDefects, NeighboursThatShareNoNodesMakeACrack) {
    const MeshDefects defects = find_defects(with_moved_copy({2, 0, 0}));
    EXPECT_EQ(defects.duplicates.size(), 4U);
    ASSERT_EQ(defects.cracks.size(), 1U);
    EXPECT_EQ(HexMesh::cell_of(defects.cracks[0][0]), CellId(1));
    EXPECT_EQ(HexMesh::cell_of(defects.cracks[0][1]), CellId(2));
    EXPECT_TRUE(defects.open_edges.empty());
    EXPECT_FALSE(defects.watertight());
    EXPECT_TRUE(defects.several_components);
}

TEST(MeshDefects, NodesAreTheSameWithinTheTolerance) {
    EXPECT_EQ(find_defects(with_moved_copy({2, 0, 0}, 1e-6)).duplicates.size(), 0U);
    EXPECT_EQ(find_defects(with_moved_copy({2, 0, 0}, 1e-6), 1e-5).duplicates.size(), 4U);
    EXPECT_EQ(find_defects(with_moved_copy({2, 0, 0}), 0.0).duplicates.size(), 4U);
    EXPECT_EQ(find_defects(with_moved_copy({2, 0, 0}, 1e-9), 0.0).duplicates.size(), 0U);
}

TEST(MeshDefects, AllNodesWithinTheToleranceAreOnePlace) {
    EXPECT_EQ(find_defects(test::grid(3, 3, 3), 1.0).duplicates.size(), 63U);
}

TEST(MeshDefects, CubesThatShareOnlyAnEdgeLeaveItOpen) {
    const HexMesh grid = test::grid(2, 2, 1);
    const std::vector<Vec3> points(grid.positions().begin(), grid.positions().end());
    const HexMesh diagonal(points, {grid.cell(CellId(0)), grid.cell(CellId(3))});
    const MeshDefects defects = find_defects(diagonal);
    ASSERT_EQ(defects.open_edges.size(), 1U);
    EXPECT_EQ(defects.open_edges[0], (std::array{VertexId(4), VertexId(13)}));
    EXPECT_FALSE(defects.watertight());
    EXPECT_EQ(defects.pinched.size(), 2U);
    EXPECT_EQ(defects.unused.size(), 4U);
}

}  // namespace
}  // namespace hex
