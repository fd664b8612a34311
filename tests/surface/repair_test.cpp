#include "support/meshes.h"

#include <hex/base/error.h>
#include <hex/surface/repair.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace hex {
namespace {

PolygonSoup box() {
    return test::box_surface(3, 2, 1, 4);
}

/// The polygons for which `keep` holds, each with points of its own when `apart`.
PolygonSoup copy(const PolygonSoup& soup, const std::function<bool(std::size_t)>& keep, bool apart = false) {
    PolygonSoup result;
    if (!apart) result.points = soup.points;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        if (!keep(f)) continue;
        std::vector<std::uint32_t> corners(soup.polygon(f).begin(), soup.polygon(f).end());
        if (apart)
            for (std::uint32_t& corner : corners) {
                result.points.push_back(soup.points[corner]);
                corner = static_cast<std::uint32_t>(result.points.size() - 1);
            }
        result.add_polygon(corners, soup.parts[f]);
    }
    return result;
}

bool all(std::size_t) {
    return true;
}

void expect_box(const PolygonSoup& soup) {
    const TriangleMesh mesh = make_triangle_mesh(soup);
    EXPECT_NEAR(enclosed_volume(mesh), 6.0, 1e-12);
    EXPECT_EQ(std::set<int>(soup.parts.begin(), soup.parts.end()), (std::set<int>{1, 2, 3, 4, 5, 6}));
}

TEST(Repair, LeavesAGoodSurfaceAlone) {
    PolygonSoup soup = box();
    const RepairReport report = repair(soup);
    EXPECT_FALSE(report.changed());
    EXPECT_TRUE(describe(report).empty());
    EXPECT_EQ(soup.points, box().points);
    EXPECT_EQ(soup.corners.size(), box().corners.size());
    EXPECT_EQ(soup.parts, box().parts);
    expect_box(soup);
}

TEST(Repair, MergesThePointsOfATriangleSoup) {
    PolygonSoup soup = copy(box(), all, true);
    EXPECT_THROW(make_triangle_mesh(soup), Error);
    const RepairReport report = repair(soup);
    EXPECT_EQ(report.merged_points, 3 * box().size() - box().points.size());
    EXPECT_EQ(describe(report).size(), 1U);
    expect_box(soup);
}

TEST(Repair, TurnsWhatIsOrientedAgainstTheRest) {
    PolygonSoup soup = box();
    for (const std::size_t f : {3U, 17U, 40U})
        std::swap(soup.corners[soup.offsets[f]], soup.corners[soup.offsets[f] + 1]);
    EXPECT_THROW(make_triangle_mesh(soup), Error);
    EXPECT_EQ(repair(soup).turned_polygons, 3U);
    expect_box(soup);
}

TEST(Repair, TurnsASurfaceThatIsInsideOut) {
    PolygonSoup soup = box();
    for (std::size_t f = 0; f < soup.size(); ++f)
        std::swap(soup.corners[soup.offsets[f]], soup.corners[soup.offsets[f] + 1]);
    EXPECT_EQ(repair(soup).turned_polygons, box().size());
    expect_box(soup);
}

TEST(Repair, RemovesWhatIsDegenerateTwiceOrUnused) {
    PolygonSoup soup = box();
    soup.points.emplace_back(7, 7, 7);
    soup.add_polygon(std::array<std::uint32_t, 3>{0, 0, 1}, 9);
    soup.add_polygon(soup.polygon(5), 9);
    const RepairReport report = repair(soup);
    EXPECT_EQ(report.unused_points, 1U);
    EXPECT_EQ(report.degenerate_polygons, 1U);
    EXPECT_EQ(report.duplicate_polygons, 1U);
    EXPECT_EQ(describe(report).size(), 3U);
    expect_box(soup);
}

TEST(Repair, FillsSmallHolesAndTellsOfLargeOnes) {
    PolygonSoup soup = copy(box(), [](std::size_t f) { return f != 7 && f != 8 && f != 30; });
    RepairReport report = repair(soup);
    EXPECT_GE(report.filled_holes, 2U);
    EXPECT_EQ(report.filling_triangles, 3U);
    EXPECT_EQ(report.holes_left, 0U);
    expect_box(soup);

    // The whole lid: its border is 10, the diagonal 3.7.
    soup = copy(box(), [](std::size_t f) { return box().parts[f] != 5; });
    report = repair(soup);
    EXPECT_EQ(report.filled_holes, 0U);
    EXPECT_EQ(report.holes_left, 1U);
    EXPECT_EQ(describe(report).back().severity, Severity::warning);
    EXPECT_THROW(make_triangle_mesh(soup), Error);
    EXPECT_EQ(repair(soup, {.longest_hole = 3}).filled_holes, 1U);
    EXPECT_NEAR(enclosed_volume(make_triangle_mesh(soup)), 6.0, 1e-12);
}

