#include "support/meshes.h"

#include <hex/base/error.h>
#include <hex/surface/polygon_soup.h>
#include <spline/fit.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

namespace spline::test {
namespace {

using hex::Vec3;

/// The unit sphere: a cube's surface, projected.
hex::TriangleMesh sphere(int n) {
    hex::PolygonSoup soup = hex::test::box_surface(2, 2, 2, n);
    for (Vec3& p : soup.points) p = (p - Vec3::Ones()).normalized();
    return hex::make_triangle_mesh(soup);
}

/// A ball of hexahedra with its boundary vertices on the unit sphere.
BezierSpline ball() {
    hex::HexMesh mesh = hex::test::grid(6, 6, 6);
    for (const hex::VertexId v : mesh.vertices()) {
        const Vec3 p = mesh.position(v) / 3.0 - Vec3::Ones();
        const double cube = p.cwiseAbs().maxCoeff();
        // Round outside, a cube in the middle.
        const Vec3 round = cube > 0.0 ? Vec3(p.normalized() * cube) : p;
        mesh.set_position(v, cube * round + (1.0 - cube) * 0.7 * p);
    }
    return build(mesh).spline;
}

TEST(Fit, BringsTheBoundaryOntoTheSurface) {
    BezierSpline s = ball();
    JacobianReport verdict = certify(s);
    const std::size_t proved = verdict.positive;
    const FitReport report = fit(s, verdict, sphere(24));
    EXPECT_LT(5.0 * report.after.to_surface_rms, report.before.to_surface_rms);
    EXPECT_LT(2.0 * report.after.to_surface_max, report.before.to_surface_max);
    EXPECT_LT(2.0 * report.after.from_surface_max, report.before.from_surface_max);
    EXPECT_TRUE(report.folded.empty());
    EXPECT_GE(verdict.positive, proved);
    EXPECT_EQ(certify(s).positive, verdict.positive) << "the verdict is that of the result";
}

TEST(Fit, MeasuresWithoutMoving) {
    // A box with sharp edges is its own surface.
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    const BezierSpline s = build(hex::test::grid(3, 3, 3), options).spline;
    const hex::TriangleMesh box = hex::make_triangle_mesh(hex::test::box_surface(3, 3, 3, 4));
    const FitDistance distance = fit_distance(s, box);
    EXPECT_LE(distance.to_surface_max, 1e-14);
    EXPECT_LE(distance.from_surface_max, 1e-14);
    const hex::TriangleMesh larger = hex::make_triangle_mesh(hex::test::box_surface(4, 3, 3, 4));
    EXPECT_NEAR(fit_distance(s, larger).from_surface_max, 1.0, 1e-12);
}

TEST(Fit, TheSameForAnyNumberOfThreads) {
    std::vector<std::vector<Vec3>> results;
    for (const int threads : {1, 2}) {
        hex::Context context;
        context.threads = threads;
        BezierSpline s = ball();
        JacobianReport verdict = certify(s, {}, context);
        FitOptions options;
        options.rounds = 2;
        fit(s, verdict, sphere(8), options, context);
        results.push_back(s.control_points);
    }
    EXPECT_EQ(results[0], results[1]);
}

TEST(Fit, NeedsToKnowTheBoundary) {
    BezierSpline s = ball();
    s.boundary_patch.clear();
    JacobianReport verdict = certify(s);
    EXPECT_THROW(fit(s, verdict, sphere(4)), hex::Error);
}

TEST(Fit, RefusesOptionsThatMeanNothing) {
    BezierSpline s = ball();
    JacobianReport verdict = certify(s);
    const auto kind = [&](const FitOptions& options) {
        try {
            fit(s, verdict, sphere(4), options);
        } catch (const hex::Error& error) {
            return error.kind();
        }
        return hex::ErrorKind::cancelled;  // none
    };
    FitOptions none, negative;
    none.rounds = 0;
    negative.fairness = -1e-5;
    EXPECT_EQ(kind(none), hex::ErrorKind::usage);
    EXPECT_EQ(kind(negative), hex::ErrorKind::usage);
}

}  // namespace
}  // namespace spline::test
