/// The published polycube surfaces: corner, edge and face lists of rod, counts of the other models.
#include "support/test_files.h"

#include <hex/io/list_file.h>
#include <hex/io/surface_file.h>
#include <hex/polycube/polycube.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace hex {
namespace {

TriangleMesh patched(const std::string& model) {
    return make_triangle_mesh(
        io::read_surface(test::reference_data() / "paper" / model / (model + "_initial_read.k")).soup);
}

/// The integers of each line; commas count as blanks, a line ends at what is no integer.
std::vector<std::vector<int>> integer_rows(const std::filesystem::path& path) {
    std::istringstream text(test::read_text(path));
    std::vector<std::vector<int>> rows;
    for (std::string line; std::getline(text, line);) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream numbers(line);
        std::vector<int> row;
        for (int number = 0; numbers >> number;) row.push_back(number);
        if (!row.empty()) rows.push_back(row);
    }
    return rows;
}

class PublishedPolycube : public testing::Test {
  protected:
    void SetUp() override {
        HEX_NEEDS_REFERENCE_DATA();
        stem = (test::reference_data() / "paper/rod/published/rod_polycube_structure").string();
        result = polycube(patched("rod"));
    }
    std::string stem;
    PolycubeResult result;
};

TEST_F(PublishedPolycube, RodHasThePublishedCornersEdgesAndFacesInTheirOrder) {
    EXPECT_EQ(result.report.patches, 62U);
    EXPECT_EQ(result.report.corners, 60U);
    EXPECT_TRUE(result.report.violations.empty());

    std::vector<std::vector<int>> quads, edges;
    for (const auto& q : result.polycube.quads) quads.emplace_back(q.begin(), q.end());
    for (const auto& e : result.polycube.edges) edges.emplace_back(e.begin(), e.end());
    EXPECT_EQ(quads, integer_rows(stem + "_face.txt"));
    EXPECT_EQ(edges, integer_rows(stem + "_edge.txt"));
    const auto corners = integer_rows(stem + "_corner.txt");
    ASSERT_EQ(corners.size(), 60U);
    for (std::size_t c = 0; c < 60; ++c) EXPECT_EQ(corners[c][0], result.polycube.corners[c]);
}

TEST_F(PublishedPolycube, RodSurfaceEqualsThePublishedQuads) {
    const auto published = io::read_surface(stem + ".k").soup;
    const PolygonSoup ours = polycube_surface(result.polycube);
    EXPECT_EQ(ours.corners, published.corners);
    EXPECT_EQ(ours.parts, published.parts);
    ASSERT_EQ(ours.points.size(), published.points.size());
    for (std::size_t p = 0; p < ours.points.size(); ++p)
        EXPECT_LE((ours.points[p] - published.points[p]).norm(), 1e-4);  // published with six digits
}

TEST_F(PublishedPolycube, TheTextFilesReadBackAsThePublishedOnes) {
    const test::TemporaryFolder folder;
    const Polycube& cube = result.polycube;
    io::write_corner_list(folder / "corner.txt", cube.corners, cube.corner_points);
    io::write_edge_list(folder / "edge.txt", cube.edges);
    io::write_face_list(folder / "face.txt", cube.quads);
    EXPECT_EQ(integer_rows(folder / "edge.txt"), integer_rows(stem + "_edge.txt"));
    EXPECT_EQ(integer_rows(folder / "face.txt"), integer_rows(stem + "_face.txt"));
    std::istringstream ours(test::read_text(folder / "corner.txt"));
    std::istringstream theirs(test::read_text(stem + "_corner.txt"));
    double a = 0, b = 0;
    int count = 0;
    while (theirs >> b) {
        ASSERT_TRUE(ours >> a);
        EXPECT_NEAR(a, b, 1e-4);
        ++count;
    }
    EXPECT_EQ(count, 240);
    EXPECT_FALSE(ours >> a);
}

struct Counted {
    const char* model;
    std::size_t patches, corners;
};

class PublishedLayout : public testing::TestWithParam<Counted> {};

TEST_P(PublishedLayout, HasThePublishedNumbersOfPatchesAndCorners) {
    HEX_NEEDS_REFERENCE_DATA();
    const auto result = polycube(patched(GetParam().model));
    EXPECT_EQ(result.report.patches, GetParam().patches);
    EXPECT_EQ(result.report.corners, GetParam().corners);
    EXPECT_EQ(result.report.invalid_patches, 0U);
    EXPECT_TRUE(result.report.violations.empty());
}

INSTANTIATE_TEST_SUITE_P(Paper, PublishedLayout,
                         testing::Values(Counted{"rod", 62, 60}, Counted{"hepta", 144, 146},
                                         Counted{"mount1", 164, 158}, Counted{"fertility", 114, 108},
                                         Counted{"ant", 174, 176}, Counted{"joint", 168, 168}),
                         [](const auto& model) { return std::string(model.param.model); });

}  // namespace
}  // namespace hex
