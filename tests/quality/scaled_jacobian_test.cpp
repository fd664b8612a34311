#include "support/meshes.h"

#include <hex/quality/scaled_jacobian.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace {

using hex::Vec3;
using Corners = std::array<Vec3, 8>;

Corners unit_cube() {
    Corners corners;
    for (std::size_t c = 0; c < 8; ++c) {
        const auto& uvw = hex::hexahedron::corner_uvw[c];
        corners[c] = Vec3(uvw[0], uvw[1], uvw[2]);
    }
    return corners;
}

Corners random_hexahedron(std::mt19937& random, double amount) {
    std::uniform_real_distribution<double> shift(-amount, amount);
    Corners corners = unit_cube();
    for (Vec3& p : corners) p += Vec3(shift(random), shift(random), shift(random));
    return corners;
}

/// A hexahedron whose centre is far worse than all of its corners (found by search), a little shaken.
Corners bad_centre(std::mt19937& random) {
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    Corners corners = {Vec3(-0.6, 0.6, 0.7), Vec3(-3.9, 0.5, -2.1), Vec3(2.4, 0.0, -0.1),
                       Vec3(0.8, 2.7, -2.5), Vec3(-0.1, 0.6, 1.3),  Vec3(-1.3, -0.1, -0.2),
                       Vec3(-0.8, 7.1, 0.8), Vec3(-0.4, -1.4, 1.5)};
    for (Vec3& p : corners) p += Vec3(shift(random), shift(random), shift(random));
    return corners;
}

hex::HexMesh perturbed_grid(int n, double amount, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-amount, amount);
    hex::HexMesh mesh = hex::test::grid(n, n, n);
    for (const hex::VertexId v : mesh.vertices())
        mesh.set_position(v, mesh.position(v) + Vec3(shift(random), shift(random), shift(random)));
    return mesh;
}

hex::Context threads_context(int threads) {
    hex::Context context;
    context.threads = threads;
    return context;
}

TEST(ScaledJacobian, IsOneForTheUnitCubeAndForCuboids) {
    EXPECT_EQ(hex::scaled_jacobian(unit_cube()), 1.0);
    Corners box = unit_cube();
    for (Vec3& p : box) p = p.cwiseProduct(Vec3(3.0, 0.25, 1024.0));
    EXPECT_EQ(hex::scaled_jacobian(box), 1.0);
}

TEST(ScaledJacobian, IsMinusOneForTheMirroredCube) {
    Corners mirrored = unit_cube();
    for (Vec3& p : mirrored) p.x() = -p.x();
    EXPECT_EQ(hex::scaled_jacobian(mirrored), -1.0);
}

TEST(ScaledJacobian, OfASkewedBoxIsTheDeterminantOfItsUnitAxes) {
    const Vec3 u(2, 0, 0), v(1, 1, 0), w(0.5, 0.5, 3);
    Corners corners;
    for (std::size_t c = 0; c < 8; ++c) {
        const auto& uvw = hex::hexahedron::corner_uvw[c];
        corners[c] = uvw[0] * u + uvw[1] * v + uvw[2] * w;
    }
    const double expected = u.normalized().dot(v.normalized().cross(w.normalized()));
    EXPECT_NEAR(hex::scaled_jacobian(corners), expected, 1e-15);
}

TEST(ScaledJacobian, DoesNotChangeUnderRotationScaleAndShift) {
    std::mt19937 random(1);
    for (int i = 0; i < 100; ++i) {
        const Corners corners = random_hexahedron(random, 0.4);
        const double before = hex::scaled_jacobian(corners);
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.1 * i, Vec3(1, 2, i).normalized()));
        Corners moved = corners;
        for (Vec3& p : moved) p = 17.0 * (turn * p) + Vec3(3, -4, 5);
        EXPECT_NEAR(hex::scaled_jacobian(moved), before, 1e-13);
    }
}

TEST(ScaledJacobian, IsTheSmallestOfCornersAndCentre) {
    std::mt19937 random(2);
    int centre_decides = 0;
    for (int i = 0; i < 2000; ++i) {
        const Corners corners = i % 2 == 0 ? random_hexahedron(random, 0.6) : bad_centre(random);
        double smallest_corner = 2.0;
        for (int c = 0; c < 8; ++c)
            smallest_corner = std::min(smallest_corner, hex::corner_scaled_jacobian(corners, c));
        // The derivatives of the trilinear map at the centre.
        std::array<Vec3, 3> axis = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        for (std::size_t c = 0; c < 8; ++c)
            for (std::size_t d = 0; d < 3; ++d)
                axis[d] += (hex::hexahedron::corner_uvw[c][d] == 1 ? 1.0 : -1.0) * corners[c];
        const double centre = axis[0].normalized().dot(axis[1].normalized().cross(axis[2].normalized()));
        if (centre < smallest_corner) ++centre_decides;
        EXPECT_NEAR(hex::scaled_jacobian(corners), std::min(centre, smallest_corner), 1e-13);
    }
    EXPECT_GT(centre_decides, 0) << "the centre was never put to the test";
}

