/// The automatic method: what its labels promise on whole parts.
#include "support/surfaces.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/surface_file.h>
#include <hex/segment/charts.h>
#include <hex/segment/segment.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hex {
namespace {

/// Means, over the area, of the cosine between a normal and the axis of its label.
struct Faith {
    double mean = 0;      ///< with these labels
    double best = 0;      ///< with the nearest axes
    double backward = 0;  ///< share of the area where it is below -0.2
};

Faith faith_of(const TriangleMesh& mesh, const std::vector<int>& labels) {
    Faith faith;
    double total = 0;
    for (const auto f : mesh.faces()) {
        std::vector<Vec3> p;
        for (const auto v : mesh.fv_range(f)) p.push_back(to_eigen(mesh.point(v)));
        const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
        const double own = normal.dot(label_axis(labels[static_cast<std::size_t>(f.idx())]));
        faith.mean += own;
        faith.best += normal.cwiseAbs().maxCoeff();
        if (own < -0.2 * normal.norm()) faith.backward += normal.norm();
        total += normal.norm();
    }
    return {faith.mean / total, faith.best / total, faith.backward / total};
}

std::size_t errors_of(const SegmentResult& result) {
    return count_at_least(result.report.violations, Severity::error);
}

void expect_valid_and_faithful(const TriangleMesh& mesh, const SegmentResult& result) {
    EXPECT_EQ(errors_of(result), 0U);
    const Faith faith = faith_of(mesh, result.segmentation.labels);
    EXPECT_GE(faith.mean, 0.95 * faith.best);
    EXPECT_LT(faith.backward, 0.001);
}

TEST(SegmentAuto, AKnifeEdgeGetsAStripBetweenItsOppositeSides) {
    // A prism over a slender triangle: its slanted sides face +X and -X and meet in an edge.
    std::vector<Vec2> section;
    for (int i = 0; i <= 4; ++i) section.emplace_back(-2 + i, 0);
    for (int i = 1; i <= 16; ++i) section.emplace_back(2 - 2.0 * i / 16, 10.0 * i / 16);
    for (int i = 1; i < 16; ++i) section.emplace_back(-2.0 * i / 16, 10.0 - 10.0 * i / 16);
    const TriangleMesh mesh = make_triangle_mesh(test::prism(section, 4));
    const auto result = segment(mesh);
    expect_valid_and_faithful(mesh, result);
    EXPECT_GT(result.report.label_counts[2], 0U);
    EXPECT_FALSE(result.report.repairs.empty());
    for (const auto& repair : result.report.repairs) {
        EXPECT_FALSE(repair.repair.empty());
        EXPECT_FALSE(repair.reason.empty());
        EXPECT_GT(repair.triangles, 0U);
        EXPECT_GE(repair.triangle, 0);
        EXPECT_LT(repair.triangle, static_cast<std::int64_t>(mesh.n_faces()));
    }
}

TEST(SegmentAuto, AnyRotationOfATorusGetsValidLabels) {
    for (const double angle : {0.0, 0.3, 0.7, 1.1}) {
        PolygonSoup soup = test::torus(48, 24);
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()).toRotationMatrix();
        for (Vec3& p : soup.points) p = turn * p;
        const TriangleMesh mesh = make_triangle_mesh(soup);
        expect_valid_and_faithful(mesh, segment(mesh));
    }
}

TEST(SegmentAuto, TrianglesOfOnePolygonTakeOneLabel) {
    // A ball of quads: labels must not depend on how these were cut in two.
    PolygonSoup quads;
    const PolygonSoup ball = test::ball(9);
    quads.points = ball.points;
    for (std::size_t t = 0; t + 1 < ball.size(); t += 2) {
        const auto a = ball.polygon(t), b = ball.polygon(t + 1);
        std::vector<std::uint32_t> corners(a.begin(), a.end());
        for (const auto v : b) {
            if (std::find(corners.begin(), corners.end(), v) == corners.end()) {
                // Between the two corners of a that b shares.
                for (std::size_t k = 0; k < 3; ++k) {
                    const bool first = std::find(b.begin(), b.end(), a[k]) != b.end();
                    const bool second = std::find(b.begin(), b.end(), a[(k + 1) % 3]) != b.end();
                    if (first && second) {
                        corners.insert(corners.begin() + static_cast<std::ptrdiff_t>(k) + 1, v);
                        break;
                    }
                }
            }
        }
        ASSERT_EQ(corners.size(), 4U);
        quads.add_polygon(corners, 1);
    }
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Vec3(1, -1, 2).normalized()).toRotationMatrix();
    for (Vec3& p : quads.points) p = turn * p;
    const TriangleMesh mesh = make_triangle_mesh(quads);
    const auto result = segment(mesh);
    EXPECT_EQ(errors_of(result), 0U);
    for (const auto f : mesh.faces()) {
        for (const auto n : mesh.ff_range(f)) {
            if (mesh.data(f).source != mesh.data(n).source) continue;
            EXPECT_EQ(result.segmentation.labels[static_cast<std::size_t>(f.idx())],
                      result.segmentation.labels[static_cast<std::size_t>(n.idx())]);
        }
    }
}

