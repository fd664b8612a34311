#include "spline_samples.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <spline/refine_region.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

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
          "near:", "tube:1,2", "sphere:0,0,0,1:0", "sphere:0,0,0,1:x"}) {
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
