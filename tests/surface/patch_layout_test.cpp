#include "support/meshes.h"
#include "support/test_files.h"

#include <hex/io/surface_file.h>
#include <hex/surface/patch_layout.h>
#include <hex/surface/polygon_soup.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace hex {
namespace {

std::set<std::string> codes(const Diagnostics& diagnostics) {
    std::set<std::string> result;
    for (const auto& d : diagnostics) result.insert(d.code);
    return result;
}

TEST(PatchLayout, ABoxHasSixFourSidedPatches) {
    const TriangleMesh mesh = make_triangle_mesh(test::box_surface(1, 1, 1, 4));
    const PatchLayout layout = find_patches(mesh);
    ASSERT_EQ(layout.patches.size(), 6U);
    EXPECT_EQ(layout.corners.size(), 8U);
    EXPECT_TRUE(diagnose_layout(layout).empty());
    for (const Patch& patch : layout.patches) {
        EXPECT_TRUE(patch.four_sided);
        EXPECT_EQ(patch.triangles.size(), 32U);
        ASSERT_EQ(patch.loops.size(), 1U);
        for (std::size_t c = 0; c < 4; ++c) {
            const Chain& chain = patch.loops[0][c];
            EXPECT_EQ(chain.size(), 5U);
            EXPECT_EQ(chain.front(), patch.corners[c]);
            EXPECT_EQ(chain.back(), patch.corners[(c + 1) % 4]);
        }
        // Counter-clockwise seen from outside: the loop's area vector points along the label's axis.
        const int label = patch.part - 1;
        Vec3 area = Vec3::Zero();
        for (std::size_t c = 1; c < 3; ++c) {
            const auto point = [&](std::size_t i) {
                return to_eigen(mesh.point(mesh.vertex_handle(static_cast<unsigned>(patch.corners[i]))));
            };
            area += 0.5 * (point(c) - point(0)).cross(point(c + 1) - point(0));
        }
        EXPECT_NEAR(area[label / 2], label % 2 == 0 ? 1.0 : -1.0, 1e-15);
    }
}

TEST(PatchLayout, EqualPartsThatDoNotTouchAreTwoPatches) {
    PolygonSoup soup = test::box_surface(1, 1, 1, 2);
    for (int& part : soup.parts) part = part == 2 ? 1 : part;  // -X gets the part of +X
    EXPECT_EQ(find_patches(make_triangle_mesh(soup)).patches.size(), 6U);
}

TEST(PatchLayout, OddPatchesAreDiagnosed) {
    // All one patch: closed.
    PolygonSoup soup = test::box_surface(1, 1, 1, 2);
    std::fill(soup.parts.begin(), soup.parts.end(), 1);
    EXPECT_EQ(codes(diagnose_layout(find_patches(make_triangle_mesh(soup)))),
              std::set<std::string>{"patch-closed"});

    // A belt around the box: an annulus, and two lids without corners.
    soup = test::box_surface(1, 1, 1, 2);
    for (int& part : soup.parts) part = part >= 5 ? part : 1;
    EXPECT_EQ(codes(diagnose_layout(find_patches(make_triangle_mesh(soup)))),
              (std::set<std::string>{"patch-loops", "patch-corners"}));

    // Two sides joined: six corners round them, and both neighbours that lose a corner keep three patches at
    // each end.
    soup = test::box_surface(1, 1, 1, 2);
    for (int& part : soup.parts) part = part == 3 ? 1 : part;
    const auto layout = find_patches(make_triangle_mesh(soup));
    ASSERT_EQ(layout.patches.size(), 5U);
    const auto joined = std::find_if(layout.patches.begin(), layout.patches.end(),
                                     [](const Patch& p) { return p.triangles.size() == 16; });
    ASSERT_NE(joined, layout.patches.end());
    EXPECT_EQ(joined->loops[0].size(), 4U);
    EXPECT_FALSE(diagnose_layout(layout).empty()) << "the two end patches have three corners only";
}

TEST(PatchLayout, ABoundaryThatPinchesAVertexIsDiagnosed) {
    // Two quads of the top that touch in one vertex, the second at the rim: the rest of the top passes that
    // vertex twice.
    PolygonSoup soup = test::box_surface(1, 1, 1, 3);
    std::vector<std::size_t> top;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        if (soup.parts[f] == 5) top.push_back(f);
    }
    ASSERT_EQ(top.size(), 18U);
    // Quads (1,1) and (2,2) of the 3 x 3: cells in the order a, b.
    for (const std::size_t quad : {4U, 8U}) {
        soup.parts[top[2 * quad]] = 7;
        soup.parts[top[2 * quad + 1]] = 7;
    }
    EXPECT_TRUE(codes(diagnose_layout(find_patches(make_triangle_mesh(soup)))).contains("patch-boundary"));
}

struct Published {
    const char* model;
    std::size_t patches;
    std::size_t corners;
};

class PublishedLayouts : public testing::TestWithParam<Published> {};

TEST_P(PublishedLayouts, HaveThePublishedCountsAndOnlyFourSidedPatches) {
    HEX_NEEDS_REFERENCE_DATA();
    const auto& p = GetParam();
    const auto path = test::reference_data() / "paper" / p.model / (std::string(p.model) + "_initial_read.k");
    const PatchLayout layout = find_patches(make_triangle_mesh(io::read_surface(path).soup));
    EXPECT_EQ(layout.patches.size(), p.patches);
    EXPECT_EQ(layout.corners.size(), p.corners);
    EXPECT_TRUE(diagnose_layout(layout).empty());
}

INSTANTIATE_TEST_SUITE_P(Paper, PublishedLayouts,
                         testing::Values(Published{"rod", 62, 60}, Published{"mount1", 164, 158},
                                         Published{"hepta", 144, 146}, Published{"ant", 174, 176},
                                         Published{"fertility", 114, 108}, Published{"joint", 168, 168}),
                         [](const auto& instance) { return std::string(instance.param.model); });

}  // namespace
}  // namespace hex