TEST(SegmentAuto, NothingDependsOnTheNumberOfThreads) {
    PolygonSoup soup = test::torus(40, 20);
    for (std::size_t i = 0; i < soup.points.size(); ++i)
        soup.points[i] *= 1 + 0.05 * std::sin(1.7 * static_cast<double>(i));
    const TriangleMesh mesh = make_triangle_mesh(soup);
    Context context;
    context.threads = 1;
    const auto one = segment(mesh, {}, context);
    EXPECT_FALSE(one.report.repairs.empty());
    for (const int threads : {2, 5}) {
        context.threads = threads;
        const auto many = segment(mesh, {}, context);
        EXPECT_EQ(many.segmentation.labels, one.segmentation.labels);
        ASSERT_EQ(many.report.repairs.size(), one.report.repairs.size());
        for (std::size_t i = 0; i < one.report.repairs.size(); ++i)
            EXPECT_EQ(many.report.repairs[i].cost, one.report.repairs[i].cost);
    }
}

TEST(SegmentAuto, AlignFindsTheAxesOfATurnedBox) {
    PolygonSoup soup = test::box_surface(3, 2, 1, 3);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.6, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    for (Vec3& p : soup.points) p = turn * p;
    const TriangleMesh mesh = make_triangle_mesh(soup);
    SegmentOptions options;
    EXPECT_EQ(segment(mesh, options).rotation, Eigen::Matrix3d::Identity());
    options.align = true;
    const auto result = segment(mesh, options);
    EXPECT_LT((result.rotation * result.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(result.rotation.determinant(), 1.0, 1e-12);
    const TriangleMesh turned = rotated(mesh, result.rotation);
    expect_valid_and_faithful(turned, result);
    EXPECT_GT(faith_of(turned, result.segmentation.labels).mean, 0.999);
}

TEST(SegmentAuto, AvoidedLabelsAreGivenUpWhereAnotherWillDo) {
    // A ball's +X cap without its label: what can, goes elsewhere.
    const TriangleMesh mesh = make_triangle_mesh(test::ball(10));
    const auto plain = segment(mesh);
    SegmentOptions options;
    for (std::size_t t = 0; t < mesh.n_faces(); ++t) {
        if (plain.segmentation.labels[t] == 0) options.avoid.push_back({static_cast<std::int64_t>(t), 0});
    }
    const auto other = segment(mesh, options);
    EXPECT_EQ(errors_of(other), 0U);
    EXPECT_LT(other.report.label_counts[0], plain.report.label_counts[0]);
    options.avoid = {{static_cast<std::int64_t>(mesh.n_faces()), 0}};
    EXPECT_THROW(segment(mesh, options), Error);
}

TEST(SegmentAuto, EveryAttemptIsValid) {
    PolygonSoup soup = test::torus(48, 24);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4, Vec3(1, 1, 3).normalized()).toRotationMatrix();
    for (Vec3& p : soup.points) p = turn * p;
    const TriangleMesh mesh = make_triangle_mesh(soup);
    SegmentOptions options;

    std::shared_ptr<SegmentResult> known;
    for (options.attempt = 0; options.attempt < 4; ++options.attempt) {
        const auto result = segment(mesh, options);
        EXPECT_EQ(errors_of(result), 0U);
        EXPECT_EQ(known != nullptr, options.attempt == 1);
        if (known) {
            EXPECT_EQ(known->segmentation.labels, result.segmentation.labels);
            EXPECT_EQ(known->report.charts, result.report.charts);
            EXPECT_EQ(known->report.repairs.size(), result.report.repairs.size());
        }
        known = result.next_attempt;
    }

    EXPECT_THROW(segment(mesh, options), Error);
}

class PaperModel : public testing::TestWithParam<const char*> {};

TEST_P(PaperModel, RawTrianglesGetValidAndFaithfulLabels) {
    HEX_NEEDS_REFERENCE_DATA();
    const std::string name = GetParam();
    const TriangleMesh mesh = make_triangle_mesh(
        io::read_surface(test::reference_data() / "paper" / name / (name + "_tri.k")).soup);
    expect_valid_and_faithful(mesh, segment(mesh));
}

INSTANTIATE_TEST_SUITE_P(Paper, PaperModel, testing::Values("rod", "hepta", "mount1", "fertility", "joint"),
                         [](const auto& model) { return std::string(model.param); });

}  // namespace
}  // namespace hex
