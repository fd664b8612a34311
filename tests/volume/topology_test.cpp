#include "support/meshes.h"

#include <hex/base/parallel.h>
#include <hex/volume/topology.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace hex {
namespace {

std::vector<std::int64_t> ids_of(const Diagnostics& diagnostics, const std::string& code) {
    for (const Diagnostic& d : diagnostics) {
        if (d.code == code) return d.ids;
    }
    return {};
}

HexMesh mesh_of(std::size_t vertex_count, const std::vector<std::array<std::size_t, 8>>& ids) {
    std::vector<HexCell> cells;
    for (const auto& row : ids) {
        HexCell cell;
        std::transform(row.begin(), row.end(), cell.begin(), [](std::size_t v) { return VertexId(v); });
        cells.push_back(cell);
    }
    return {std::vector<Vec3>(vertex_count, Vec3::Zero()), std::move(cells)};
}

TEST(VertexCells, ListExactlyTheCellsOfEachVertexInAscendingOrder) {
    const HexMesh mesh = test::shuffled_grid(4, 3, 2, 5);
    const auto stars = vertex_cells(mesh);
    ASSERT_EQ(stars.size(), mesh.vertex_count());
    for (const VertexId v : mesh.vertices()) {
        std::vector<CellId> expected;
        for (const CellId c : mesh.cells()) {
            if (std::count(mesh.cell(c).begin(), mesh.cell(c).end(), v) > 0) expected.push_back(c);
        }
        const auto star = stars[v.index()];
        EXPECT_EQ(std::vector<CellId>(star.begin(), star.end()), expected);
    }
}

TEST(BoundaryQuads, OfAGridFormItsClosedBoxAndLookOutwards) {
    const HexMesh mesh = test::grid(3, 4, 5);
    const BoundaryQuads boundary = boundary_quads(mesh);
    EXPECT_EQ(boundary.size(), 2u * (12 + 20 + 15));
    EXPECT_EQ(boundary.boundary_vertices.size(), 4u * 5 * 6 - 2u * 3 * 4);
    std::map<std::pair<VertexId, VertexId>, int> directed;
    double volume = 0;
    for (std::size_t q = 0; q < boundary.size(); ++q) {
        const auto& v = boundary.vertices[q];
        for (std::size_t i = 0; i < 4; ++i) ++directed[{v[i], v[(i + 1) % 4]}];
        const Vec3 a = mesh.position(v[0]), b = mesh.position(v[1]), c = mesh.position(v[2]);
        volume += a.dot((b - a).cross(c - a)) / 3.0;
        EXPECT_EQ(boundary.quad_of_half_face[boundary.half_faces[q].index()], QuadId(q));
        EXPECT_EQ(mesh.face_vertices(boundary.half_faces[q]), v);
    }
    EXPECT_NEAR(volume, 60.0, 1e-12);
    for (const auto& [edge, count] : directed) {
        EXPECT_EQ(count, 1);
        EXPECT_TRUE(directed.contains({edge.second, edge.first}));
    }
}

TEST(BoundaryQuads, VertexRowsAreAscendingAndEmptyInside) {
    const HexMesh mesh = test::grid(3, 3, 3);
    const BoundaryQuads boundary = boundary_quads(mesh);
    for (const VertexId v : mesh.vertices()) {
        const auto row = boundary.vertex_quads[v.index()];
        EXPECT_EQ(row.empty(), !boundary.contains(v));
        EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
        for (const QuadId q : row) {
            const auto& corners = boundary.vertices[q.index()];
            EXPECT_EQ(std::count(corners.begin(), corners.end(), v), 1);
        }
    }
    EXPECT_EQ(boundary.boundary_vertices.size(), 64u - 8u);
}

TEST(EdgeTable, OfAGridHasTheKnownCountsAndValences) {
    const HexMesh mesh = test::grid(2, 3, 4);
    const EdgeTable edges = edge_table(mesh);
    EXPECT_EQ(edges.size(), 2u * 4 * 5 + 3u * 3 * 5 + 4u * 3 * 4);
    std::map<std::size_t, int> valences;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        ++valences[edges.cells[e].size()];
        EXPECT_FALSE(edges.is_extraordinary(EdgeId(e)));
        EXPECT_EQ(edges.cells[e].size() == 4, edges.boundary[e] == 0);
    }
    EXPECT_EQ(valences[1], 4 * (2 + 3 + 4));  // the edges of the box
    EXPECT_EQ(valences[4], 2 * 2 * 3 + 3 * 1 * 3 + 4 * 1 * 2);
}

TEST(EdgeTable, EdgesAreUniqueOrderedAndKnownToTheirCells) {
    const HexMesh mesh = test::shuffled_grid(4, 4, 3, 21);
    const EdgeTable edges = edge_table(mesh);
    EXPECT_TRUE(std::is_sorted(edges.vertices.begin(), edges.vertices.end()));
    EXPECT_EQ(std::adjacent_find(edges.vertices.begin(), edges.vertices.end()), edges.vertices.end());
    std::vector<std::size_t> uses(edges.size(), 0);
    for (const CellId c : mesh.cells()) {
        for (std::size_t e = 0; e < 12; ++e) {
            const EdgeId id = edges.cell_edges[c.index()][e];
            VertexId a = mesh.corner(c, hexahedron::edge_corners[e][0]);
            VertexId b = mesh.corner(c, hexahedron::edge_corners[e][1]);
            EXPECT_EQ(edges.find(a, b), id);
            EXPECT_EQ(edges.find(b, a), id);
            EXPECT_EQ(edges.other(id, a), b);
            const auto around = edges.cells[id.index()];
            EXPECT_TRUE(std::binary_search(around.begin(), around.end(), c));
            ++uses[id.index()];
        }
    }
    for (std::size_t e = 0; e < edges.size(); ++e) EXPECT_EQ(uses[e], edges.cells[e].size());
    EXPECT_FALSE(edges.find(VertexId(0), VertexId(mesh.vertex_count() - 1)).valid());
}

