#include "support/meshes.h"

#include <hex/base/error.h>
#include <hex/map/block_numbering.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace hex {
namespace {

std::vector<int> uniform(const EdgeTable& edges, int n) {
    return std::vector<int>(edges.size(), n);
}

/// Nodes by the formula of a refined grid; all of them used, none twice in one cell.
TEST(BlockNumbering, GridHasTheNodesOfTheFineGrid) {
    for (const int n : {1, 2, 3, 8}) {
        const HexMesh blocks = test::grid(3, 2, 1);
        const EdgeTable edges = edge_table(blocks);
        const BlockNumbering numbering(blocks, edges, uniform(edges, n));
        const auto size = [n](int blocks_along) { return static_cast<std::size_t>(n * blocks_along + 1); };
        EXPECT_EQ(numbering.node_count(), size(3) * size(2) * size(1));
        EXPECT_EQ(numbering.cell_count(), 6U * static_cast<std::size_t>(n * n * n));
        const std::vector<HexCell> cells = numbering.cells();
        ASSERT_EQ(cells.size(), numbering.cell_count());
        std::set<VertexId> used;
        for (const HexCell& cell : cells) {
            EXPECT_EQ(std::set<VertexId>(cell.begin(), cell.end()).size(), 8U);
            used.insert(cell.begin(), cell.end());
        }
        EXPECT_EQ(used.size(), numbering.node_count());
        EXPECT_EQ(used.rbegin()->index() + 1, numbering.node_count());
    }
}

/// Neighbouring blocks see each other turned in every possible way, and still share every node of their face:
/// the fine mesh is manifold, consistently oriented, and has as many boundary quads as it must.
TEST(BlockNumbering, TurnedBlocksShareTheirFaces) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const HexMesh blocks = test::shuffled_grid(3, 2, 2, seed);
        const EdgeTable edges = edge_table(blocks);
        const BlockNumbering numbering(blocks, edges, uniform(edges, 3));
        ASSERT_EQ(numbering.node_count(), 10U * 7U * 7U);
        const HexMesh fine(std::vector<Vec3>(numbering.node_count(), Vec3::Zero()), numbering.cells());
        EXPECT_EQ(boundary_quads(fine).size(), 9 * boundary_quads(blocks).size());
        EXPECT_TRUE(inspect(fine).empty());
    }
}

TEST(BlockNumbering, NodesOfEdgesFacesAndBlocksAgree) {
    const HexMesh blocks = test::shuffled_grid(2, 2, 1, 7);
    const EdgeTable edges = edge_table(blocks);
    const BlockNumbering numbering(blocks, edges, uniform(edges, 4));
    for (const CellId b : blocks.cells()) {
        const std::vector<VertexId> nodes = numbering.block_nodes(b);
        ASSERT_EQ(nodes.size(), 125U);
        const std::set<VertexId> all(nodes.begin(), nodes.end());
        EXPECT_EQ(all.size(), nodes.size());
        for (std::size_t c = 0; c < 8; ++c) {
            const auto& uvw = hexahedron::corner_uvw[c];
            const int at = 4 * uvw[0] + 5 * (4 * uvw[1] + 5 * 4 * uvw[2]);
            EXPECT_EQ(nodes[static_cast<std::size_t>(at)],
                      numbering.corner_node(blocks.corner(b, static_cast<int>(c))));
        }
        for (const EdgeId e : edges.cell_edges[b.index()])
            for (const VertexId node : numbering.edge_nodes(e)) EXPECT_TRUE(all.contains(node));
    }
}

TEST(BlockNumbering, UnevenSheetsKeepTheirOwnCounts) {
    // Cut a 2 x 1 x 1 grid into 3 + 5 pieces along x, 2 along y, 4 along z.
    const HexMesh blocks = test::grid(2, 1, 1);
    const EdgeTable edges = edge_table(blocks);
    std::vector<int> segments;
    for (const auto& [a, b] : edges.vertices) {
        const Vec3 along = blocks.position(b) - blocks.position(a);
        const bool first = std::min(blocks.position(a).x(), blocks.position(b).x()) < 0.5;
        segments.push_back(along.x() != 0 ? (first ? 3 : 5) : along.y() != 0 ? 2 : 4);
    }
    const BlockNumbering numbering(blocks, edges, segments);
    EXPECT_EQ(numbering.node_count(), 9U * 3U * 5U);
    EXPECT_EQ(numbering.cell_count(), 8U * 2U * 4U);
    EXPECT_EQ(numbering.first_cell(CellId(1)), 24U);
    const HexMesh fine(std::vector<Vec3>(numbering.node_count(), Vec3::Zero()), numbering.cells());
    EXPECT_EQ(boundary_quads(fine).size(), 2U * (8 * 2 + 8 * 4 + 2 * 4));
}

TEST(BlockNumbering, UnequalParallelEdgesAreAnError) {
    const HexMesh blocks = test::grid(1, 1, 1);
    const EdgeTable edges = edge_table(blocks);
    std::vector<int> segments(edges.size(), 2);
    segments[5] = 3;
    EXPECT_THROW(BlockNumbering(blocks, edges, segments), Error);
}

TEST(BlockNumbering, BlockVerticesThatNoBlockUsesGetNoNode) {
    std::vector<Vec3> points(9, Vec3::Zero());
    HexCell cell;
    for (std::size_t c = 0; c < 8; ++c) cell[c] = VertexId(c + (c >= 3 ? 1 : 0));
    const HexMesh blocks(points, {cell});
    const EdgeTable edges = edge_table(blocks);
    const BlockNumbering numbering(blocks, edges, uniform(edges, 2));
    EXPECT_EQ(numbering.node_count(), 27U);
    EXPECT_FALSE(numbering.corner_node(VertexId(3)).valid());
}

}  // namespace
}  // namespace hex
