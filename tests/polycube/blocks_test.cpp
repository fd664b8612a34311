#include "support/surfaces.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/surface_file.h>
#include <hex/map/map.h>
#include <hex/polycube/blocks.h>
#include <hex/polycube/polycube.h>
#include <hex/quality/hex_metrics.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/quality/surface_distance.h>
#include <hex/volume/topology.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace hex {
namespace {

using Cell = std::array<int, 3>;

/// The surface of a union of unit cubes, each square cut into n x n x 2 triangles; part = label + 1.
PolygonSoup surface_of(const std::set<Cell>& cells, int n) {
    PolygonSoup soup;
    std::map<Cell, std::uint32_t> vertices;
    for (const Cell& cell : cells) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int high : {0, 1}) {
                Cell next = cell;
                next[static_cast<std::size_t>(axis)] += high ? 1 : -1;
                if (cells.contains(next)) continue;
                const auto vertex = [&](int x, int y) {
                    Cell p{};
                    for (int a = 0; a < 3; ++a) {
                        const int offset = a == axis ? high * n : a == (axis + 1) % 3 ? x : y;
                        p[static_cast<std::size_t>(a)] = cell[static_cast<std::size_t>(a)] * n + offset;
                    }
                    const auto [entry, fresh] =
                        vertices.emplace(p, static_cast<std::uint32_t>(soup.points.size()));
                    if (fresh) soup.points.emplace_back(Vec3(p[0], p[1], p[2]) / n);
                    return entry->second;
                };
                for (int i = 0; i < n; ++i) {
                    for (int j = 0; j < n; ++j) {
                        const auto a = vertex(i, j), c = vertex(i + 1, j + 1);
                        auto b = vertex(i + 1, j), d = vertex(i, j + 1);
                        if (!high) std::swap(b, d);
                        soup.add_polygon(std::array{a, b, c}, 2 * axis + 1 - high + 1);
                        soup.add_polygon(std::array{a, c, d}, 2 * axis + 1 - high + 1);
                    }
                }
            }
        }
    }
    return soup;
}

std::set<Cell> cells_of(Cell size, const std::function<bool(int, int, int)>& inside) {
    std::set<Cell> cells;
    for (int i = 0; i < size[0]; ++i)
        for (int j = 0; j < size[1]; ++j)
            for (int k = 0; k < size[2]; ++k)
                if (inside(i, j, k)) cells.insert({i, j, k});
    return cells;
}

/// Twists the surface about z and waves it, so that nothing is straight or on a grid.
PolygonSoup bent(PolygonSoup soup) {
    for (Vec3& p : soup.points) {
        const double angle = 0.12 * p.z();
        const double x = p.x() * std::cos(angle) - p.y() * std::sin(angle) + 0.05 * std::sin(3 * p.y());
        const double y = p.x() * std::sin(angle) + p.y() * std::cos(angle);
        p = Vec3(x, y, p.z() + 0.1 * std::sin(p.x() + p.y()));
    }
    return soup;
}

struct Shape {
    const char* name;
    std::set<Cell> cells;
    std::size_t blocks;  ///< of the base complex, counted by hand
    int euler;           ///< of the surface
};

std::vector<Shape> shapes() {
    return {
        {"box", cells_of({2, 1, 1}, [](int, int, int) { return true; }), 1, 2},
        {"ell", cells_of({3, 1, 3}, [](int i, int, int k) { return i == 0 || k == 0; }), 3, 2},
        {"u", cells_of({5, 2, 3}, [](int i, int, int k) { return i < 2 || i == 4 || k == 0; }), 5, 2},
        {"tee", cells_of({5, 1, 4}, [](int i, int, int k) { return k == 3 || i == 2; }), 4, 2},
        {"plus", cells_of({3, 3, 3}, [](int i, int j, int k) { return (i == 1) + (j == 1) + (k == 1) >= 2; }),
         7, 2},
        {"frame", cells_of({3, 3, 1}, [](int i, int j, int) { return i != 1 || j != 1; }), 8, 0},
        {"through_hole", cells_of({4, 5, 3}, [](int i, int j, int) { return i != 1 || j < 2 || j > 3; }), 8,
         0},
        {"blind_pocket",
         cells_of({4, 5, 3}, [](int i, int j, int k) { return i != 1 || j < 2 || j > 3 || k == 0; }), 17, 2},
        {"stairs", cells_of({3, 3, 3}, [](int i, int j, int k) { return i + j + k <= 2; }), 10, 2},
        {"hollow",
         cells_of({4, 4, 4},
                  [](int i, int j, int k) { return i < 1 || i > 2 || j < 1 || j > 2 || k < 1 || k > 2; }),
         26, 4},
        {"grate", cells_of({5, 2, 3}, [](int i, int, int k) { return i % 2 == 0 || k % 2 == 0; }), 13, -2},
    };
}

