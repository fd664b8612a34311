#include "spline_samples.h"

#include <gtest/gtest.h>

namespace spline::test {
namespace {

using hex::CellId;
using hex::VertexId;

class SubdivisionOf : public testing::TestWithParam<Sample> {};
INSTANTIATE_TEST_SUITE_P(Samples, SubdivisionOf, testing::ValuesIn(samples()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST_P(SubdivisionOf, RowsSumToOneAndAreNotNegative) {
    const Subdivision s = subdivide(sample_level(GetParam()));
    for (std::size_t v = 0; v < s.coefficients.size(); ++v) {
        double sum = 0.0;
        for (const double c : s.coefficients[v].values) {
            EXPECT_GT(c, 0.0);
            sum += c;
        }
        // Every coefficient and every addition is rounded once.
        const double rounding = static_cast<double>(s.coefficients[v].size()) * 0x1p-52;
        EXPECT_NEAR(sum, 1.0, rounding) << "vertex " << v;
    }
}

TEST_P(SubdivisionOf, IsExactOnElementsOfRegularVerticesAndOnlyThere) {
    // S M(parent) = M(child) C where all eight vertices are regular; a defect that can be seen elsewhere.
    const LevelMesh coarse = sample_level(GetParam());
    const Subdivision s = subdivide(coarse);
    const auto regular = regular_vertices(coarse);
    std::size_t exact = 0, inexact = 0;
    for (const CellId c : coarse.mesh.cells()) {
        const auto& corners = coarse.mesh.cell(c);
        const bool refinable =
            std::all_of(corners.begin(), corners.end(), [&](VertexId v) { return regular[v.index()] != 0; });
        const ElementRows parent = blending_rows(coarse, c);
        double defect = 0.0;
        for (std::size_t k = 0; k < 8; ++k) {
            const ElementRows child = times(blending_rows(s.fine, CellId(8 * c.index() + k)), s.coefficients);
            defect = std::max(defect, difference(split(parent, k), child));
        }
        if (refinable) {
            EXPECT_LE(defect, 1e-15);
            ++exact;
        } else {
            EXPECT_GE(defect, 5e-3);
            EXPECT_LE(defect, 0.1);
            ++inexact;
        }
    }
    const bool all_regular = GetParam().name == "grid_sharp";
    EXPECT_EQ(inexact == 0, all_regular);
    EXPECT_TRUE(exact > 0 || GetParam().valence != 4);
}

TEST_P(SubdivisionOf, ChildrenKeepTheirParentsAxes) {
    const LevelMesh coarse = sample_level(GetParam());
    const Subdivision s = subdivide(coarse);
    ASSERT_EQ(s.fine.mesh.cell_count(), 8 * coarse.mesh.cell_count());
    for (const CellId c : coarse.mesh.cells()) {
        for (std::size_t k = 0; k < 8; ++k) {
            const CellId child(8 * c.index() + k);
            const FineVertex own = s.origin[s.fine.mesh.cell(child)[k].index()];
            EXPECT_EQ(own.kind, FineVertex::Kind::vertex);
            EXPECT_EQ(own.index, coarse.mesh.cell(c)[k].value());
            constexpr std::array<std::size_t, 8> opposite = {6, 7, 4, 5, 2, 3, 0, 1};
            const FineVertex centre = s.origin[s.fine.mesh.cell(child)[opposite[k]].index()];
            EXPECT_EQ(centre.kind, FineVertex::Kind::body);
            EXPECT_EQ(centre.index, c.value());
        }
    }
}

TEST_P(SubdivisionOf, FeaturesAndBoundaryAreInherited) {
    const LevelMesh coarse = sample_level(GetParam());
    const LevelMesh fine = subdivide(coarse).fine;
    EXPECT_EQ(fine.features.sharp_edge_count(), 2 * coarse.features.sharp_edge_count());
    EXPECT_EQ(fine.boundary.size(), 4 * coarse.boundary.size());
    // On a mesh of the whole solid, what is inherited is what would be found anew.
    const hex::BoundaryQuads found = hex::boundary_quads(fine.mesh);
    EXPECT_EQ(fine.boundary.half_faces, found.half_faces);
    EXPECT_EQ(fine.boundary.on_boundary, found.on_boundary);
    EXPECT_EQ(fine.edges.boundary, hex::edge_table(fine.mesh).boundary);
    const hex::FeatureSet classes = hex::classify(fine.edges, fine.boundary, fine.features.sharp_edge);
    EXPECT_EQ(fine.features.vertex, classes.vertex);
    EXPECT_EQ(std::count(fine.open_vertex.begin(), fine.open_vertex.end(), 1), 0);
}

TEST_P(SubdivisionOf, PartOfTheMeshHasTheSameStencilsAsTheWhole) {
    const LevelMesh coarse = sample_level(GetParam());
    const Subdivision whole = subdivide(coarse);
    std::map<std::pair<int, std::uint32_t>, std::size_t> place;
    for (std::size_t v = 0; v < whole.origin.size(); ++v)
        place[{static_cast<int>(whole.origin[v].kind), whole.origin[v].index}] = v;
    const Hierarchy h = build_hierarchy(coarse, {{0, 1, 2}}, false);
    ASSERT_EQ(h.levels.size(), 2U);
    const Subdivision part = subdivide(coarse, h.levels[0].refined, h.levels[0].buffer);
    for (std::size_t v = 0; v < part.origin.size(); ++v) {
        const auto same = place.at({static_cast<int>(part.origin[v].kind), part.origin[v].index});
        EXPECT_EQ(difference(as_row(part.coefficients[v]), as_row(whole.coefficients[same])), 0.0);
    }
}

TEST(Subdivision, CountsOfAGrid) {
    const Subdivision s = subdivide(level_of(hex::test::grid(2, 3, 4), true));
    EXPECT_EQ(s.fine.mesh.vertex_count(), 5U * 7U * 9U);
    EXPECT_EQ(s.fine.mesh.cell_count(), 8U * 24U);
    // A sharp box stays the box: its corners, edges and faces do not move.
    const hex::BoundingBox box = hex::bounding_box(s.fine.mesh);
    EXPECT_EQ(box.lower, hex::Vec3(0, 0, 0));
    EXPECT_EQ(box.upper, hex::Vec3(2, 3, 4));
}

}  // namespace
}  // namespace spline::test
