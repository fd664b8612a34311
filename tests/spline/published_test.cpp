/// Splines of published meshes: of the paper's models, and made by others' programs.

#include "spline_samples.h"
#include "support/test_files.h"

#include <hex/io/hex_file.h>
#include <spline/hierarchy.h>
#include <spline/jacobian.h>
#include <spline/repair.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

namespace spline::test {
namespace {

class SplineOfPublished : public testing::TestWithParam<const char*> {
  protected:
    /// Functions, and every Jacobian proved positive after mending.
    static void expect_sound(SplineResult result) {
        EXPECT_LE(result.report.summary.partition_of_unity_error, 1e-14);
        EXPECT_GT(result.report.summary.smallest_coefficient, 0.0) << "zeros are not stored";
        JacobianReport verdict = certify(result.spline);
        repair_jacobian(result.spline, verdict);
        EXPECT_TRUE(verdict.proved());
        EXPECT_EQ(verdict.positive, result.spline.element_count());
    }
};
INSTANTIATE_TEST_SUITE_P(Meshes, SplineOfPublished,
                         testing::Values("paper/rod/rod_hex.vtk", "paper/hepta/hepta_hex.vtk",
                                         "hex/medial_beam.mesh", "hex/medial_bird.mesh"),
                         [](const auto& parameter) {
                             return std::filesystem::path(parameter.param).stem().string();
                         });

TEST_P(SplineOfPublished, IsSoundAtLevelZeroAndWithTheWorstElementsRefined) {
    HEX_NEEDS_REFERENCE_DATA();
    const hex::HexMesh mesh = hex::io::read_hex_mesh(hex::test::reference_data() / GetParam()).mesh;
    expect_sound(build(mesh));

    SplineOptions options;
    options.regions = {parse_region("worst:5%")};
    SplineResult refined = build(mesh, options);
    ASSERT_EQ(refined.report.levels.size(), 2U);
    std::vector<std::int64_t> list;
    for (const hex::CellId c : refined.levels[0].refined) list.push_back(c.value());
    EXPECT_GE(list.size(), (mesh.cell_count() + 19) / 20);
    expect_sound(std::move(refined));
    // The same elements are refined again: closure has nothing to add.
    const Hierarchy hierarchy = build_hierarchy(level_of(mesh, false), {list}, true);
    EXPECT_EQ(hierarchy.added[0], 0U);
    EXPECT_LE(interface_jump(hierarchy), 1e-14);
}

}  // namespace
}  // namespace spline::test
