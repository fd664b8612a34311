#include "support/surfaces.h"

#include <hex/base/error.h>
#include <hex/segment/charts.h>
#include <hex/segment/segment.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <stop_token>

namespace hex {
namespace {

std::vector<int> labels_of(const PolygonSoup& soup, const std::string& method = "hbecvt") {
    SegmentOptions options;
    options.method = method;
    return segment(make_triangle_mesh(soup), options).segmentation.labels;
}

/// A ball with bumps of all sizes: sweeps have much to move. Coordinates are multiples of 2^-20.
PolygonSoup rough_ball(int n, unsigned seed) {
    PolygonSoup soup = test::ball(n);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> bump(0.97, 1.03);
    for (Vec3& p : soup.points) {
        p *= 10.0 * bump(random) * (1.0 + 0.2 * std::sin(3 * p.x() + 2 * p.y()) * std::cos(4 * p.z()));
        p = (p * 0x1p20).array().round() * 0x1p-20;
    }
    return soup;
}

ErrorKind kind_of_error(const TriangleMesh& mesh, const SegmentOptions& options,
                        const Context& context = {}) {
    try {
        segment(mesh, options, context);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "no error";
    return ErrorKind::output;
}

SegmentOptions hbecvt() {
    SegmentOptions options;
    options.method = "hbecvt";
    return options;
}

TEST(Segment, AllMethodsAreRegistered) {
    EXPECT_TRUE(segmenters().contains("auto"));
    EXPECT_TRUE(segmenters().contains("cvt"));
    EXPECT_TRUE(segmenters().contains("hbecvt"));
}

TEST(Segment, ABoxGivesSixChartsOfTwoTriangles) {
    const PolygonSoup box = test::box_surface(3, 2, 1);
    const auto result = segment(make_triangle_mesh(box));
    for (std::size_t t = 0; t < 12; ++t) EXPECT_EQ(result.segmentation.labels[t] + 1, box.parts[t]);
    EXPECT_EQ(result.report.label_counts, (std::array<std::size_t, 6>{2, 2, 2, 2, 2, 2}));
    EXPECT_EQ(result.report.charts, 6U);
    EXPECT_EQ(result.report.boundaries, 12U);
    EXPECT_EQ(result.report.corners, 8U);
    EXPECT_TRUE(result.report.violations.empty());
    for (int k = 0; k < 6; ++k)
        EXPECT_EQ(result.report.generators[static_cast<std::size_t>(k)], label_axis(k));
}

TEST(Segment, ABallGivesSixValidCharts) {
    const auto result = segment(make_triangle_mesh(test::ball(16)));
    EXPECT_EQ(result.report.charts, 6U);
    EXPECT_EQ(result.report.corners, 8U);
    EXPECT_EQ(count_at_least(result.report.violations, Severity::warning), 0U);
}

TEST(Segment, WithLabelsWritesLabelPlusOneAsPart) {
    const TriangleMesh mesh = make_triangle_mesh(test::ball(3));
    const auto result = segment(mesh);
    const PolygonSoup labelled = to_soup(with_labels(mesh, result.segmentation));
    for (std::size_t t = 0; t < labelled.size(); ++t)
        EXPECT_EQ(labelled.parts[t], result.segmentation.labels[t] + 1);
}

TEST(Segment, LabelsDoNotDependOnPositionOrSize) {
    const PolygonSoup soup = rough_ball(12, 1);
    for (const char* method : {"cvt", "hbecvt", "auto"}) {
        const auto labels = labels_of(soup, method);
        PolygonSoup moved = soup;  // the coordinates are dyadic, so this shift is exact
        for (Vec3& p : moved.points) p += Vec3(1024, -4096.5, 3.25);
        EXPECT_EQ(labels_of(moved, method), labels);
        for (const double scale : {0x1p-10, 0x1p300, 0x1p-700}) {
            PolygonSoup scaled = soup;
            for (Vec3& p : scaled.points) p *= scale;
            EXPECT_EQ(labels_of(scaled, method), labels) << scale;
        }
    }
}

TEST(Segment, NothingDependsOnTheNumberOfThreads) {
    const TriangleMesh mesh = make_triangle_mesh(rough_ball(40, 2));
    Context context;
    context.threads = 1;
    const auto one = segment(mesh, hbecvt(), context);
    for (const int threads : {2, 3, 8}) {
        context.threads = threads;
        const auto many = segment(mesh, hbecvt(), context);
        EXPECT_EQ(many.segmentation.labels, one.segmentation.labels);
        ASSERT_EQ(many.report.sweeps.size(), one.report.sweeps.size());
        for (std::size_t s = 0; s < one.report.sweeps.size(); ++s)
            EXPECT_EQ(many.report.sweeps[s].energy, one.report.sweeps[s].energy);
        EXPECT_EQ(many.report.violations.size(), one.report.violations.size());
    }
}

TEST(Segment, SweepsStopAtFewerThanThreeMovesOrAtTheirLimit) {
    const auto result = segment(make_triangle_mesh(rough_ball(30, 3)), hbecvt());
    const auto& sweeps = result.report.sweeps;
    for (std::size_t s = 0; s < sweeps.size(); ++s) {
        const bool last = s + 1 == sweeps.size() || sweeps[s + 1].phase != sweeps[s].phase;
        const int limit = sweeps[s].phase == "cvt" ? 51 : 201;
        if (last)
            EXPECT_TRUE(sweeps[s].moves < 3 || sweeps[s].sweep == limit);
        else
            EXPECT_GE(sweeps[s].moves, 3U);
    }
}

TEST(Segment, EveryTriangleOnALabelBoundaryIsAtItsNearestGeneratorAtTheEnd) {
    // What a last sweep without moves means: no candidate has a strictly nearer label among its neighbours'.
    const TriangleMesh mesh = make_triangle_mesh(test::ball(20));
    SegmentOptions options;
    options.method = "cvt";
    const auto result = segment(mesh, options);
    ASSERT_EQ(result.report.sweeps.back().moves, 0U);
    const auto& labels = result.segmentation.labels;
    const auto& g = result.report.generators;
    for (const auto f : mesh.faces()) {
        const auto normal = to_eigen(mesh.calc_face_normal(f));
        const auto own = static_cast<std::size_t>(labels[static_cast<std::size_t>(f.idx())]);
        for (const auto n : mesh.ff_range(f)) {
            const auto other = static_cast<std::size_t>(labels[static_cast<std::size_t>(n.idx())]);
            EXPECT_LE((normal - g[own]).norm(), (normal - g[other]).norm() + 1e-12);
        }
    }
}

TEST(Segment, ManualLabelsAreAppliedLastAndInOrder) {
    const TriangleMesh mesh = make_triangle_mesh(test::box_surface(1, 1, 1));
    SegmentOptions options;
    options.manual = {{3, 5}, {3, 4}, {0, 0}, {7, 1}, {7, 3}};
    const auto plain = segment(mesh);
    const auto result = segment(mesh, options);
    auto expected = plain.segmentation.labels;
    expected[3] = 4;
    EXPECT_EQ(expected[7], 3);
    EXPECT_EQ(result.segmentation.labels, expected);
    EXPECT_EQ(result.report.manual_changes, 1U);  // only triangle 3 ends with another label
}

TEST(Segment, ManualLabelsOutOfRangeAreNamed) {
    const TriangleMesh mesh = make_triangle_mesh(test::box_surface(1, 1, 1));
    for (const ManualLabel& bad : {ManualLabel{12, 0, "list.txt:4"}, ManualLabel{-1, 0, "list.txt:4"},
                                   ManualLabel{0, 6, "list.txt:4"}, ManualLabel{0, -1, "list.txt:4"}}) {
        SegmentOptions options;
        options.manual = {{1, 1}, bad};
        try {
            segment(mesh, options);
            FAIL() << bad.triangle << ' ' << bad.label;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_EQ(error.where(), "list.txt:4");
        }
    }
}

TEST(Segment, OptionsThatMakeNoSenseAreRefused) {
    const TriangleMesh mesh = make_triangle_mesh(test::box_surface(1, 1, 1));
    SegmentOptions options;
    for (const double weight :
         {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        options.boundary_weight = weight;
        EXPECT_EQ(kind_of_error(mesh, options), ErrorKind::usage);
    }
    options = {};
    options.method = "no such method";
    EXPECT_EQ(kind_of_error(mesh, options), ErrorKind::usage);
    EXPECT_EQ(kind_of_error(TriangleMesh(), {}), ErrorKind::bad_input);
}

TEST(Segment, AStopRequestEndsIt) {
    std::stop_source source;
    source.request_stop();
    Context context;
    context.stop = source.get_token();
    EXPECT_EQ(kind_of_error(make_triangle_mesh(test::ball(4)), {}, context), ErrorKind::cancelled);
}

TEST(Segment, ALabelWithoutMembersKeepsItsAxis) {
    // A triangular prism: no face looks towards +Y, the slanted ones look towards +X and -X.
    const auto soup = test::prism({{-2, 0}, {2, 0}, {0, 4}}, 1);
    const auto result = segment(make_triangle_mesh(soup), hbecvt());
    EXPECT_EQ(result.report.label_counts[2], 0U);
    EXPECT_EQ(result.report.generators[2], Vec3(0, 1, 0));
    for (const auto& sweep : result.report.sweeps) EXPECT_TRUE(std::isfinite(sweep.energy));
}

TEST(Segment, ATriangleWithoutAreaTakesTheLabelOfANeighbour) {
    // A box whose edge between +Z and +Y has a vertex in the middle for +Z only; a triangle of collinear
    // vertices closes the gap.
    PolygonSoup box = test::box_surface(2, 2, 2);
    for (std::size_t t = 0; t < box.size(); ++t) {
        if (box.parts[t] != 5) continue;
        auto* c = &box.corners[box.offsets[t]];
        for (int turn = 0; turn < 3; ++turn) {
            if (box.points[c[0]].y() == 2 && box.points[c[1]].y() == 2) break;
            std::rotate(c, c + 1, c + 3);
        }
        if (box.points[c[0]].y() != 2 || box.points[c[1]].y() != 2) continue;
        const int a = static_cast<int>(c[0]), b = static_cast<int>(c[1]), apex = static_cast<int>(c[2]);
        const int middle = static_cast<int>(box.points.size());
        box.points.emplace_back(1, 2, 2);
        c[1] = static_cast<std::uint32_t>(middle);
        test::add_triangle(box, middle, b, apex, 5);
        test::add_triangle(box, a, b, middle, 5);  // no area
        break;
    }
    ASSERT_EQ(box.size(), 14U);
    for (const char* method : {"cvt", "hbecvt", "auto"}) {
        SegmentOptions options;
        options.method = method;
        const auto result = segment(make_triangle_mesh(box), options);
        EXPECT_TRUE(result.segmentation.labels[13] == 4 || result.segmentation.labels[13] == 2);
        EXPECT_EQ(result.report.charts, 6U);
        for (const auto& sweep : result.report.sweeps) EXPECT_TRUE(std::isfinite(sweep.energy));
    }
}

TEST(Segment, ASurfaceWithoutAnyAreaIsLabelledWithoutAnError) {
    PolygonSoup flat = test::box_surface(1, 1, 1);
    for (Vec3& p : flat.points) p = Vec3(p.x(), 0, 0);
    const auto result = segment(make_triangle_mesh(flat));
    EXPECT_EQ(result.report.label_counts[0], 12U);
}

TEST(Segment, AVertexWithThousandsOfTrianglesIsNoProblem) {
    std::vector<Vec2> circle;
    const int n = 2000;
    for (int i = 0; i < n; ++i)
        circle.emplace_back(std::cos(2 * std::numbers::pi * i / n), std::sin(2 * std::numbers::pi * i / n));
    const auto result = segment(make_triangle_mesh(test::prism(circle, 2)));
    EXPECT_EQ(result.report.label_counts[4], static_cast<std::size_t>(n));
    EXPECT_EQ(result.report.label_counts[5], static_cast<std::size_t>(n));
    EXPECT_EQ(result.report.charts, 6U);
}

TEST(SegmentFromPatches, LabelsEachPatchWithTheAxisItFaces) {
    PolygonSoup box = test::box_surface(3, 2, 1, 2);
    const std::vector<int> labels = [&] {
        std::vector<int> l = box.parts;
        for (int& label : l) --label;
        return l;
    }();
    for (int& part : box.parts) part = 70 - 3 * part;  // any numbers will do
    const auto result = segment_from_patches(make_triangle_mesh(box));
    EXPECT_EQ(result.segmentation.labels, labels);
    EXPECT_EQ(result.report.charts, 6U);
    EXPECT_EQ(result.report.boundaries, 12U);
    EXPECT_EQ(result.report.corners, 8U);
    EXPECT_TRUE(result.report.violations.empty());
}

TEST(SegmentFromPatches, TellsWhatIsWrongWithThePatches) {
    PolygonSoup box = test::box_surface(1, 1, 1, 2);
    for (int& part : box.parts) part = part == 3 ? 1 : part;  // +X and +Y in one: the caps have three corners
    const auto result = segment_from_patches(make_triangle_mesh(box));
    EXPECT_EQ(std::count_if(result.report.violations.begin(), result.report.violations.end(),
                            [](const Diagnostic& d) { return d.code == "patch-corners"; }),
              2);
}

TEST(CompletePatches, KeepsWhatIsThereAndAddsWhatIsMissing) {
    PolygonSoup box = test::box_surface(3, 2, 1, 4);
    const std::vector<int> given = box.parts;
    for (int& part : box.parts)
        if (part == 2 || part == 5) part = part == 2 ? 0 : -3;
    const CompletedPatches completed = complete_patches(make_triangle_mesh(box));
    EXPECT_EQ(completed.triangles, 64U);
    EXPECT_EQ(completed.parts, (std::vector<int>{7, 8}));
    for (const auto f : completed.mesh.faces()) {
        const int was = given[static_cast<std::size_t>(f.idx())];
        EXPECT_EQ(completed.mesh.data(f).part, was == 2 ? 7 : was == 5 ? 8 : was);
    }
    EXPECT_TRUE(segment_from_patches(completed.mesh).report.violations.empty());
}

TEST(CompletePatches, AddsNothingToACompleteSurface) {
    const CompletedPatches completed = complete_patches(make_triangle_mesh(test::box_surface(3, 2, 1)));
    EXPECT_EQ(completed.triangles, 0U);
    EXPECT_TRUE(completed.parts.empty());
}

}  // namespace
}  // namespace hex
