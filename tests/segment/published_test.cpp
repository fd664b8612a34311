/// Labels of the published rod, triangle by triangle.
#include "support/test_files.h"

#include <hex/io/list_file.h>
#include <hex/io/surface_file.h>
#include <hex/segment/segment.h>

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>

namespace hex {
namespace {

SegmentOptions hbecvt() {
    SegmentOptions options;
    options.method = "hbecvt";
    return options;
}

class PublishedRod : public testing::Test {
  protected:
    void SetUp() override {
        HEX_NEEDS_REFERENCE_DATA();
        folder = test::reference_data() / "paper" / "rod";
        mesh = make_triangle_mesh(io::read_surface(folder / "rod_tri.k").soup);
        ASSERT_EQ(mesh.n_faces(), 4480U);
    }

    /// The cell scalar of a published .vtk: the label, 0..5.
    std::vector<int> published(const std::string& name) const {
        std::istringstream text(test::read_text(folder / "published" / name));
        std::string word;
        while (text >> word && word != "LOOKUP_TABLE") {
        }
        text >> word;
        std::vector<int> labels;
        for (int label = 0; text >> label;) labels.push_back(label);
        EXPECT_EQ(labels.size(), 4480U);
        return labels;
    }

    std::filesystem::path folder;
    TriangleMesh mesh;
};

TEST_F(PublishedRod, LabelsAfterCvt) {
    SegmentOptions options;
    options.method = "cvt";
    const auto result = segment(mesh, options);
    EXPECT_EQ(result.segmentation.labels, published("rod_tri_output_CVT.vtk"));
    EXPECT_EQ(result.report.label_counts, (std::array<std::size_t, 6>{384, 371, 900, 894, 966, 965}));
    EXPECT_EQ(result.report.sweeps.size(), 2U);
}

TEST_F(PublishedRod, LabelsAfterHbecvtOfWeightOneTenth) {
    const auto result = segment(mesh, hbecvt());
    EXPECT_EQ(result.segmentation.labels, published("rod_tri_output_EWCVT.vtk"));
    ASSERT_EQ(result.report.sweeps.size(), 4U);
    EXPECT_EQ(result.report.sweeps[2].moves, 3U);
    EXPECT_EQ(result.report.sweeps[3].moves, 0U);
}

TEST_F(PublishedRod, LabelsAfterTheManualFile) {
    SegmentOptions options = hbecvt();
    for (const auto& entry : io::read_overrides(folder / "rod_manual.txt"))
        options.manual.push_back({entry.triangle, entry.label});
    const auto result = segment(mesh, options);
    EXPECT_EQ(result.segmentation.labels, published("rod_tri_output_EWCVT_edit.vtk"));
    EXPECT_EQ(result.report.manual_changes, 56U);

    const auto written = io::read_surface(folder / "published" / "rod_initial_write.k").soup;
    EXPECT_EQ(to_soup(with_labels(mesh, result.segmentation)).parts, written.parts);
}

/// Counts of an independent program (charts, boundaries, corners, charts with fewer than four boundaries) on
/// these labels.
struct Counted {
    const char* model;
    std::size_t charts, boundaries, corners, too_few;
};

class PublishedModel : public testing::TestWithParam<Counted> {};

TEST_P(PublishedModel, ChartsAreCountedAsByAnIndependentProgram) {
    HEX_NEEDS_REFERENCE_DATA();
    const Counted& expected = GetParam();
    const std::string name = expected.model;
    const auto result =
        segment(make_triangle_mesh(
                    io::read_surface(test::reference_data() / "paper" / name / (name + "_tri.k")).soup),
                hbecvt());
    EXPECT_EQ(result.report.charts, expected.charts);
    EXPECT_EQ(result.report.boundaries, expected.boundaries);
    EXPECT_EQ(result.report.corners, expected.corners);
    std::size_t too_few = 0;
    for (const auto& violation : result.report.violations)
        too_few += violation.code == "chart-too-few-boundaries";
    EXPECT_EQ(too_few, expected.too_few);
}

TEST_P(PublishedModel, ClassicalSweepsDoNotRaiseTheEnergy) {
    HEX_NEEDS_REFERENCE_DATA();
    const std::string name = GetParam().model;
    const auto result =
        segment(make_triangle_mesh(
                    io::read_surface(test::reference_data() / "paper" / name / (name + "_tri.k")).soup),
                hbecvt());
    const auto& sweeps = result.report.sweeps;
    for (std::size_t s = 1; s < sweeps.size(); ++s) {
        if (sweeps[s].phase != "cvt") break;
        EXPECT_LE(sweeps[s].energy, sweeps[s - 1].energy);
    }
}

INSTANTIATE_TEST_SUITE_P(Paper, PublishedModel,
                         testing::Values(Counted{"rod", 18, 48, 32, 0}, Counted{"mount1", 39, 105, 69, 2},
                                         Counted{"fertility", 55, 154, 95, 21},
                                         Counted{"ant", 102, 257, 157, 47}, Counted{"joint", 44, 103, 65, 8},
                                         Counted{"hepta", 17, 42, 28, 2}),
                         [](const auto& model) { return std::string(model.param.model); });

}  // namespace
}  // namespace hex
