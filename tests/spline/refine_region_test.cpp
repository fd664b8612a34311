#include "spline_samples.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/surface/polygon_soup.h>
#include <spline/fit.h>
#include <spline/refine_region.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace spline::test {
namespace {

std::vector<std::int64_t> chosen(const std::string& text, const LevelMesh& level) {
    return elements_in(parse_region(text), level, level.mesh.cell_count());
}

TEST(RefineRegion, ChoosesByPlace) {
    const LevelMesh level = level_of(hex::test::grid(4, 4, 4), true);
    EXPECT_EQ(chosen("box:0.2,0.2,0.2,1.5,0.8,0.8", level), (std::vector<std::int64_t>{0, 1}));
    EXPECT_EQ(chosen("box:1.5,0.8,0.8,0.2,0.2,0.2", level), (std::vector<std::int64_t>{0, 1}));
    EXPECT_EQ(chosen("sphere:0.5,0.5,0.5,0.4", level), (std::vector<std::int64_t>{0}));
    EXPECT_EQ(chosen("sphere:0.5,0.5,0.5,0.6", level).size(), 4U);
    EXPECT_TRUE(chosen("box:9,9,9,10,10,10", level).empty());
}

TEST(RefineRegion, ChoosesNearPointsAndAtPatches) {
    const LevelMesh level = level_of(hex::test::grid(4, 4, 4), true);
    const hex::test::TemporaryFolder folder;
    std::ofstream(folder / "points") << "# two places\n0.5 0.5 0.5\n\n9 9 9 # outside\n";
    EXPECT_EQ(chosen("near:" + (folder / "points").string(), level), (std::vector<std::int64_t>{0, 63}));
    std::ofstream(folder / "patches") << "0\n";
    EXPECT_EQ(chosen("near:" + (folder / "patches").string() + ":2", level).size(), 16U);
    std::ofstream(folder / "wrong") << "1 2\n";
    EXPECT_THROW(parse_region("near:" + (folder / "wrong").string()), hex::Error);
    EXPECT_THROW(parse_region("near:" + (folder / "missing").string()), hex::Error);
}

TEST(RefineRegion, ChoosesTheWorstElements) {
    hex::HexMesh mesh = hex::test::grid(4, 4, 4);
    mesh.set_position(hex::VertexId(0), hex::Vec3(0.3, 0.3, 0.3));
    const LevelMesh level = level_of(mesh, true);
    EXPECT_EQ(chosen("worst:1%", level), (std::vector<std::int64_t>{0}));
    EXPECT_EQ(chosen("worst:5%", level).size(), 4U);
    EXPECT_EQ(chosen("worst:100%", level).size(), 64U);
}

TEST(RefineRegion, NonsenseIsRefused) {
    for (const std::string text :
         {"", "box", "box:1,2,3", "box:1,2,3,4,5,x", "sphere:0,0,0,-1", "worst:5", "worst:0%", "worst:101%",
          "near:", "tube:1,2", "worst-fit:5", "worst-fit:0%", "sphere:0,0,0,1:0", "sphere:0,0,0,1:x"}) {
        EXPECT_THROW(parse_region(text), hex::Error) << text;
    }
}

TEST(RefineRegion, LevelsFollowEachOther) {
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.regions = {parse_region("sphere:3,3,3,0.4:2")};
    const SplineResult result = build(hex::test::grid(6, 6, 6), options);
    ASSERT_EQ(result.report.levels.size(), 3U);
    EXPECT_EQ(result.report.levels[0].refined, 8U);
    EXPECT_EQ(result.report.levels[1].refined, 8U);
    EXPECT_LE(result.report.summary.partition_of_unity_error, 1e-14);
    // With a list that names the same elements.
    SplineOptions listed;
    listed.features = options.features;
    for (std::int64_t k = 2; k < 4; ++k)
        for (std::int64_t j = 2; j < 4; ++j)
            for (std::int64_t i = 2; i < 4; ++i) {
                if (listed.refinement.empty()) listed.refinement.resize(1);
                listed.refinement[0].push_back(i + 6 * (j + 6 * k));
            }
    options.regions[0].level = 1;
    EXPECT_EQ(build(hex::test::grid(6, 6, 6), options).spline.rows.values,
              build(hex::test::grid(6, 6, 6), listed).spline.rows.values);
}

/// A box with a bump on its upper side, at (7, 2).
hex::TriangleMesh box_with_bump() {
    hex::PolygonSoup soup = hex::test::box_surface(9, 9, 3, 18);
    for (hex::Vec3& p : soup.points) {
        if (p.z() == 3.0) p.z() += 0.5 * std::exp(-(p - hex::Vec3(7, 2, 3)).squaredNorm());
    }
    return hex::make_triangle_mesh(soup);
}

TEST(RefineRegion, ChoosesWhereTheSplineIsFarthestFromThePart) {
    const hex::HexMesh mesh = hex::test::grid(9, 9, 3);
    const hex::TriangleMesh part = box_with_bump();
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.regions = {parse_region("worst-fit:2%")};
    EXPECT_THROW(build(mesh, options), hex::Error) << "without a part nobody knows";

    std::vector<std::size_t> asked;
    options.closure = false;
    options.fit_errors = [&](const BezierSpline& s) {
        asked.push_back(s.element_count());
        return fit_errors(s, part);
    };
    const SplineResult result = build(mesh, options);
    EXPECT_EQ(asked, std::vector<std::size_t>{243U});
    ASSERT_EQ(result.levels[0].refined.size(), 5U) << "2 % of 243, rounded up";
    for (const hex::CellId c : result.levels[0].refined) {
        const hex::Vec3 centre = mesh.position(mesh.corner(c, 0)) + 0.5 * hex::Vec3::Ones();
        EXPECT_EQ(centre.z(), 2.5);
        EXPECT_LT((centre - hex::Vec3(7, 2, 2.5)).norm(), 2.0);
    }
    // A finer level is judged on the spline that the coarser one gives.
    options.regions = {parse_region("worst-fit:2%:2")};
    const SplineResult finer = build(mesh, options);
    ASSERT_EQ(asked.size(), 3U);
    EXPECT_EQ(asked[2], 243U + 5U * 7U);
    ASSERT_EQ(finer.levels.size(), 3U);
    EXPECT_EQ(finer.levels[1].refined.size(), 1U) << "2 % of 40";
}

TEST(RefineRegion, InnerElementsAreNotOffThePart) {
    const BezierSpline s = build(hex::test::grid(3, 3, 3)).spline;
    const auto errors = fit_errors(s, hex::make_triangle_mesh(hex::test::box_surface(3, 3, 3, 2)));
    for (std::size_t e = 0; e < errors.size(); ++e) {
        if (e == 13)
            EXPECT_EQ(errors[e], -1.0);
        else
            EXPECT_GE(errors[e], 0.0) << e;
    }
    EXPECT_GT(errors[0], 0.1) << "the smooth spline shrinks away from corners";
}

TEST(RefineRegion, ClosureIsTold) {
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.global_refinements = 1;
    options.regions = {parse_region("worst:1%")};
    const SplineReport report = build(hex::test::fan(5, 2), options).report;
    ASSERT_EQ(report.levels.size(), 2U);
    EXPECT_EQ(report.levels[0].refined, 1U + report.levels[0].added_by_closure);
}

}  // namespace
}  // namespace spline::test
