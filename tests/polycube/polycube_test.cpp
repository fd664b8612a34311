#include "support/surfaces.h"

#include <hex/base/error.h>
#include <hex/polycube/polycube.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace hex {
namespace {

PolycubeResult polycube_of(const PolygonSoup& soup) {
    return polycube(make_triangle_mesh(soup));
}

std::vector<Diagnostic> of_code(const PolycubeResult& result, const std::string& code) {
    std::vector<Diagnostic> found;
    std::copy_if(result.report.violations.begin(), result.report.violations.end(), std::back_inserter(found),
                 [&](const Diagnostic& d) { return d.code == code; });
    return found;
}

/// The torus of 24 x 16 quads cut into `segments` around and four sides each.
PolygonSoup cut_torus(int segments) {
    const int around = 24, across = 16;
    PolygonSoup soup = test::torus(around, across);
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            const auto t = static_cast<std::size_t>(2 * (i * across + j));
            soup.parts[t] = soup.parts[t + 1] = 10 + 4 * (i * segments / around) + j / 4;
        }
    }
    return soup;
}

TEST(Polycube, ABoxIsItsOwnPolycube) {
    for (const int n : {1, 2, 5}) {
        const auto result = polycube_of(test::box_surface(3, 2, 1, n));
        const Polycube& cube = result.polycube;
        EXPECT_EQ(result.report.patches, 6U);
        EXPECT_EQ(result.report.corners, 8U);
        EXPECT_EQ(result.report.invalid_patches, 0U);
        EXPECT_TRUE(result.report.violations.empty());
        EXPECT_TRUE(std::is_sorted(cube.corners.begin(), cube.corners.end()));

        const PolygonSoup surface = polycube_surface(cube);
        ASSERT_EQ(surface.size(), 6U);
        ASSERT_EQ(surface.points.size(), 8U);
        const PolyMesh quads = make_poly_mesh(surface);  // closed, manifold, oriented
        EXPECT_NEAR(enclosed_volume(triangulate(quads)), 6.0, 1e-14);
        for (std::size_t q = 0; q < 6; ++q) EXPECT_EQ(surface.parts[q], static_cast<int>(q) + 1);
    }
}

TEST(Polycube, EdgesAreListedFourAPatchAndEachOneTwice) {
    const auto result = polycube_of(cut_torus(3));
    const Polycube& cube = result.polycube;
    ASSERT_EQ(cube.quads.size(), 12U);
    ASSERT_EQ(cube.edges.size(), 48U);
    std::map<std::array<int, 2>, int> uses;
    for (std::size_t q = 0; q < cube.quads.size(); ++q) {
        const auto& c = cube.quads[q];
        const std::array<std::array<int, 2>, 4> expected = {
            {{c[0], c[1]}, {c[1], c[2]}, {c[2], c[3]}, {c[0], c[3]}}};
        for (std::size_t k = 0; k < 4; ++k) {
            const auto [low, high] = std::minmax(expected[k][0], expected[k][1]);
            EXPECT_EQ(cube.edges[4 * q + k], (std::array{low, high}));
            ++uses[cube.edges[4 * q + k]];
        }
    }
    EXPECT_EQ(uses.size(), 24U);
    for (const auto& [edge, count] : uses) EXPECT_EQ(count, 2);
}

TEST(Polycube, CornerPointsAreThoseOfTheMesh) {
    const PolygonSoup soup = cut_torus(3);
    const auto cube = polycube_of(soup).polycube;
    ASSERT_EQ(cube.corners.size(), cube.corner_points.size());
    for (std::size_t c = 0; c < cube.corners.size(); ++c)
        EXPECT_EQ(cube.corner_points[c], soup.points[static_cast<std::size_t>(cube.corners[c])]);
}

TEST(Polycube, PatchesOnTheSameFourCornersAreForbidden) {
    EXPECT_TRUE(polycube_of(cut_torus(3)).report.violations.empty());
    const auto result = polycube_of(cut_torus(2));
    EXPECT_EQ(result.report.invalid_patches, 0U);  // each one alone is as it should be
    const auto twins = of_code(result, "patches-share-all-corners");
    ASSERT_EQ(twins.size(), 4U);
    for (const auto& d : twins) {
        EXPECT_EQ(d.severity, Severity::error);
        EXPECT_EQ(d.entity, "patch");
        EXPECT_EQ(d.ids.size(), 2U);
    }
    // The four lines along the torus run from cut to cut on either side.
    EXPECT_EQ(of_code(result, "edge-not-unique").size(), 4U);
}