BlocksResult blocks_of(const PolygonSoup& soup, const BlocksOptions& options = {},
                       const Context& context = {}) {
    const TriangleMesh mesh = make_triangle_mesh(soup);
    Segmentation segmentation;
    for (const int part : soup.parts) segmentation.labels.push_back(part - 1);
    return make_blocks(mesh, segmentation, options, context);
}

class BlocksOfShapes : public testing::TestWithParam<std::tuple<std::size_t, int, bool>> {
  protected:
    Shape shape() const { return shapes()[std::get<0>(GetParam())]; }
    PolygonSoup surface() const {
        PolygonSoup soup = surface_of(shape().cells, std::get<1>(GetParam()));
        return std::get<2>(GetParam()) ? bent(std::move(soup)) : soup;
    }
};

TEST_P(BlocksOfShapes, AreTheFewestThatConformAndFitTheirPatches) {
    const PolygonSoup soup = surface();
    const BlocksResult result = blocks_of(soup);
    ASSERT_TRUE(result.report.violations.empty()) << result.report.violations.front().message;
    EXPECT_EQ(result.blocks.cell_count(), shape().blocks);
    EXPECT_EQ(result.report.inverted_corners, 0U);

    // The patches form a polycube surface of the same kind, with one quad a patch.
    const PolycubeResult cube = polycube(result.patches);
    EXPECT_TRUE(cube.report.violations.empty());
    const BoundaryQuads quads = boundary_quads(result.blocks);
    EXPECT_EQ(quads.size(), cube.report.patches);
    EXPECT_EQ(static_cast<int>(quads.boundary_vertices.size()) - static_cast<int>(quads.size()),
              shape().euler);

    // Cutting moves nothing: old vertices stay, and the enclosed volume with them.
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        EXPECT_EQ(to_eigen(result.patches.point(TriangleMesh::VertexHandle(static_cast<int>(v)))),
                  soup.points[v]);
    const double volume = enclosed_volume(make_triangle_mesh(soup));
    EXPECT_NEAR(enclosed_volume(result.patches), volume, 1e-12 * volume);

    // `map` takes both as they are.
    const MapResult mapped = map(result.patches, result.blocks, {.level = 1});
    EXPECT_EQ(mapped.mesh.cell_count(), 8 * shape().blocks);
    EXPECT_EQ(mapped.report.largest_snap, 0.0);
    EXPECT_EQ(summarize(mapped.mesh).inverted, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, BlocksOfShapes,
                         testing::Combine(testing::Range(std::size_t{0}, std::size_t{11}),
                                          testing::Values(1, 3), testing::Bool()),
                         [](const auto& of) {
                             return std::string(shapes()[std::get<0>(of.param)].name) + "_" +
                                    std::to_string(std::get<1>(of.param)) +
                                    (std::get<2>(of.param) ? "_bent" : "");
                         });

TEST(Blocks, OfABallWithSixLabelsIsOne) {
    const BlocksResult result = blocks_of(test::ball(6));
    EXPECT_TRUE(result.report.violations.empty());
    EXPECT_EQ(result.blocks.cell_count(), 1U);
    EXPECT_EQ(result.report.patches, 6U);
    EXPECT_GT(result.report.min_scaled_jacobian, 0.9);
}

TEST(Blocks, OfTwoComponentsAreTheBlocksOfBoth) {
    std::set<Cell> cells = {{0, 0, 0}, {3, 0, 0}, {4, 0, 0}, {3, 0, 1}};
    const BlocksResult result = blocks_of(bent(surface_of(cells, 2)));
    EXPECT_TRUE(result.report.violations.empty());
    EXPECT_EQ(result.blocks.cell_count(), 4U);
}

/// A ball whose parts are the labels of its normals, which face its middle when it is inside out.
PolygonSoup labelled_ball(int n, bool inside_out) {
    PolygonSoup ball = test::ball(n);
    for (int& part : ball.parts)
        if (inside_out) part = ((part - 1) ^ 1) + 1;
    return ball;
}

/// The blocks are not inverted and their patches enclose what they fill, with so many bounding surfaces.
void expect_blocks_of_patches(const BlocksResult& result, const PolygonSoup& soup, int surfaces) {
    ASSERT_TRUE(result.report.violations.empty()) << result.report.violations.front().message;
    EXPECT_EQ(result.report.inverted_corners, 0U);
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        EXPECT_EQ(to_eigen(result.patches.point(TriangleMesh::VertexHandle(static_cast<int>(v)))),
                  soup.points[v]);
    const BoundaryQuads quads = boundary_quads(result.blocks);
    EXPECT_EQ(quads.boundary_vertices.size() - quads.size(), 2U * static_cast<std::size_t>(surfaces));
    const MapResult mapped = map(result.patches, result.blocks, {.level = 2});
    EXPECT_EQ(mapped.report.largest_snap, 0.0);
    double filled = 0.0;
    for (const CellId c : mapped.mesh.cells())
        filled += evaluate(HexMetric::volume, mapped.mesh.corner_positions(c));
    EXPECT_NEAR(filled, enclosed_volume(result.patches), 0.1 * filled);
}

TEST(Blocks, OfBodiesThatMeetAreThoseOfEach) {
    PolygonSoup soup = test::ball(6);
    test::append(soup, test::ball(6), 1.0, Vec3(0.9, 0, 0));
    const BlocksResult result = blocks_of(soup);
    expect_blocks_of_patches(result, soup, 2);
    EXPECT_EQ(result.report.bodies, 2U);
    EXPECT_EQ(result.report.turned_shells, 0U);
    EXPECT_EQ(result.blocks.cell_count(), 2U);
}

TEST(Blocks, OfNestedShellsNeedNoOrientation) {
    for (const bool void_inwards : {true, false}) {
        for (const bool all_inside_out : {false, true}) {
            PolygonSoup soup;
            const auto add = [&](double scale, bool inside_out) {
                test::append(soup, labelled_ball(6, inside_out), scale, Vec3::Zero(), inside_out);
            };
            add(0.75, void_inwards != all_inside_out);
            add(0.5, all_inside_out);
            add(1.0, all_inside_out);
            const BlocksResult result = blocks_of(soup);
            expect_blocks_of_patches(result, soup, 3);
            EXPECT_EQ(result.report.bodies, 2U);
            EXPECT_EQ(result.report.turned_shells,
                      (all_inside_out ? 2U : 0U) + (void_inwards == all_inside_out ? 1U : 0U));
        }
    }
}

TEST(Blocks, OfASurfaceInsideOutAreThoseOfTheBodyInIt) {
    PolygonSoup soup;
    test::append(soup, labelled_ball(6, true), 1.0, Vec3::Zero(), true);
    const BlocksResult result = blocks_of(soup);
    expect_blocks_of_patches(result, soup, 1);
    EXPECT_EQ(result.report.turned_shells, 1U);
}

TEST(Blocks, NameTheChartsOfTheWholeSurface) {
    // The second body is one without a polycube: by itself its charts would be 0 to 5.
    PolygonSoup wrong = test::ball(4);
    for (int& part : wrong.parts) part = part == 1 ? 2 : part == 2 ? 1 : part;
    PolygonSoup soup = test::ball(4);
    test::append(soup, wrong, 1.0, Vec3(5, 0, 0));
    const BlocksResult result = blocks_of(soup);
    ASSERT_FALSE(result.report.violations.empty());
    EXPECT_TRUE(result.blocks.empty());
    for (const Diagnostic& violation : result.report.violations)
        for (const std::int64_t chart : violation.ids) EXPECT_GE(chart, 6);
}

TEST(Blocks, AreTheSameForAnyNumberOfThreads) {
    const PolygonSoup soup = bent(surface_of(shapes()[7].cells, 4));
    Context one;
    one.threads = 1;
    Context three;
    three.threads = 3;
    const BlocksResult a = blocks_of(soup, {}, one);
    const BlocksResult b = blocks_of(soup, {}, three);
    ASSERT_EQ(a.patches.n_vertices(), b.patches.n_vertices());
    for (const auto v : a.patches.vertices()) EXPECT_EQ(a.patches.point(v), b.patches.point(v));
    for (const auto f : a.patches.faces()) EXPECT_EQ(a.patches.data(f).part, b.patches.data(f).part);
    ASSERT_EQ(a.blocks.vertex_count(), b.blocks.vertex_count());
    for (const VertexId v : a.blocks.vertices()) EXPECT_EQ(a.blocks.position(v), b.blocks.position(v));
}

TEST(Blocks, AreNotMadeOfLabelsWithoutAPolycube) {
    PolygonSoup ball = test::ball(4);
    std::fill(ball.parts.begin(), ball.parts.end(), 1);
    auto result = blocks_of(ball);
    ASSERT_EQ(result.report.violations.size(), 1U);
    EXPECT_EQ(result.report.violations[0].code, "chart-without-corners");
    EXPECT_TRUE(result.blocks.empty());

    // Two labels only: each is a disk without corners.
    for (std::size_t t = 0; t < ball.size(); ++t)
        ball.parts[t] = ball.points[ball.polygon(t)[0]].z() + ball.points[ball.polygon(t)[1]].z() > 0 ? 5 : 6;
    result = blocks_of(ball);
    EXPECT_EQ(result.report.violations.size(), 2U);
}

TEST(Blocks, NameTheChartsOfACycleOfOrders) {
    // A ball cut like a cube whose +X and -X labels are exchanged: every side that ends there would have to
    // run against its direction.
    PolygonSoup ball = test::ball(4);
    for (int& part : ball.parts) part = part == 1 ? 2 : part == 2 ? 1 : part;
    const auto result = blocks_of(ball);
    ASSERT_FALSE(result.report.violations.empty());
    EXPECT_TRUE(result.blocks.empty());
}

TEST(Blocks, RefuseLabelsThatAreNotOnePerTriangle) {
    const TriangleMesh mesh = make_triangle_mesh(test::box_surface(1, 1, 1));
    EXPECT_THROW(make_blocks(mesh, Segmentation{{0, 1, 2}}), Error);
    EXPECT_THROW(make_blocks(mesh, Segmentation{labels_of_parts(mesh)}, {.unit = -1.0}), Error);
}

struct Published {
    const char* name;
    int attempt;  ///< SegmentOptions::attempt
};

class BlocksOfPublished : public testing::TestWithParam<Published> {};

TEST_P(BlocksOfPublished, SurfacesLabelledByAutoAreNotInvertedAndAMeshFollowsTheirPatches) {
    HEX_NEEDS_REFERENCE_DATA();
    const std::string name = GetParam().name;
    const TriangleMesh mesh = make_triangle_mesh(
        io::read_surface(test::reference_data() / "paper" / name / (name + "_tri.k")).soup);
    SegmentOptions options;
    options.attempt = GetParam().attempt;
    const BlocksResult result = make_blocks(mesh, segment(mesh, options).segmentation);
    ASSERT_TRUE(result.report.violations.empty()) << result.report.violations.front().message;
    EXPECT_EQ(result.report.inverted_corners, 0U);
    const MapResult mapped = map(result.patches, result.blocks, {.target_hexes = 3000});
    EXPECT_EQ(mapped.report.largest_snap, 0.0);
    // A patch that bulges, such as one with a whole leg in it, is where no mesh goes: that would be 20 %.
    const SurfaceDistance apart = surface_distance(mapped.mesh, result.patches);
    EXPECT_LT(apart.percent(apart.max()), 5.0);
}

INSTANTIATE_TEST_SUITE_P(Paper, BlocksOfPublished,
                         testing::Values(Published{"rod", 0}, Published{"hepta", 0}, Published{"mount1", 0},
                                         Published{"joint", 0}, Published{"fertility", 1},
                                         Published{"ant", 0}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(LabelsOfParts, AreFoundOnlyWhereChartsFaceTheirWay) {
    PolygonSoup box = test::box_surface(1, 2, 3, 2);
    EXPECT_EQ(labels_of_parts(make_triangle_mesh(box)).size(), box.size());
    for (int& part : box.parts) part = part == 1 ? 2 : part == 2 ? 1 : part;
    EXPECT_TRUE(labels_of_parts(make_triangle_mesh(box)).empty());
    for (int& part : box.parts) part += 6;
    EXPECT_TRUE(labels_of_parts(make_triangle_mesh(box)).empty());
}

}  // namespace
}  // namespace hex