TEST(EdgeTable, VertexEdgesHoldEachEdgeAtBothEnds) {
    const HexMesh mesh = test::fan(5, 2);
    const EdgeTable edges = edge_table(mesh);
    EXPECT_EQ(edges.vertex_edges.values.size(), 2 * edges.size());
    for (const VertexId v : mesh.vertices()) {
        for (const EdgeId e : edges.vertex_edges[v.index()])
            EXPECT_TRUE(edges.vertices[e.index()][0] == v || edges.vertices[e.index()][1] == v);
    }
}

class Fan : public testing::TestWithParam<int> {};

TEST_P(Fan, HasItsMiddleEdgesAndOnlyThemExtraordinary) {
    const int valence = GetParam(), layers = 3;
    const HexMesh mesh = test::fan(valence, layers);
    const EdgeTable edges = edge_table(mesh);
    std::size_t extraordinary = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges.boundary[e] != 0) continue;
        EXPECT_EQ(edges.is_extraordinary(EdgeId(e)), edges.cells[e].size() != 4);
        const auto& ends = edges.vertices[e];
        const bool middle = mesh.position(ends[0]).head<2>().norm() < 1e-12 &&
                            mesh.position(ends[1]).head<2>().norm() < 1e-12;
        EXPECT_EQ(edges.is_extraordinary(EdgeId(e)), middle && valence != 4);
        if (middle) {
            EXPECT_EQ(edges.cells[e].size(), static_cast<std::size_t>(valence));
        }
        extraordinary += edges.is_extraordinary(EdgeId(e));
    }
    EXPECT_EQ(extraordinary, valence == 4 ? 0u : static_cast<std::size_t>(layers));
    EXPECT_TRUE(inspect(mesh).empty());
}

INSTANTIATE_TEST_SUITE_P(valence, Fan, testing::Values(3, 4, 5, 6));

TEST(Topology, IsTheSameForAnyNumberOfThreads) {
    const HexMesh mesh = test::shuffled_grid(15, 14, 13, 2);
    const auto edges = [&](int threads) {
        Context context;
        context.threads = threads;
        return with_threads(context, [&] { return edge_table(mesh); });
    };
    const EdgeTable one = edges(1), many = edges(4);
    EXPECT_EQ(one.vertices, many.vertices);
    EXPECT_EQ(one.cell_edges, many.cell_edges);
    EXPECT_EQ(one.cells.offsets, many.cells.offsets);
    EXPECT_EQ(one.cells.values, many.cells.values);
    EXPECT_EQ(one.boundary, many.boundary);
}

TEST(Topology, OfAnEmptyMeshIsEmpty) {
    const HexMesh mesh;
    EXPECT_EQ(edge_table(mesh).size(), 0u);
    EXPECT_EQ(boundary_quads(mesh).size(), 0u);
    EXPECT_EQ(vertex_cells(mesh).size(), 0u);
    EXPECT_TRUE(inspect(mesh).empty());
}

TEST(Inspect, FindsNothingInAGrid) {
    EXPECT_TRUE(inspect(test::shuffled_grid(4, 4, 4, 1)).empty());
}

TEST(Inspect, NamesVerticesThatNoCellUses) {
    const HexMesh mesh = mesh_of(10, {{0, 1, 2, 3, 4, 5, 6, 8}});
    EXPECT_EQ(ids_of(inspect(mesh), "unused-vertices"), (std::vector<std::int64_t>{7, 9}));
}

TEST(Inspect, NamesAVertexWhereTwoCellsOnlyTouch) {
    const HexMesh mesh = mesh_of(15, {{0, 1, 2, 3, 4, 5, 6, 7}, {6, 8, 9, 10, 11, 12, 13, 14}});
    EXPECT_EQ(ids_of(inspect(mesh), "non-manifold-vertices"), (std::vector<std::int64_t>{6}));
}

TEST(Inspect, NamesAnEdgeWhereTwoCellsOnlyTouch) {
    const HexMesh mesh = mesh_of(14, {{0, 1, 2, 3, 4, 5, 6, 7}, {2, 8, 9, 10, 6, 11, 12, 13}});
    const Diagnostics found = inspect(mesh);
    const auto ids = ids_of(found, "non-manifold-edges");
    ASSERT_EQ(ids.size(), 1u);
    const auto ends = edge_table(mesh).vertices[static_cast<std::size_t>(ids[0])];
    EXPECT_EQ(ends, (std::array{VertexId(2), VertexId(6)}));
}

TEST(Inspect, CountsComponents) {
    const HexMesh mesh = mesh_of(16, {{0, 1, 2, 3, 4, 5, 6, 7}, {8, 9, 10, 11, 12, 13, 14, 15}});
    const Diagnostics found = inspect(mesh);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].code, "components");
    EXPECT_NE(found[0].message.find("2 components"), std::string::npos);
}

}  // namespace
}  // namespace hex
