#include "map/cases.h"

#include <hex/base/error.h>
#include <hex/map/map.h>
#include <hex/quality/scaled_jacobian.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <stop_token>

namespace hex {
namespace {

using test::moved;
using test::surface_of_blocks;

/// A smooth bend that is no affine map, to have curved patches.
Vec3 bend(const Vec3& p) {
    return {p.x() + 0.1 * std::sin(2 * p.y() + p.z()), p.y() + 0.12 * std::cos(1.5 * p.x() - p.z()),
            p.z() + 0.15 * std::sin(p.x() * p.y())};
}

struct Case {
    TriangleMesh surface;
    HexMesh blocks;
};

/// Blocks with a bent, finely triangulated boundary; their corners lie on it exactly.
Case bent(const HexMesh& blocks, int n = 6) {
    return {make_triangle_mesh(surface_of_blocks(blocks, n, bend)), moved(blocks, bend)};
}

std::string message_of(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options = {},
                       ErrorKind kind = ErrorKind::bad_input) {
    try {
        map(surface, blocks, options);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

void expect_contains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

TEST(Map, BoxWithOneBlockIsTheExactGrid) {
    const TriangleMesh surface = make_triangle_mesh(test::box_surface(3, 2, 1, 5));
    const HexMesh blocks =
        moved(test::grid(1, 1, 1), [](const Vec3& p) { return Vec3(3 * p.x(), 2 * p.y(), p.z()); });
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * bounding_box(surface).diagonal();
    for (const int level : {0, 1, 2, 3}) {
        const MapResult result = map(surface, blocks, {.level = level});
        const int n = 1 << level;
        ASSERT_EQ(result.mesh.cell_count(), static_cast<std::size_t>(n * n * n));
        ASSERT_EQ(result.mesh.vertex_count(), static_cast<std::size_t>((n + 1) * (n + 1) * (n + 1)));
        std::size_t cell = 0;
        for (int k = 0; k < n; ++k)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i, ++cell) {
                    const auto corners = result.mesh.corner_positions(CellId(cell));
                    for (std::size_t c = 0; c < 8; ++c) {
                        const auto& uvw = hexahedron::corner_uvw[c];
                        const Vec3 exact(3.0 * (i + uvw[0]) / n, 2.0 * (j + uvw[1]) / n,
                                         1.0 * (k + uvw[2]) / n);
                        EXPECT_LT((corners[c] - exact).norm(), rounding);
                    }
                }
        EXPECT_EQ(result.report.patches, 6U);
        EXPECT_EQ(result.report.blocks, 1U);
        EXPECT_EQ(result.report.largest_snap, 0.0);
        EXPECT_TRUE(result.report.diagnostics.empty());
    }
}

class MapOfBlocks : public ::testing::TestWithParam<int> {
  protected:
    static HexMesh blocks() {
        switch (GetParam()) {
            case 0:
                return test::grid(2, 2, 2);
            case 1:
                return test::shuffled_grid(3, 2, 2, 11);
            case 2:
                return test::fan(3, 2);
            default:
                return test::fan(5, 2);
        }
    }
};

TEST_P(MapOfBlocks, IsConformingAndWatertight) {
    const Case c = bent(blocks());
    const MapResult result = map(c.surface, c.blocks, {.level = 2});
    EXPECT_EQ(result.mesh.cell_count(), 64 * c.blocks.cell_count());
    const BoundaryQuads quads = boundary_quads(result.mesh);
    EXPECT_EQ(quads.size(), 16 * boundary_quads(c.blocks).size());
    // No unused vertices, one component, manifold boundary; and no two vertices in one place.
    EXPECT_TRUE(inspect(result.mesh).empty());
    EXPECT_GT(test::smallest_gap(result.mesh), 0.01);
    std::map<std::pair<VertexId, VertexId>, int> directed;
    for (const auto& q : quads.vertices)
        for (std::size_t k = 0; k < 4; ++k) ++directed[{q[k], q[(k + 1) % 4]}];
    for (const auto& [edge, count] : directed) {
        EXPECT_EQ(count, 1);
        EXPECT_TRUE(directed.contains({edge.second, edge.first}));
    }
}

TEST_P(MapOfBlocks, BoundaryVerticesLieOnTheTriangles) {
    const Case c = bent(blocks());
    const MapResult result = map(c.surface, c.blocks, {.level = 2});
    for (const VertexId v : boundary_quads(result.mesh).boundary_vertices)
        EXPECT_LT(test::distance_to_surface(result.mesh.position(v), c.surface), 1e-14);
}

/// However the axes of the blocks are turned against each other, and however skew they are.
TEST(Map, ParallelepipedsAreCutIntoEqualParallelepipeds) {
    const auto skew = [](const Vec3& p) {
        return Vec3(2 * p.x() + p.y(), 3 * p.y() - 0.5 * p.z(), p.z() + 0.3 * p.x());
    };
    for (unsigned seed = 0; seed < 5; ++seed) {
        const HexMesh blocks = moved(test::shuffled_grid(3, 2, 2, seed), skew);
        const TriangleMesh surface = make_triangle_mesh(surface_of_blocks(blocks, 3));
        const double rounding = 8 * std::numeric_limits<double>::epsilon() * bounding_box(surface).diagonal();
        const MapResult result = map(surface, blocks, {.level = 2});
        for (const CellId cell : result.mesh.cells()) {
            const auto block = blocks.corner_positions(CellId(cell.index() / 64));
            const auto corners = result.mesh.corner_positions(cell);
            const std::size_t local = cell.index() % 64;
            for (std::size_t c = 0; c < 8; ++c) {
                const auto& uvw = hexahedron::corner_uvw[c];
                const double u = (static_cast<double>(local % 4) + uvw[0]) / 4;
                const double v = (static_cast<double>(local / 4 % 4) + uvw[1]) / 4;
                const double w = (static_cast<double>(local / 16) + uvw[2]) / 4;
                const Vec3 exact = block[0] + u * (block[1] - block[0]) + v * (block[3] - block[0]) +
                                   w * (block[4] - block[0]);
                EXPECT_LT((corners[c] - exact).norm(), rounding);
            }
        }
    }
}

TEST_P(MapOfBlocks, PartsAreBlocks) {
    const Case c = bent(blocks());
    const MapResult result = map(c.surface, c.blocks, {.level = 1});
    for (const CellId cell : result.mesh.cells())
        EXPECT_EQ(result.mesh.part(cell), static_cast<int>(cell.index() / 8) + 1);
}

/// All ways to say how fine the mesh is and how blocks are filled, for a model of about four units.
std::vector<MapOptions> variants(double scale = 1.0) {
    std::vector<MapOptions> all;
    for (const Interior interior : {Interior::linear, Interior::transfinite, Interior::harmonic})
        all.push_back({.level = 2, .interior = interior});
    for (const double length : {0.8, 0.3}) all.push_back({.edge_length = length * scale});
    all.push_back({.target_hexes = 700});
    return all;
}

TEST_P(MapOfBlocks, IsTheSameForAnyNumberOfThreads) {
    const Case c = bent(blocks());
    Context one, two;
    one.threads = 1;
    two.threads = 2;
    for (MapOptions options : variants()) {
        options.level = 3;
        const MapResult a = map(c.surface, c.blocks, options, one);
        const MapResult b = map(c.surface, c.blocks, options, two);
        ASSERT_EQ(a.mesh.vertex_count(), b.mesh.vertex_count());
        for (const VertexId v : a.mesh.vertices()) ASSERT_EQ(a.mesh.position(v), b.mesh.position(v));
        EXPECT_TRUE(
            std::equal(a.mesh.cell_array().begin(), a.mesh.cell_array().end(), b.mesh.cell_array().begin()));
    }
}

TEST_P(MapOfBlocks, MovesWithItsInput) {
    const Case c = bent(blocks());
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(1.1, Vec3(0.3, -0.7, 0.6).normalized()).toRotationMatrix();
    for (const double factor : {250.0, 1e-3}) {
        const auto similar = [&](const Vec3& p) -> Vec3 {
            return factor * (rotation * p + Vec3(0.4, -8, 0.12));
        };
        PolygonSoup soup = to_soup(c.surface);
        for (Vec3& p : soup.points) p = similar(p);
        const TriangleMesh surface = make_triangle_mesh(soup);
        const HexMesh drawn = moved(c.blocks, similar);
        const double scale = factor * bounding_box(c.surface).diagonal();
        const std::vector<MapOptions> options = variants();
        const std::vector<MapOptions> scaled = variants(factor);
        for (std::size_t i = 0; i < options.size(); ++i) {
            const MapResult before = map(c.surface, c.blocks, options[i]);
            const MapResult after = map(surface, drawn, scaled[i]);
            ASSERT_EQ(before.report.divisions, after.report.divisions);
            for (const VertexId v : before.mesh.vertices())
                ASSERT_LT((after.mesh.position(v) - similar(before.mesh.position(v))).norm(), 1e-9 * scale);
        }
    }
}

/// Bent blocks, where transfinite interpolation is not the solution.
TEST_P(MapOfBlocks, HarmonicIsNowhereWorseThanTransfiniteWhereItMatters) {
    const Case c = bent(blocks());
    const HexMesh start = map(c.surface, c.blocks, {.level = 3, .interior = Interior::transfinite}).mesh;
    const MapResult harmonic = map(c.surface, c.blocks, {.level = 3, .interior = Interior::harmonic});
    std::size_t changed = 0;
    for (const CellId cell : start.cells()) {
        const double now = scaled_jacobian(harmonic.mesh, cell);
        EXPECT_GE(now, std::min(0.3, scaled_jacobian(start, cell)));
        changed += now == scaled_jacobian(start, cell) ? 0 : 1;
    }
    EXPECT_GT(changed, start.cell_count() / 4);
}

INSTANTIATE_TEST_SUITE_P(Structures, MapOfBlocks, ::testing::Range(0, 4));

TEST(Map, EdgeLengthCutsEverySheetByItsOwnLength) {
    const TriangleMesh surface = make_triangle_mesh(test::box_surface(3, 2, 1, 5));
    const HexMesh blocks =
        moved(test::grid(1, 1, 1), [](const Vec3& p) { return Vec3(3 * p.x(), 2 * p.y(), p.z()); });
    const MapResult result = map(surface, blocks, {.edge_length = 0.5});
    EXPECT_EQ(result.mesh.cell_count(), 6U * 4U * 2U);
    EXPECT_EQ(result.report.divisions, (std::vector<int>{6, 4, 2}));
    EXPECT_EQ(result.report.edge_length, 0.5);
    EXPECT_NEAR(summarize(result.mesh).min, 1.0, 1e-12);
    EXPECT_EQ(map(surface, blocks, {.target_hexes = 6000}).mesh.cell_count(), 6000U);
    EXPECT_EQ(map(surface, blocks, {.target_hexes = 1}).mesh.cell_count(), 1U);
}

TEST(Map, MemoryOfEarlierCallsChangesNothing) {
    Case c = bent(test::grid(2, 1, 1));
    std::shared_ptr<MapMemory> memory;
    for (const std::size_t target : {20U, 500U, 20U, 80U}) {
        // The last surface and blocks are others.
        if (target == 80U) c = bent(test::grid(1, 2, 1));
        const MapResult plain = map(c.surface, c.blocks, {.target_hexes = target});
        const MapResult again = map(c.surface, c.blocks, {.target_hexes = target, .memory = &memory});
        EXPECT_TRUE(memory != nullptr);
        EXPECT_TRUE(std::ranges::equal(plain.mesh.positions(), again.mesh.positions()));
        EXPECT_EQ(plain.report.patch_maps.size(), again.report.patch_maps.size());
        EXPECT_EQ(plain.report.diagnostics.size(), again.report.diagnostics.size());
        EXPECT_EQ(plain.report.largest_snap, again.report.largest_snap);
    }
}

TEST(Map, BlockVerticesAreSnappedToTheSurfaceAndFarOnesWarnedOf) {
    const Case c = bent(test::grid(2, 1, 1));
    const MapResult exact = map(c.surface, c.blocks, {.level = 1});
    std::vector<Vec3> positions(c.blocks.positions().begin(), c.blocks.positions().end());
    positions[0] += Vec3(0.05, 0, 0);
    positions[5] += Vec3(0, 1e-4, 0);
    HexMesh drawn = c.blocks;
    drawn.set_positions(positions);
    const MapResult result = map(c.surface, drawn, {.level = 1});
    for (const VertexId v : exact.mesh.vertices()) EXPECT_EQ(result.mesh.position(v), exact.mesh.position(v));
    EXPECT_NEAR(result.report.largest_snap, 0.05 / bounding_box(c.surface).diagonal(), 1e-12);
    ASSERT_EQ(result.report.diagnostics.size(), 1U);
    EXPECT_EQ(result.report.diagnostics[0].code, "far-corner");
    EXPECT_EQ(result.report.diagnostics[0].severity, Severity::warning);
    EXPECT_EQ(result.report.diagnostics[0].ids, std::vector<std::int64_t>{0});
}

/// Interpolation keeps them; the Laplace equation puts them where the blocks are even.
TEST(Map, InnerBlockVerticesStayWhereTheyWereDrawnUnlessHarmonic) {
    const HexMesh blocks = test::grid(2, 2, 2);
    const VertexId centre(13);
    HexMesh drawn = blocks;
    drawn.set_position(centre, Vec3(1.1, 0.9, 1.2));
    const TriangleMesh surface = make_triangle_mesh(surface_of_blocks(blocks, 2));
    for (const Interior interior : {Interior::linear, Interior::transfinite}) {
        const MapResult result = map(surface, drawn, {.level = 1, .interior = interior});
        EXPECT_EQ(result.mesh.position(centre), Vec3(1.1, 0.9, 1.2));
    }
    const MapResult harmonic = map(surface, drawn, {.level = 1});
    EXPECT_LT((harmonic.mesh.position(centre) - Vec3(1, 1, 1)).norm(), 0.06);
    EXPECT_EQ(harmonic.report.held_back_nodes, 0U);
}

/// Of a harmonic function of space the nodes of a cubic grid take exact values: x^2 - y^2 is discrete
/// harmonic too.
TEST(Map, HarmonicInteriorSolvesTheLaplaceEquation) {
    const auto lift = [](const Vec3& p) {
        return Vec3(p.x(), p.y(), p.z() + 0.1 * (p.x() * p.x() - p.y() * p.y()));
    };
    const HexMesh blocks = moved(test::grid(2, 2, 2), lift);
    // Fine enough that the samples are vertices of the surface.
    const TriangleMesh surface = make_triangle_mesh(surface_of_blocks(test::grid(2, 2, 2), 8, lift));
    const MapResult result = map(surface, blocks, {.edge_length = 0.5});
    EXPECT_EQ(result.mesh.cell_count(), 64U);
    double largest = 0.0;
    const BoundaryQuads quads = boundary_quads(result.mesh);
    for (const VertexId v : result.mesh.vertices()) {
        if (quads.contains(v)) continue;
        const Vec3 p = result.mesh.position(v);
        Vec3 flat(std::round(2 * p.x()) / 2, std::round(2 * p.y()) / 2, 0);
        flat.z() = std::round(2 * (p.z() - 0.1 * (p.x() * p.x() - p.y() * p.y()))) / 2;
        largest = std::max(largest, (p - lift(flat)).norm());
    }
    EXPECT_LT(largest, 0.02);
}

TEST(Map, UnusedBlockVerticesAreLeftOut) {
    const HexMesh blocks = test::grid(1, 1, 1);
    std::vector<Vec3> positions(blocks.positions().begin(), blocks.positions().end());
    positions.emplace_back(9, 9, 9);
    const HexMesh with_stray(positions, {blocks.cell_array().begin(), blocks.cell_array().end()});
    const MapResult result = map(make_triangle_mesh(test::box_surface(1, 1, 1, 2)), with_stray, {.level = 1});
    EXPECT_EQ(result.mesh.vertex_count(), 27U);
    EXPECT_TRUE(inspect(result.mesh).empty());
}

TEST(Map, ReportsEveryPatch) {
    const Case c = bent(test::grid(2, 1, 1));
    const MapReport report = map(c.surface, c.blocks).report;
    ASSERT_EQ(report.patch_maps.size(), 10U);
    for (std::size_t p = 0; p < 10; ++p) {
        EXPECT_EQ(report.patch_maps[p].patch, static_cast<int>(p));
        EXPECT_EQ(report.patch_maps[p].part, static_cast<int>(p) + 1);
        EXPECT_EQ(report.patch_maps[p].flipped, 0U);
        EXPECT_EQ(report.patch_maps[p].weights, "discrete-conformal");
    }
}

TEST(MapErrors, PatchesThatAreNotFourSidedAreNamed) {
    PolygonSoup soup = test::box_surface(1, 1, 1, 3);
    for (int& part : soup.parts)
        if (part == 3) part = 1;
    const std::string message = message_of(make_triangle_mesh(soup), test::grid(1, 1, 1));
    // Of the two patches that lost a corner to the joined ones, the first is described.
    expect_contains(message, "2 of 5 patches (3, 4)");
    expect_contains(message, "patch 3 (part 5");
    expect_contains(message, "3 corners instead of four");
    expect_contains(message, "polycube");
}

TEST(MapErrors, TwoBlockVerticesAtOneCorner) {
    HexMesh blocks = test::grid(1, 1, 1);
    blocks.set_position(VertexId(1), Vec3(0.2, 0.1, 0));
    const std::string message = message_of(make_triangle_mesh(test::box_surface(1, 1, 1, 3)), blocks);
    expect_contains(message, "block vertices 0 and 1");
}

TEST(MapErrors, QuadWithoutPatch) {
    // The blocks have eight corners at the right places, but two of them exchanged.
    HexMesh blocks = test::grid(1, 1, 1);
    blocks.set_position(VertexId(1), Vec3(1, 1, 1));
    blocks.set_position(VertexId(7), Vec3(1, 0, 0));
    expect_contains(message_of(make_triangle_mesh(test::box_surface(1, 1, 1, 3)), blocks), "block 0");
}

TEST(MapErrors, QuadAcrossItsPatch) {
    // The four corners of a side in the order of a bow tie.
    HexMesh blocks = test::grid(1, 1, 1);
    blocks.set_position(VertexId(4), Vec3(1, 0, 1));
    blocks.set_position(VertexId(5), Vec3(0, 0, 1));
    const std::string message = message_of(make_triangle_mesh(test::box_surface(1, 1, 1, 3)), blocks);
    expect_contains(message, "crosswise");
    expect_contains(message, "block 0");
}

TEST(MapErrors, PatchWithoutQuad) {
    // Two boxes as surface, blocks for one of them.
    PolygonSoup soup = test::box_surface(1, 1, 1, 2);
    const PolygonSoup other = test::box_surface(1, 1, 1, 2);
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const Vec3& p : other.points) soup.points.push_back(p + Vec3(5, 0, 0));
    for (std::size_t f = 0; f < other.size(); ++f) {
        const auto t = other.polygon(f);
        soup.add_polygon(std::array{t[0] + first, t[1] + first, t[2] + first}, other.parts[f] + 10);
    }
    const std::string message = message_of(make_triangle_mesh(soup), test::grid(1, 1, 1));
    expect_contains(message, "6 of 12 patches");
    expect_contains(message, "patch 6 (part 11)");
}

TEST(MapErrors, InsideOutBlocksOrSurface) {
    const PolygonSoup soup = test::box_surface(1, 1, 1, 2);
    const HexMesh blocks = test::grid(1, 1, 1);
    HexCell mirrored = blocks.cell(CellId(0));
    for (std::size_t c = 0; c < 4; ++c) std::swap(mirrored[c], mirrored[c + 4]);
    const HexMesh inside_out({blocks.positions().begin(), blocks.positions().end()}, {mirrored});
    expect_contains(message_of(make_triangle_mesh(soup), inside_out), "oriented against each other");

    PolygonSoup turned;
    turned.points = soup.points;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto t = soup.polygon(f);
        turned.add_polygon(std::array{t[0], t[2], t[1]}, soup.parts[f]);
    }
    expect_contains(message_of(make_triangle_mesh(turned), blocks), "oriented against each other");
}

TEST(MapErrors, NoBlocks) {
    expect_contains(message_of(make_triangle_mesh(test::box_surface(1, 1, 1, 2)), HexMesh()), "no blocks");
}

/// Two blocks touch along an edge only; the surface opens a slit there, so that the two corners are joined by
/// two chains and one block edge cannot follow both.
TEST(MapErrors, TwoChainsForOneBlockEdge) {
    const HexMesh full = test::grid(2, 2, 3);
    std::vector<HexCell> cells(full.cell_array().begin(), full.cell_array().end());
    const HexCell beyond_slit = cells[7];
    cells.erase(cells.begin() + 5, cells.begin() + 7);
    const HexMesh blocks({full.positions().begin(), full.positions().end()}, cells);
    PolygonSoup soup = surface_of_blocks(blocks, 2);
    const BoundaryQuads quads = boundary_quads(blocks);
    const auto middle = static_cast<std::uint32_t>(
        std::find(soup.points.begin(), soup.points.end(), Vec3(1, 1, 1.5)) - soup.points.begin());
    ASSERT_LT(middle, soup.points.size());
    soup.points.emplace_back(1.1, 1.1, 1.5);
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const CellId owner = HexMesh::cell_of(quads.half_faces[static_cast<std::size_t>(soup.parts[f] - 1)]);
        if (blocks.cell(owner) != beyond_slit) continue;
        for (std::size_t k = soup.offsets[f]; k < soup.offsets[f + 1]; ++k)
            if (soup.corners[k] == middle)
                soup.corners[k] = static_cast<std::uint32_t>(soup.points.size() - 1);
    }
    const std::string message = message_of(make_triangle_mesh(soup), blocks);
    expect_contains(message, "block vertices 13 and 22");
    expect_contains(message, "follow both");
}

