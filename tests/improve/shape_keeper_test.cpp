/// The energy that keeps the boundary close to the surface, and the measure of how close it is.

#include "improve/shape_keeper.h"

#include "improve/improve_cases.h"

#include <gtest/gtest.h>

namespace {

using hex::Vec3;
using hex::VertexId;
namespace improving = hex::improving;

struct Case {
    hex::HexMesh mesh = hex::test::grid(3, 3, 3);
    hex::EdgeTable edges = hex::edge_table(mesh);
    hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    improving::GuideSurface surface = improving::make_guide_surface(mesh, boundary);
    std::vector<Vec3> positions{mesh.positions().begin(), mesh.positions().end()};
};

TEST(ShapeKeeper, IsZeroOnTheSurfaceItselfAndRisesAway) {
    Case c;
    const improving::ShapeKeeper keeper(c.edges, c.boundary, c.surface, 0.8, c.positions);
    EXPECT_NEAR(keeper.evaluate(c.positions, nullptr), 0.0, 1e-20);
    for (Vec3& p : c.positions) p.x() += 0.05;
    EXPECT_GT(keeper.evaluate(c.positions, nullptr), 1.0);
}

TEST(ShapeKeeper, GradientIsThatOfFiniteDifferences) {
    Case c;
    improving::ShapeKeeper keeper(c.edges, c.boundary, c.surface, 0.8, c.positions);
    keeper.set_limit(0.1);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.15, 0.15);
    for (Vec3& p : c.positions) p += Vec3(shift(random), shift(random), shift(random));
    keeper.follow(c.positions);
    std::vector<Vec3> gradient(c.positions.size(), Vec3::Zero());
    (void)keeper.evaluate(c.positions, &gradient);
    double scale = 1.0;
    for (const Vec3& g : gradient) scale = std::max(scale, g.norm());
    constexpr double h = 1e-7;
    for (std::size_t v = 0; v < c.positions.size(); ++v) {
        for (Eigen::Index d = 0; d < 3; ++d) {
            const double here = c.positions[v][d];
            c.positions[v][d] = here + h;
            const double plus = keeper.evaluate(c.positions, nullptr);
            c.positions[v][d] = here - h;
            const double minus = keeper.evaluate(c.positions, nullptr);
            c.positions[v][d] = here;
            EXPECT_NEAR(gradient[v][d], (plus - minus) / (2.0 * h), 1e-5 * scale);
        }
    }
}

TEST(FidelityMeter, MeasuresHowFarAMovedBoxIsFromItself) {
    Case c;
    const improving::FidelityMeter meter(c.edges, c.boundary, c.surface, 0.8);
    const improving::Fidelity before = meter.measure(c.positions);
    EXPECT_NEAR(before.distance, 0.0, 1e-12);
    EXPECT_NEAR(before.features, 0.0, 1e-12);
    for (Vec3& p : c.positions) p.x() += 0.25;
    const improving::Fidelity after = meter.measure(c.positions);
    EXPECT_NEAR(after.distance, 0.25, 1e-12);
    // Of the edges of the box those at x = 0 are 0.25 away; at x = 3, lines of the mesh cross at the first
    // and last of the five points of each; along x only the first point of all is not on a line of the mesh.
    EXPECT_NEAR(after.features, (4.0 * 0.25 + 4.0 * 0.6 * 0.25 + 4.0 * 0.25 / 15.0) / 12.0, 1e-12);
}

}  // namespace