TEST(Polycube, AnAnnulusIsNamed) {
    PolygonSoup box = test::box_surface(3, 3, 3, 3);
    const std::size_t middle = 2 * (4 * 9 + 4);  // the quad in the middle of +Z
    box.parts[middle] = box.parts[middle + 1] = 7;
    const auto result = polycube_of(box);
    EXPECT_EQ(result.report.invalid_patches, 2U);
    ASSERT_EQ(of_code(result, "patch-loops").size(), 1U);
    EXPECT_EQ(of_code(result, "patch-loops")[0].ids, std::vector<std::int64_t>{4});
    ASSERT_EQ(of_code(result, "patch-corners").size(), 1U);  // the island has none
    EXPECT_EQ(of_code(result, "patch-corners")[0].ids, std::vector<std::int64_t>{5});
    EXPECT_EQ(result.polycube.quads[4], (std::array{-1, -1, -1, -1}));
    EXPECT_THROW(polycube_surface(result.polycube), Error);
}

TEST(Polycube, AThreeCorneredPatchIsNamedWithItsVertices) {
    PolygonSoup box = test::box_surface(1, 1, 1, 2);
    for (int& part : box.parts) part = part == 3 ? 1 : part;  // +X and +Y in one patch
    const auto result = polycube_of(box);
    EXPECT_EQ(result.report.patches, 5U);
    EXPECT_EQ(result.report.corners, 6U);
    EXPECT_EQ(result.report.invalid_patches, 2U);  // +Z and -Z
    const auto found = of_code(result, "patch-corners");
    ASSERT_EQ(found.size(), 2U);
    for (const auto& d : found) {
        EXPECT_NE(d.message.find("3 corners"), std::string::npos) << d.message;
        const auto patch = static_cast<std::size_t>(d.ids.at(0));
        for (const Chain& chain : result.polycube.layout.patches[patch].loops[0])
            EXPECT_NE(d.message.find(std::to_string(chain.front())), std::string::npos) << d.message;
    }
}

TEST(Polycube, OneClosedPatchIsNamed) {
    PolygonSoup box = test::box_surface(1, 1, 1);
    std::fill(box.parts.begin(), box.parts.end(), 9);
    const auto result = polycube_of(box);
    ASSERT_EQ(result.report.violations.size(), 1U);
    EXPECT_EQ(result.report.violations[0].code, "patch-closed");
}

TEST(Polycube, OppositeLabelsThatTouchAreForbidden) {
    // A box with its top folded to a roof that meets the floor along one line: +Z and -Z share an edge.
    PolygonSoup wedge;
    wedge.points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 1}, {0, 2, 1}};
    test::add_triangle(wedge, 0, 3, 2, 6);
    test::add_triangle(wedge, 0, 2, 1, 6);
    test::add_triangle(wedge, 4, 1, 2, 5);
    test::add_triangle(wedge, 4, 2, 5, 5);
    test::add_triangle(wedge, 0, 4, 5, 2);
    test::add_triangle(wedge, 0, 5, 3, 2);
    test::add_triangle(wedge, 0, 1, 4, 4);
    test::add_triangle(wedge, 3, 5, 2, 3);
    const auto found = of_code(polycube_of(wedge), "opposite-labels-adjacent");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].ids, (std::vector<std::int64_t>{0, 1}));
    EXPECT_NE(found[0].message.find("vertices 1, 2"), std::string::npos) << found[0].message;

    // The same shape with patch numbers that are no labels is not asked.
    for (int& part : wedge.parts) part += 1;
    EXPECT_TRUE(of_code(polycube_of(wedge), "opposite-labels-adjacent").empty());
}

TEST(Polycube, PatchNumbersOneToSixInAnyOrderAreNotTakenForLabels) {
    PolygonSoup box = test::box_surface(1, 1, 1, 2);
    for (int& part : box.parts) part = part == 2 ? 3 : part == 3 ? 2 : part;  // -X and +Y swapped
    EXPECT_TRUE(polycube_of(box).report.violations.empty());
}

TEST(Polycube, OptionsThatMakeNoSenseAreRefused) {
    EXPECT_THROW(polycube(make_triangle_mesh(test::box_surface(1, 1, 1)), {.method = "no such method"}),
                 Error);
    EXPECT_THROW(polycube(TriangleMesh()), Error);
    EXPECT_TRUE(polycube_builders().contains("patches"));
}

}  // namespace
}  // namespace hex
