#include "spline_samples.h"

#include <hex/base/error.h>

#include <gtest/gtest.h>

#include <numeric>

namespace spline::test {
namespace {

using hex::CellId;
using hex::VertexId;
using Lists = std::vector<std::vector<std::int64_t>>;

class HierarchyOf : public testing::TestWithParam<Sample> {};
INSTANTIATE_TEST_SUITE_P(Samples, HierarchyOf, testing::ValuesIn(samples()),
                         [](const auto& parameter) { return parameter.param.name; });

/// The elements around a vertex of element 0, some of their children, and one of the children of those.
Lists nested_lists(const LevelMesh& level) {
    Lists lists(3);
    const VertexId v = level.mesh.corner(CellId(0), 6);
    for (const CellId c : level.stars[v.index()]) lists[0].push_back(c.value());
    const auto children = static_cast<std::int64_t>(8 * lists[0].size());
    for (std::int64_t c = 0; c < children; c += 9) lists[1].push_back(c);
    lists[2] = {5};
    return lists;
}

/// Rows over functions of all active elements of level l.
template <class Visit>
void for_active_elements(const Hierarchy& hierarchy, const Visit& visit) {
    const auto truncation = truncation_operators(hierarchy);
    for (std::size_t l = 0; l < hierarchy.levels.size(); ++l) {
        const HierarchyLevel& level = hierarchy.levels[l];
        for (const CellId c : level.control.mesh.cells()) {
            if (level.element_active[c.index()] != 0)
                visit(l, c, times(blending_rows(level.control, c), truncation[l]));
        }
    }
}

std::vector<hex::Vec3> control_points(const Hierarchy& hierarchy) {
    std::vector<hex::Vec3> points;
    for (const HierarchyLevel& level : hierarchy.levels) {
        for (const VertexId v : level.control.mesh.vertices()) {
            if (level.function_active[v.index()] != 0) points.push_back(level.control.mesh.position(v));
        }
    }
    return points;
}

TEST_P(HierarchyOf, TruncatedFunctionsAreNonNegativeSumToOneAndKeepTheGeometry) {
    // The geometry is that of the subdivided mesh: for every Bezier point of every active element.
    for (const bool closure : {false, true}) {
        const LevelMesh coarsest = sample_level(GetParam());
        const Hierarchy h = build_hierarchy(coarsest, nested_lists(coarsest), closure);
        const auto points = control_points(h);
        for_active_elements(h, [&](std::size_t l, CellId c, const ElementRows& rows) {
            const ElementRows plain = blending_rows(h.levels[l].control, c);
            for (std::size_t p = 0; p < 64; ++p) {
                double least = 1.0;
                hex::Vec3 truncated = hex::Vec3::Zero(), subdivided = hex::Vec3::Zero();
                for (const auto& [function, value] : rows[p]) {
                    least = std::min(least, value);
                    truncated += value * points[function];
                }
                for (const auto& [v, value] : plain[p])
                    subdivided += value * h.levels[l].control.mesh.position(VertexId(v));
                EXPECT_GE(least, 0.0);
                EXPECT_NEAR(sum_of(rows[p]), 1.0, 2e-15);
                EXPECT_LE((truncated - subdivided).norm(), 2e-15 * (1.0 + subdivided.norm()));
            }
        });
    }
}

TEST_P(HierarchyOf, ClosureMakesTracesContinuous) {
    const LevelMesh level = sample_level(GetParam());
    const Hierarchy h = build_hierarchy(level, nested_lists(level), true);
    EXPECT_LE(interface_jump(h), 1e-15);
}

TEST_P(HierarchyOf, ClosureRefinesWholeStarsOfIrregularVertices) {
    const LevelMesh coarsest = sample_level(GetParam());
    const Hierarchy h = build_hierarchy(coarsest, nested_lists(coarsest), true);
    for (std::size_t l = 0; l + 1 < h.levels.size(); ++l) {
        const HierarchyLevel& level = h.levels[l];
        const auto regular = regular_vertices(level.control);
        std::vector<char> refined(level.control.mesh.cell_count(), 0);
        for (const CellId c : level.refined) refined[c.index()] = 1;
        for (const CellId e : level.refined) {
            for (const VertexId v : level.control.mesh.cell(e)) {
                for (const CellId c : level.control.stars[v.index()]) {
                    EXPECT_LT(c.index(), level.domain_cells);
                    EXPECT_TRUE(regular[v.index()] != 0 || refined[c.index()] != 0);
                }
            }
        }
    }
}

TEST_P(HierarchyOf, RefiningEverythingActivatesOnlyTheFinestLevel) {
    const LevelMesh level = sample_level(GetParam());
    std::vector<std::int64_t> all(level.mesh.cell_count());
    std::iota(all.begin(), all.end(), 0);
    const Hierarchy h = build_hierarchy(level, {all}, true);
    ASSERT_EQ(h.levels.size(), 2U);
    EXPECT_EQ(std::count(h.levels[0].function_active.begin(), h.levels[0].function_active.end(), 1), 0);
    EXPECT_EQ(h.function_count, subdivide(level).fine.mesh.vertex_count());
}

TEST(Hierarchy, WithoutClosureAFaceAtAnIrregularVertexJumps) {
    // Guards the continuity tests: the measure sees a jump where there is one.
    LevelMesh level = subdivide(level_of(hex::test::fan(5, 2), true)).fine;
    const auto regular = regular_vertices(level);
    std::int64_t irregular = -1;
    for (const CellId c : level.mesh.cells()) {
        for (const VertexId v : level.mesh.cell(c)) {
            if (regular[v.index()] == 0) irregular = c.value();
        }
    }
    ASSERT_GE(irregular, 0);
    EXPECT_GT(interface_jump(build_hierarchy(level, {{irregular}}, false)), 1e-2);
    EXPECT_LE(interface_jump(build_hierarchy(level, {{irregular}}, true)), 1e-15);
}

TEST(Hierarchy, ClosureFollowsTheWholeExtraordinaryChain) {
    // The paper's rod: one element at an extraordinary chain of four edges of valence 5 asks for all 5 x 4.
    const LevelMesh level = subdivide(level_of(hex::test::fan(5, 2), true)).fine;
    std::size_t around = 0;
    const auto regular = regular_vertices(level);
    std::int64_t first = -1;
    for (const CellId c : level.mesh.cells()) {
        const auto& corners = level.mesh.cell(c);
        const bool at_chain = std::any_of(corners.begin(), corners.end(), [&](VertexId v) {
            const auto edges = level.edges.vertex_edges[v.index()];
            return std::any_of(edges.begin(), edges.end(),
                               [&](hex::EdgeId e) { return level.is_extraordinary(e); });
        });
        if (!at_chain) continue;
        ++around;
        if (first < 0) first = c.value();
    }
    EXPECT_EQ(around, 20U);
    const Hierarchy h = build_hierarchy(level, {{first}}, true);
    EXPECT_EQ(h.levels[0].refined.size(), 20U);
    EXPECT_EQ(h.added, std::vector<std::size_t>{19});
    EXPECT_EQ(h.levels[0].refined[0].value(), first) << "listed elements come first";
}

TEST(Hierarchy, GradingRefinesParentsOfNeighbours) {
    // Child 0 of the corner element needs only that element; child 6 touches children of all eight around.
    const LevelMesh level = level_of(hex::test::grid(4, 4, 4), true);
    EXPECT_EQ(build_hierarchy(level, {{0}, {0}}, true).levels[0].refined.size(), 1U);
    const Hierarchy h = build_hierarchy(level, {{0}, {6}}, true);
    EXPECT_EQ(h.levels[0].refined.size(), 8U);
    EXPECT_EQ(h.levels[1].refined, std::vector<CellId>{CellId(6)});
    EXPECT_EQ(build_hierarchy(level, {{0}, {6}}, false).levels[0].refined.size(), 1U);
}

TEST(Hierarchy, ABlockOfTwoCubedInnerElementsGivesOneFunction) {
    const LevelMesh level = level_of(hex::test::grid(6, 6, 6), true);
    const auto cell = [](int i, int j, int k) { return i + 6 * (j + 6 * k); };
    Lists block(1);
    for (int i = 0; i < 8; ++i) block[0].push_back(cell(2 + i % 2, 2 + i / 2 % 2, 2 + i / 4));
    const Hierarchy h = build_hierarchy(level, block, true);
    EXPECT_EQ(std::count(h.levels[1].function_active.begin(), h.levels[1].function_active.end(), 1), 1);
    EXPECT_TRUE(h.diagnostics.empty());

    const Hierarchy lonely = build_hierarchy(level, {{cell(2, 2, 2)}}, true);
    EXPECT_EQ(std::count(lonely.levels[1].function_active.begin(), lonely.levels[1].function_active.end(), 1),
              0);
    ASSERT_EQ(lonely.diagnostics.size(), 1U);
    EXPECT_EQ(lonely.diagnostics[0].code, "no-new-function");
}

TEST(Hierarchy, SpacesAreNestedOnARegularMesh) {
    // On a regular mesh the truncated geometry is that of level 0, everywhere, to rounding.
    const LevelMesh level = level_of(hex::test::grid(4, 4, 4), true);
    const Hierarchy h =
        build_hierarchy(level, {{0, 1, 4, 5, 16, 17, 20, 21}, {0, 1, 2, 3, 4, 5, 6, 7}}, true);
    ASSERT_EQ(h.levels.size(), 3U);
    const auto points = control_points(h);
    for_active_elements(h, [&](std::size_t, CellId, const ElementRows& rows) {
        // The natural ends reproduce linear functions: the grid's Bezier points stay a tensor grid.
        hex::BoundingBox box;
        for (std::size_t p = 0; p < 64; ++p) {
            hex::Vec3 x = hex::Vec3::Zero();
            for (const auto& [function, value] : rows[p]) x += value * points[function];
            box.add(x);
        }
        const double size = (box.upper - box.lower).maxCoeff();
        EXPECT_NEAR(std::log2(size), std::round(std::log2(size)), 1e-13);
    });
}

TEST(Hierarchy, WrongListsAreNamed) {
    const LevelMesh level = level_of(hex::test::grid(3, 3, 3), true);
    try {
        build_hierarchy(level, {{0, 27, -1}}, true);
        FAIL();
    } catch (const hex::Error& error) {
        EXPECT_EQ(error.kind(), hex::ErrorKind::bad_input);
        EXPECT_NE(error.problem().find("27, -1"), std::string::npos);
    }
    try {
        build_hierarchy(level, {{0, 5}, {15, 16}}, true);
        FAIL();
    } catch (const hex::Error& error) {
        EXPECT_EQ(error.kind(), hex::ErrorKind::bad_input);
        EXPECT_NE(error.problem().find("parent is not refined: 16"), std::string::npos);
    }
    EXPECT_THROW(build_hierarchy(level, {{}, {0}}, true), hex::Error);
    const Hierarchy twice = build_hierarchy(level, {{3, 3}}, true);
    EXPECT_EQ(twice.diagnostics[0].code, "duplicate-refinement");
    EXPECT_EQ(twice.levels[0].refined.size(), 1U);
}

}  // namespace
}  // namespace spline::test