/// Two boxes that touch in one point, and in an edge.
TEST(Repair, SplitsWhatIsNotManifold) {
    for (const Vec3& shift : {Vec3(3, 2, 1), Vec3(3, 2, 0)}) {
        PolygonSoup soup = box();
        const PolygonSoup other = box();
        const auto first = static_cast<std::uint32_t>(soup.points.size());
        for (const Vec3& p : other.points) soup.points.push_back(p + shift);
        for (std::size_t f = 0; f < other.size(); ++f) {
            const auto t = other.polygon(f);
            soup.add_polygon(std::array{t[0] + first, t[1] + first, t[2] + first}, other.parts[f]);
        }
        const RepairReport report = repair(soup);
        EXPECT_GT(report.merged_points, 0U);
        EXPECT_GT(report.split_points, 0U);
        EXPECT_NEAR(enclosed_volume(make_triangle_mesh(soup)), 12.0, 1e-12);
    }
}

/// A cube of squares, two of which are split along a bent path: its inner points have two polygons each.
TEST(Repair, RemovesPointsThatHaveTwoPolygonsOnly) {
    PolygonSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},   {0, 1, 0},   {0, 0, 1},  {1, 0, 1},
                   {1, 1, 1}, {0, 1, 1}, {.5, .4, 1}, {.5, .6, 1}, {.5, .5, 0}};
    const auto add = [&](std::vector<std::uint32_t> corners, int part) { soup.add_polygon(corners, part); };
    add({4, 5, 6, 9, 8}, 1);
    add({4, 8, 9, 6, 7}, 1);
    add({0, 3, 2, 10}, 2);
    add({0, 10, 2, 1}, 2);
    add({0, 1, 5, 4}, 3);
    add({2, 3, 7, 6}, 4);
    add({1, 2, 6, 5}, 5);
    add({0, 4, 7, 3}, 6);
    EXPECT_THROW(make_triangle_mesh(soup), Error);
    const RepairReport report = repair(soup);
    EXPECT_EQ(report.removed_points, 3U);
    EXPECT_TRUE(report.changed());
    ASSERT_EQ(describe(report).size(), 1U);
    EXPECT_EQ(describe(report)[0].code, "repair-doublet");
    EXPECT_EQ(soup.points.size(), 8U);
    EXPECT_EQ(soup.size(), 8U);
    EXPECT_EQ(std::set<int>(soup.parts.begin(), soup.parts.end()), (std::set<int>{1, 2, 3, 4, 5, 6}));
    EXPECT_NEAR(enclosed_volume(make_triangle_mesh(soup)), 1.0, 1e-12);
}

/// Point 4 lies between two squares whose corners 0 and 1 have an edge on the other side, too: without the
/// point that edge would have four polygons.
TEST(Repair, KeepsAPointWhoseNeighboursAreJoinedElsewhere) {
    PolygonSoup soup;
    soup.points = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, .3, -1}, {1, -.3, -1}};
    const auto add = [&](std::vector<std::uint32_t> corners) { soup.add_polygon(corners); };
    add({0, 4, 1, 2});
    add({1, 4, 0, 3});
    add({0, 2, 5});
    add({2, 1, 5});
    add({1, 0, 5});
    add({1, 3, 6});
    add({3, 0, 6});
    add({0, 1, 6});
    const RepairReport report = repair(soup);
    EXPECT_EQ(report.removed_points, 0U);
    EXPECT_EQ(report.holes_left, 0U);
    try {
        make_triangle_mesh(soup);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        EXPECT_NE(std::string(error.what()).find("at vertices 4"), std::string::npos) << error.what();
    }
}

TEST(Repair, NothingToMakeASurfaceOf) {
    PolygonSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}};
    soup.add_polygon(std::array<std::uint32_t, 3>{0, 1, 1});
    EXPECT_THROW(repair(soup), Error);
}

}  // namespace
}  // namespace hex
