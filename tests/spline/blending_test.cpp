#include "spline_samples.h"

#include <gtest/gtest.h>

#include <set>

namespace spline::test {
namespace {

using hex::CellId;
using hex::VertexId;

class Blending : public testing::TestWithParam<Sample> {};
INSTANTIATE_TEST_SUITE_P(Samples, Blending, testing::ValuesIn(samples()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST_P(Blending, RowsAreConvexCombinationsExactly) {
    const LevelMesh level = sample_level(GetParam());
    const BlendingOperator blending(level);
    RationalRowSum row;
    for (std::uint32_t p = 0; p < blending.point_count(); ++p) {
        const std::int64_t denominator = blending.row(p, row);
        std::int64_t sum = 0;
        for (const auto& term : row.merged()) {
            EXPECT_GT(term.value, 0);
            sum += term.value;
        }
        EXPECT_EQ(sum, denominator) << "point " << p;
    }
}

TEST_P(Blending, ElementsAgreeOnTheirSharedPoints) {
    // Two elements name the same points on a shared face, and no others.
    const LevelMesh level = sample_level(GetParam());
    const BlendingOperator blending(level);
    for (const hex::HalfFaceId h : level.mesh.half_faces()) {
        if (level.mesh.is_boundary(h)) continue;
        const hex::HalfFaceId t = level.mesh.twin(h);
        const auto mine = blending.element_points(hex::HexMesh::cell_of(h));
        const auto theirs = blending.element_points(hex::HexMesh::cell_of(t));
        std::set<std::uint32_t> a, b;
        for (const std::size_t p : face_points(hex::HexMesh::local_face(h))) a.insert(mine[p]);
        for (const std::size_t p : face_points(hex::HexMesh::local_face(t))) b.insert(theirs[p]);
        EXPECT_EQ(a.size(), 16U);
        EXPECT_EQ(a, b);
    }
}

TEST_P(Blending, SharedPointsLieAtTheSameCornerOfBothElements) {
    // The corner points of an element are those of its vertices, in the element's own frame.
    const LevelMesh level = sample_level(GetParam());
    const BlendingOperator blending(level);
    std::map<std::uint32_t, VertexId> vertex_of_point;
    for (const CellId c : level.mesh.cells()) {
        const auto points = blending.element_points(c);
        for (std::size_t k = 0; k < 8; ++k) {
            const std::uint32_t point = points[static_cast<std::size_t>(hex::hexahedron::bezier_corner[k])];
            const VertexId v = level.mesh.corner(c, static_cast<int>(k));
            EXPECT_EQ(vertex_of_point.emplace(point, v).first->second, v);
        }
    }
}

TEST_P(Blending, LinearFunctionsAreReproduced) {
    // Coefficients that are a linear function of the control points give that function of the geometry. With
    // position rows only this says: rows applied to coordinates and to a linear form of them commute. What
    // makes it a test is the partition of unity in the constant term.
    const LevelMesh level = sample_level(GetParam());
    const auto linear = [](const hex::Vec3& x) { return 3.0 + 2.0 * x[0] - x[1] + 0.5 * x[2]; };
    for (const CellId c : level.mesh.cells()) {
        for (const Row& row : blending_rows(level, c)) {
            hex::Vec3 point = hex::Vec3::Zero();
            double value = 0.0;
            for (const auto& [v, weight] : row) {
                point += weight * level.mesh.position(VertexId(v));
                value += weight * linear(level.mesh.position(VertexId(v)));
            }
            EXPECT_NEAR(value, linear(point), 1e-13);
        }
    }
}

/// Rows of the cell of a grid(n,n,n) with lower corner (i,j,k), as numerators over the grid's vertices.
std::int64_t coefficient(const LevelMesh& level, CellId cell, std::size_t point, VertexId v,
                         std::int64_t scale) {
    const BlendingOperator blending(level);
    RationalRowSum row;
    const std::int64_t denominator = blending.row(blending.element_points(cell)[point], row);
    EXPECT_EQ(scale % denominator, 0);
    for (const auto& term : row.merged()) {
        if (term.column == v.value()) return term.value * (scale / denominator);
    }
    return 0;
}

TEST(BlendingRegular, InteriorElementIsTheTensorProductOfUniformCubicBSplines) {
    constexpr std::int64_t x[4][4] = {{1, 4, 1, 0}, {0, 4, 2, 0}, {0, 2, 4, 0}, {0, 1, 4, 1}};  // times 1/6
    const LevelMesh level = level_of(hex::test::grid(3, 3, 3), false);
    const CellId middle(13);
    for (std::size_t p = 0; p < 64; ++p) {
        for (std::size_t v = 0; v < 64; ++v) {
            const std::int64_t expected = x[p % 4][v % 4] * x[p / 4 % 4][v / 4 % 4] * x[p / 16][v / 16];
            EXPECT_EQ(coefficient(level, middle, p, VertexId(v), 216), expected) << p << ' ' << v;
        }
    }
}

TEST(BlendingRegular, CornerElementOfASharpBoxIsTheTensorProductWithNaturalEnds) {
    constexpr std::int64_t x[4][3] = {{6, 0, 0}, {4, 2, 0}, {2, 4, 0}, {1, 4, 1}};  // times 1/6
    const LevelMesh level = level_of(hex::test::grid(3, 3, 3), true);
    std::set<std::uint32_t> functions;
    for (const Row& row : blending_rows(level, CellId(0))) {
        for (const auto& [v, weight] : row) functions.insert(v);
    }
    EXPECT_EQ(functions.size(), 27U);
    for (std::size_t p = 0; p < 64; ++p) {
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t j = 0; j < 3; ++j) {
                for (std::size_t i = 0; i < 3; ++i) {
                    const std::int64_t expected = x[p % 4][i] * x[p / 4 % 4][j] * x[p / 16][k];
                    EXPECT_EQ(coefficient(level, CellId(0), p, VertexId(i + 4 * j + 16 * k), 216), expected)
                        << p << ' ' << i << j << k;
                }
            }
        }
    }
}

TEST(BlendingRegular, ExtraordinaryEdgeOfValenceNGives4Times2NPlus8Functions) {
    // Away from the boundary: the fan refined twice.
    for (const int valence : {3, 5, 6}) {
        LevelMesh level = level_of(hex::test::fan(valence, 2), false);
        for (int i = 0; i < 2; ++i) level = subdivide(level).fine;
        const auto classes = classify_elements(level);
        std::size_t irregular = 0;
        for (const CellId c : level.mesh.cells()) {
            if (classes[c.index()] != ElementClass::irregular) continue;
            ++irregular;
            std::set<std::uint32_t> functions;
            for (const Row& row : blending_rows(level, c)) {
                for (const auto& [v, weight] : row) functions.insert(v);
            }
            EXPECT_EQ(functions.size(), static_cast<std::size_t>(4 * (2 * valence + 8)));
        }
        EXPECT_GT(irregular, 0U);
    }
}

TEST(LevelMesh, ClassesAndRegularVerticesOfAGrid) {
    const LevelMesh sharp = level_of(hex::test::grid(4, 4, 4), true);
    const auto classes = classify_elements(sharp);
    EXPECT_EQ(std::count(classes.begin(), classes.end(), ElementClass::regular), 8);
    EXPECT_EQ(std::count(classes.begin(), classes.end(), ElementClass::boundary), 56);
    const auto regular = regular_vertices(sharp);
    EXPECT_EQ(std::count(regular.begin(), regular.end(), 1), 125);
    // Without features the rounded edges of the box are irregular: 12 edges of 3 inner vertices, 8 corners.
    const auto smooth = regular_vertices(level_of(hex::test::grid(4, 4, 4), false));
    EXPECT_EQ(std::count(smooth.begin(), smooth.end(), 0), 12 * 3 + 8);
}

TEST(LevelMesh, ExtraordinaryEdgesByValence) {
    const LevelMesh level = level_of(hex::test::fan(5, 3), false);
    EXPECT_EQ(extraordinary_edges(level), (std::map<int, std::size_t>{{5, 3}}));
    EXPECT_TRUE(extraordinary_edges(level_of(hex::test::grid(2, 3, 4), false)).empty());
}

}  // namespace
}  // namespace spline::test