TEST(MapErrors, SurfaceWithoutCorners) {
    PolygonSoup soup = test::box_surface(1, 1, 1, 2);
    for (int& part : soup.parts) part = 1;
    expect_contains(message_of(make_triangle_mesh(soup), test::grid(1, 1, 1)), "patch 0 (part 1");
}

TEST(MapErrors, OptionsOutOfRange) {
    const TriangleMesh surface = make_triangle_mesh(test::box_surface(1, 1, 1, 2));
    const HexMesh blocks = test::grid(1, 1, 1);
    for (const int level : {-1, 8}) message_of(surface, blocks, {.level = level}, ErrorKind::usage);
    expect_contains(message_of(surface, blocks, {.method = "no-such"}, ErrorKind::usage), "patchwise");
    for (const double length : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        message_of(surface, blocks, {.edge_length = length}, ErrorKind::usage);
    message_of(surface, blocks, {.edge_length = 1.0, .target_hexes = 10}, ErrorKind::usage);
    expect_contains(message_of(surface, blocks, {.edge_length = 1e-6}, ErrorKind::unsupported), "hexahedra");
    message_of(surface, blocks, {.snap_warning = -1.0}, ErrorKind::usage);
    message_of(surface, blocks, {.snap_warning = std::nan("")}, ErrorKind::usage);
}

TEST(Map, StopsWhenAsked) {
    const Case c = bent(test::grid(2, 2, 2));
    std::stop_source source;
    Context context;
    context.stop = source.get_token();
    source.request_stop();
    try {
        map(c.surface, c.blocks, {}, context);
        FAIL() << "did not stop";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
}

TEST(Map, TellsItsProgress) {
    const Case c = bent(test::grid(2, 1, 1));
    std::vector<double> shares;
    Context context;
    context.on_progress = [&](std::string_view, double share) { shares.push_back(share); };
    map(c.surface, c.blocks, {}, context);
    ASSERT_GE(shares.size(), 3U);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1.0);
}

}  // namespace
}  // namespace hex
