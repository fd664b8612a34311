#include "support/meshes.h"
#include "support/test_files.h"

#include <hex/io/hex_file.h>
#include <spline/repair.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

namespace spline::test {
namespace {

using hex::Vec3;

/// The spline of a box of cubes, one of whose control points is moved.
BezierSpline folded_box(const Vec3& vertex, const Vec3& move) {
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    BezierSpline s = build(hex::test::grid(6, 6, 6), options).spline;
    for (Vec3& p : s.control_points)
        if (p == vertex) p += move;
    return s;
}

TEST(Repair, ChangesNothingWhenAllElementsAreProvedPositive) {
    BezierSpline s = folded_box(Vec3(3, 3, 3), Vec3(0.2, 0, 0));
    const auto before = s.control_points;
    JacobianReport verdict = certify(s);
    ASSERT_TRUE(verdict.proved());
    const RepairReport report = repair_jacobian(s, verdict);
    EXPECT_EQ(s.control_points, before);
    EXPECT_EQ(report.moved_inside + report.moved_boundary, 0U);
}

TEST(Repair, MendsAFoldInsideWithoutMovingTheBoundary) {
    BezierSpline s = folded_box(Vec3(3, 3, 3), Vec3(6, 0, 0));
    const auto before = s.control_points;
    const auto boundary = boundary_functions(s);
    JacobianReport verdict = certify(s);
    ASSERT_FALSE(verdict.negative.empty());
    const std::size_t folded = verdict.negative.size() + verdict.undecided.size();
    const RepairReport report = repair_jacobian(s, verdict);
    EXPECT_TRUE(verdict.proved());
    EXPECT_TRUE(certify(s).proved()) << "the verdict is that of the result";
    EXPECT_EQ(report.mended.size(), folded);
    EXPECT_TRUE(report.unmended.empty());
    EXPECT_EQ(report.moved_boundary, 0U);
    std::size_t moved = 0;
    for (std::size_t f = 0; f < before.size(); ++f) {
        moved += s.control_points[f] != before[f];
        if (boundary[f] != 0) {
            EXPECT_EQ(s.control_points[f], before[f]);
        }
    }
    EXPECT_EQ(moved, report.moved_inside);
}

TEST(Repair, MovesTheBoundaryOnlyAsFarAsAllowed) {
    for (const double allowed : {0.0, 2.0}) {
        BezierSpline s = folded_box(Vec3(3, 3, 0), Vec3(0, 0, 2.6));
        const auto before = s.control_points;
        const auto boundary = boundary_functions(s);
        JacobianReport verdict = certify(s);
        ASSERT_FALSE(verdict.proved());
        RepairOptions options;
        options.max_deviation = allowed;
        const RepairReport report = repair_jacobian(s, verdict, options);
        hex::BoundingBox box;
        for (const Vec3& p : before) box.add(p);
        double largest = 0.0;
        for (std::size_t f = 0; f < before.size(); ++f) {
            if (boundary[f] != 0) largest = std::max(largest, (s.control_points[f] - before[f]).norm());
        }
        EXPECT_LE(largest, 0.01 * allowed * box.diagonal() * (1 + 1e-12));
        EXPECT_NEAR(report.largest_boundary, 100.0 * largest / box.diagonal(), 1e-12);
        EXPECT_EQ(report.unmended.size(), verdict.negative.size() + verdict.undecided.size());
    }
}

TEST(Repair, WhatHardlyFoldsIsMendedByHardlyMoving) {
    // A smooth edge of the boundary with one element: the determinant is zero there, and tiny beside it. The
    // bend of the side is made just large enough for a fold.
    const BezierSpline smooth = build(hex::test::grid(4, 4, 4)).spline;
    const auto bent = [&](double amount) {
        BezierSpline s = smooth;
        for (Vec3& p : s.control_points) {
            if (p.x() == 0.0 && p.y() == 2.0 && p.z() == 0.0) p += amount * Vec3(1.0, 0.0, 0.3);
        }
        return s;
    };
    double sound = 0.0, folded = 3.0;
    ASSERT_FALSE(certify(bent(folded)).proved());
    while (folded - sound > 1e-6) {
        const double middle = 0.5 * (sound + folded);
        (certify(bent(middle)).proved() ? sound : folded) = middle;
    }
    BezierSpline s = bent(folded);
    JacobianReport verdict = certify(s);
    ASSERT_FALSE(verdict.proved());
    RepairOptions options;
    options.max_deviation = 0.1;
    const RepairReport report = repair_jacobian(s, verdict, options);
    EXPECT_TRUE(verdict.proved());
    EXPECT_TRUE(report.unmended.empty());
}

TEST(Repair, NamesWhatCannotBeMended) {
    // A corner of the box turned inside out: its element is negative at the corner whatever the inside does.
    BezierSpline s = folded_box(Vec3(0, 0, 0), Vec3(2, 2, 2));
    JacobianReport verdict = certify(s);
    RepairOptions options;
    options.max_deviation = 0.0;
    options.most_rounds = 3;
    const RepairReport report = repair_jacobian(s, verdict, options);
    ASSERT_FALSE(report.unmended.empty());
    EXPECT_EQ(report.unmended[0], 0);
    EXPECT_EQ(report.negative_after, verdict.negative.size());
}

TEST(Repair, RefusesOptionsThatMeanNothing) {
    BezierSpline s = build(hex::test::grid(1, 1, 1)).spline;
    JacobianReport verdict = certify(s);
    RepairOptions options;
    options.max_deviation = -1.0;
    EXPECT_THROW(repair_jacobian(s, verdict, options), hex::Error);
    options = {};
    options.most_rounds = 0;
    EXPECT_THROW(repair_jacobian(s, verdict, options), hex::Error);
}

TEST(Repair, TheSameForAnyNumberOfThreads) {
    std::vector<std::vector<Vec3>> results;
    for (const int threads : {1, 2}) {
        hex::Context context;
        context.threads = threads;
        BezierSpline s = folded_box(Vec3(3, 3, 3), Vec3(6, 0.4, 0));
        JacobianReport verdict = certify(s, {}, context);
        repair_jacobian(s, verdict, {}, context);
        results.push_back(s.control_points);
    }
    EXPECT_EQ(results[0], results[1]);
}

TEST(Repair, ThePublishedJointIsMended) {
    // 81 of its 6144 elements have a negative Jacobian at Gauss points.
    HEX_NEEDS_REFERENCE_DATA();
    const auto file = hex::test::reference_data() / "paper" / "joint" / "joint_hex.vtk";
    BezierSpline s = build(hex::io::read_hex_mesh(file).mesh).spline;
    JacobianReport verdict = certify(s);
    EXPECT_GE(verdict.negative.size(), 81U);
    repair_jacobian(s, verdict);
    EXPECT_TRUE(verdict.proved());
}

TEST(Repair, ThePublishedRodNeedsNone) {
    HEX_NEEDS_REFERENCE_DATA();
    const auto file = hex::test::reference_data() / "paper" / "rod" / "rod_hex.vtk";
    const JacobianReport verdict = certify(build(hex::io::read_hex_mesh(file).mesh).spline);
    EXPECT_TRUE(verdict.proved());
    EXPECT_GT(verdict.singular, 0U) << "it has smooth boundary edges with one element";
}

}  // namespace
}  // namespace spline::test
