// Metrics with known values; equality with Verdict itself is tests/cli/verdict_test.py's.
#include "quality/scaled_jacobian_range.h"
#include "support/meshes.h"

#include <hex/quality/hex_metrics.h>
#include <hex/quality/scaled_jacobian.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>

namespace hex {
namespace {

using Corners = std::array<Vec3, 8>;

Corners box(double x, double y, double z) {
    Corners corners;
    for (std::size_t c = 0; c < 8; ++c) {
        const auto& uvw = hexahedron::corner_uvw[c];
        corners[c] = {x * uvw[0], y * uvw[1], z * uvw[2]};
    }
    return corners;
}

HexMesh shaken_grid(int n, double amount) {
    HexMesh mesh = test::shuffled_grid(n, n, n, 3);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> move(-amount, amount);
    for (const VertexId v : mesh.vertices()) {
        const Vec3 by(move(random), move(random), move(random));
        mesh.set_position(v, mesh.position(v) + by);
    }
    return mesh;
}

TEST(HexMetrics, AUnitCubeIsIdeal) {
    for (const HexMetricInfo& metric : hex_metrics())
        EXPECT_NEAR(evaluate(metric.metric, box(1, 1, 1)), metric.ideal, 1e-14) << metric.name;
}

TEST(HexMetrics, TheTwentyOfVtkAreThere) {
    std::size_t count = 0;
    for (const HexMetricInfo& metric : hex_metrics()) count += metric.in_vtk ? 1 : 0;
    EXPECT_EQ(count, 20U);
}

TEST(HexMetrics, NamesAreFoundInBothSpellings) {
    for (const HexMetricInfo& metric : hex_metrics()) EXPECT_EQ(find_hex_metric(metric.name), metric.metric);
    EXPECT_EQ(find_hex_metric("ScaledJacobian"), HexMetric::scaled_jacobian);
    EXPECT_EQ(find_hex_metric("MaxEdgeRatios"), HexMetric::max_edge_ratio);
    EXPECT_FALSE(find_hex_metric("none").has_value());
    EXPECT_FALSE(find_hex_metric("").has_value());
}

TEST(HexMetrics, OfABoxAsComputedByHand) {
    const Corners corners = box(1, 2, 4);
    const auto value = [&](HexMetric metric) { return evaluate(metric, corners, 8.0); };
    EXPECT_DOUBLE_EQ(value(HexMetric::volume), 8);
    EXPECT_DOUBLE_EQ(value(HexMetric::jacobian), 8);
    EXPECT_DOUBLE_EQ(value(HexMetric::aspect_ratio), 4);
    EXPECT_DOUBLE_EQ(value(HexMetric::max_edge_ratio), 4);
    EXPECT_DOUBLE_EQ(value(HexMetric::stretch), std::sqrt(3.0) / std::sqrt(21.0));
    EXPECT_DOUBLE_EQ(value(HexMetric::diagonal), 1);
    EXPECT_DOUBLE_EQ(value(HexMetric::shape), 3 * 4 / 21.0);
    EXPECT_NEAR(value(HexMetric::relative_size_squared), 1, 1e-10);
    // |A| |A^-1| / 3 with the singular values 1, 2, 4.
    EXPECT_DOUBLE_EQ(value(HexMetric::condition), std::sqrt(21.0 * (1 + 1 / 4.0 + 1 / 16.0)) / 3);
    EXPECT_DOUBLE_EQ(value(HexMetric::scaled_jacobian), 1);
    EXPECT_DOUBLE_EQ(value(HexMetric::skew), 0);
    EXPECT_DOUBLE_EQ(value(HexMetric::warpage), 0);
    EXPECT_DOUBLE_EQ(value(HexMetric::equiangle_skew), 0);
}

TEST(HexMetrics, OfAShearedCube) {
    Corners corners = box(1, 1, 1);
    for (std::size_t c = 4; c < 8; ++c) corners[c].x() += 1;
    EXPECT_NEAR(evaluate(HexMetric::min_angle, corners), 45, 1e-12);
    EXPECT_NEAR(evaluate(HexMetric::max_angle, corners), 135, 1e-12);
    EXPECT_NEAR(evaluate(HexMetric::equiangle_skew, corners), 0.5, 1e-12);
    EXPECT_NEAR(evaluate(HexMetric::skew, corners), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(evaluate(HexMetric::shear, corners), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(evaluate(HexMetric::nodal_jacobian_ratio, corners), 1, 1e-12);
}

TEST(HexMetrics, AReentrantFaceHasAnAngleBeyond180Degrees) {
    Corners corners = box(1, 1, 1);
    for (const std::size_t c : {std::size_t{2}, std::size_t{6}}) corners[c] = {0.25, 0.25, corners[c].z()};
    EXPECT_GT(evaluate(HexMetric::max_angle, corners), 180.0);
    EXPECT_LT(evaluate(HexMetric::scaled_jacobian, corners), 0.0);
}

TEST(HexMetrics, AFoldedFaceIsWarped) {
    Corners corners = box(1, 1, 1);
    corners[6].z() += 1;
    EXPECT_GT(evaluate(HexMetric::warpage, corners), 50.0);
}

TEST(HexMetrics, DegenerateElementsHaveFiniteNumbers) {
    for (const Corners& corners :
         {box(0, 0, 0), box(1, 1, 0), box(1, 0, 0), box(1e200, -1e200, 1e200), box(1e-200, 1e-200, 1)}) {
        for (const HexMetricInfo& metric : hex_metrics()) {
            EXPECT_TRUE(std::isfinite(evaluate(metric.metric, corners))) << metric.name;
        }
    }
}

TEST(HexMetrics, MeshesAndElementsAgree) {
    const HexMesh mesh = shaken_grid(6, 0.4);
    double volume = 0.0;
    for (const CellId c : mesh.cells()) volume += evaluate(HexMetric::volume, mesh.corner_positions(c));
    for (const HexMetricInfo& metric : hex_metrics()) {
        const std::vector<double> values = evaluate(metric.metric, mesh);
        ASSERT_EQ(values.size(), mesh.cell_count());
        for (const CellId c : mesh.cells()) {
            const double expected = evaluate(metric.metric, mesh.corner_positions(c),
                                             volume / static_cast<double>(mesh.cell_count()));
            EXPECT_NEAR(values[c.index()], expected, 1e-12 * std::max(1.0, std::abs(expected)))
                << metric.name;
        }
    }
}

TEST(HexMetrics, WideAndNarrowProcessorsGiveTheSameBits) {
    const quality::RangeFunction wide = quality::scaled_jacobians_avx2();
    if (wide == nullptr) GTEST_SKIP() << "no AVX2 here";
    HexMesh mesh = shaken_grid(11, 0.7);
    mesh.set_position(VertexId(5), mesh.position(VertexId(6)));  // an edge without length
    std::vector<double> one(mesh.cell_count()), other(mesh.cell_count());
    quality::scaled_jacobians_portable(mesh, 0, one.size(), one);
    // In pieces that are no multiple of the width.
    for (std::size_t first = 0; first < other.size(); first += 7)
        wide(mesh, first, std::min(first + 7, other.size()), other);
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0);
    for (const CellId c : mesh.cells()) EXPECT_EQ(one[c.index()], scaled_jacobian(mesh, c));
}

TEST(MetricStatistics, OfAListOfNumbers) {
    std::vector<double> values;
    for (int i = 100; i >= 1; --i) values.push_back(i);
    const MetricStatistics s = statistics(values);
    EXPECT_EQ(s.min, 1);
    EXPECT_EQ(s.max, 100);
    EXPECT_DOUBLE_EQ(s.mean, 50.5);
    EXPECT_EQ(s.median, 50);
    EXPECT_EQ(s.percentile_1, 1);
    EXPECT_EQ(s.percentile_99, 99);
    EXPECT_EQ(percentile(values, 0), 1);
    EXPECT_EQ(percentile(values, 100), 100);
    EXPECT_EQ(statistics({}).max, 0);
    EXPECT_EQ(percentile({}, 50), 0);
}

TEST(HexMetrics, APercentileHasTheNearestRankForEveryPercentThatIsWritten) {
    for (const std::size_t count : {1UL, 7UL, 37UL, 100UL, 250UL, 1000UL, 3000UL}) {
        std::vector<double> ranks(count);
        for (std::size_t i = 0; i < count; ++i) ranks[i] = static_cast<double>(i + 1);
        // Tenths of a percent, in whole numbers: ceil(tenths * count / 1000).
        for (std::size_t tenths = 1; tenths <= 1000; tenths += tenths % 10 == 9   ? 1
                                                               : tenths % 10 == 0 ? 1
                                                                                  : 8) {
            const double percent = static_cast<double>(tenths) / 10.0;
            const std::size_t rank = (tenths * count + 999) / 1000;
            EXPECT_EQ(percentile(ranks, percent), static_cast<double>(rank)) << percent << " of " << count;
        }
    }
}

TEST(WorstCells, ComeInTheOrderOfTheirBadnessThenOfTheirIds) {
    const std::vector<double> values = {3, 1, 2, 1, 9};
    using Ids = std::vector<CellId>;
    EXPECT_EQ(worst_cells(values, BetterWhen::larger, 3), (Ids{CellId(1), CellId(3), CellId(2)}));
    EXPECT_EQ(worst_cells(values, BetterWhen::smaller, 2), (Ids{CellId(4), CellId(0)}));
    EXPECT_EQ(worst_cells(values, BetterWhen::neither, 1), (Ids{CellId(4)}));
    EXPECT_EQ(worst_cells(values, BetterWhen::larger, 9).size(), 5U);
}

}  // namespace
}  // namespace hex