TEST(ScaledJacobian, IsZeroForAnEdgeWithoutLength) {
    Corners corners = unit_cube();
    corners[1] = corners[0];
    EXPECT_EQ(hex::scaled_jacobian(corners), 0.0);
    EXPECT_EQ(hex::corner_scaled_jacobian(corners, 0), 0.0);
    EXPECT_EQ(hex::corner_scaled_jacobian(corners, 7), 1.0);
}

TEST(ScaledJacobian, OfAllCellsHasTheBitsOfEachCell) {
    for (const int n : {1, 2, 3, 7}) {
        const hex::HexMesh mesh = perturbed_grid(n, 0.5, 3);
        const std::vector<double> all = hex::scaled_jacobians(mesh);
        ASSERT_EQ(all.size(), mesh.cell_count());
        for (const hex::CellId c : mesh.cells()) EXPECT_EQ(all[c.index()], hex::scaled_jacobian(mesh, c));
    }
}

TEST(QualitySummary, CountsWhatTheValuesSay) {
    const hex::HexMesh mesh = perturbed_grid(6, 0.6, 4);
    const std::vector<double> values = hex::scaled_jacobians(mesh);
    const hex::QualitySummary summary = hex::summarize(mesh);
    EXPECT_EQ(summary.cells, values.size());
    EXPECT_EQ(summary.vertices, mesh.vertex_count());
    EXPECT_EQ(summary.min, *std::min_element(values.begin(), values.end()));
    EXPECT_EQ(summary.worst.index(),
              static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin()));
    EXPECT_NEAR(summary.mean, std::accumulate(values.begin(), values.end(), 0.0) / 216.0, 1e-14);
    EXPECT_EQ(summary.inverted, static_cast<std::size_t>(std::count_if(values.begin(), values.end(),
                                                                       [](double q) { return q <= 0.0; })));
    EXPECT_GT(summary.inverted, 0u);
    EXPECT_EQ(std::accumulate(summary.histogram.begin(), summary.histogram.end(), std::size_t{0}), 216u);
    for (std::size_t bin = 0; bin < 20; ++bin) {
        const double lower = -1.0 + 0.1 * static_cast<double>(bin);
        const auto inside = std::count_if(values.begin(), values.end(), [&](double q) {
            return q >= lower && (q < lower + 0.1 || bin == 19);
        });
        EXPECT_EQ(summary.histogram[bin], static_cast<std::size_t>(inside)) << "bin " << bin;
    }
}

TEST(QualitySummary, OfAPerfectGridFillsTheLastBin) {
    const hex::QualitySummary summary = hex::summarize(hex::test::grid(4, 3, 2));
    EXPECT_EQ(summary.histogram.back(), 24u);
    EXPECT_EQ(summary.min, 1.0);
    EXPECT_EQ(summary.mean, 1.0);
    EXPECT_EQ(summary.inverted, 0u);
}

TEST(QualitySummary, LeavesOutUnusedVertices) {
    const hex::HexMesh cube = hex::test::grid(1, 1, 1);
    std::vector<Vec3> positions(cube.positions().begin(), cube.positions().end());
    positions.emplace_back(9, 9, 9);
    const hex::HexMesh mesh(positions, {cube.cell_array().begin(), cube.cell_array().end()});
    EXPECT_EQ(hex::summarize(mesh).vertices, 8u);
}

TEST(QualitySummary, OfNoCellsIsAllZero) {
    const hex::QualitySummary summary = hex::summarize(hex::HexMesh());
    EXPECT_EQ(summary.cells, 0u);
    EXPECT_EQ(summary.min, 0.0);
    EXPECT_FALSE(summary.worst.valid());
}

TEST(QualitySummary, HasTheSameBitsForAnyNumberOfThreads) {
    const hex::HexMesh mesh = perturbed_grid(20, 0.4, 5);
    const hex::QualitySummary one = hex::summarize(mesh, threads_context(1));
    for (const int threads : {2, 3, 7}) {
        const hex::QualitySummary many = hex::summarize(mesh, threads_context(threads));
        EXPECT_EQ(one.mean, many.mean);
        EXPECT_EQ(one.min, many.min);
        EXPECT_EQ(one.worst, many.worst);
        EXPECT_EQ(one.histogram, many.histogram);
    }
}

}  // namespace
