/// The parts of the automatic method by themselves: energy, order of charts, operators, new courses.
#include "segment/chart_order.h"
#include "segment/label_energy.h"
#include "segment/label_repair.h"
#include "segment/label_reroute.h"
#include "segment/repair_operators.h"
#include "support/surfaces.h"

#include <hex/segment/charts.h>

#include <gtest/gtest.h>

#include <random>

namespace hex {
namespace {

/// A box of 8 x 8 x 2 triangles a side, and the labels of its sides.
struct Box {
    TriangleMesh mesh;
    LabelSurface surface;
    std::vector<int> labels;

    Box() : mesh(make_triangle_mesh(test::box_surface(1, 1, 1, 8))) {
        surface = label_surface(mesh, Eigen::Matrix3d::Identity());
        for (const auto f : mesh.faces()) labels.push_back(mesh.data(f).part - 1);
    }
    LabelScore score() const { return LabelEnergy(surface).evaluate(labels); }
    LabelCharts charts() const { return find_charts(mesh, {labels}); }
    std::vector<int> triangles_near(const Vec3& place, double radius) const {
        std::vector<int> found;
        for (const auto f : mesh.faces()) {
            if ((to_eigen(mesh.calc_face_centroid(f)) - place).norm() < radius) found.push_back(f.idx());
        }
        return found;
    }
    void set(const std::vector<int>& triangles, int label) {
        for (const int t : triangles) labels[static_cast<std::size_t>(t)] = label;
    }
    /// Some proposal of this operator makes the labels valid.
    bool mended_by(const std::vector<LabelChange>& changes, const std::string& repair) const {
        for (const LabelChange& change : changes) {
            EXPECT_EQ(change.repair, repair);
            auto tried = labels;
            for (const auto& [t, label] : change.labels) {
                EXPECT_NE(tried[static_cast<std::size_t>(t)], label);
                tried[static_cast<std::size_t>(t)] = label;
            }
            if (LabelEnergy(surface).evaluate(tried).valid()) return true;
        }
        return false;
    }
};

TEST(LabelEnergy, ABoxIsPerfect) {
    const LabelScore score = Box().score();
    EXPECT_TRUE(score.valid());
    EXPECT_NEAR(score.infidelity, 0, 1e-12);
    EXPECT_EQ(score.charts, 6);
    EXPECT_EQ(score.turns, 0);
    EXPECT_EQ(score.crossings, 0);
    EXPECT_EQ(score.disorder, 0);
}

TEST(LabelEnergy, CountsWhatFindChartsAndValidateChartsCount) {
    Box box;
    std::mt19937 random(3);
    for (int round = 0; round < 30; ++round) {
        for (int i = 0; i < 12; ++i)
            box.labels[random() % box.labels.size()] = static_cast<int>(random() % 6);
        const LabelScore score = box.score();
        const LabelCharts charts = box.charts();
        std::size_t opposite = 0, few = 0;
        for (const auto& violation : validate_charts(charts)) {
            opposite += violation.code == "opposite-labels-adjacent";
            few += violation.code == "chart-too-few-boundaries";
        }
        EXPECT_EQ(static_cast<std::size_t>(score.charts), charts.charts.size());
        EXPECT_EQ(static_cast<std::size_t>(score.opposite), opposite);
        EXPECT_EQ(static_cast<std::size_t>(score.few_sided), few);
        int turns = 0;
        for (const auto& boundary : charts.boundaries) {
            if (boundary.vertices.front() != boundary.vertices.back())
                turns += count_turns(box.surface, charts, boundary);
        }
        EXPECT_GE(score.turns, turns);  // those of closed boundaries come on top
    }
}

TEST(LabelEnergy, APreparedRegionGivesTheSameScore) {
    Box box;
    LabelEnergy energy(box.surface);
    const auto region = box.triangles_near(Vec3(1, 1, 0.6), 0.3);
    ASSERT_GT(region.size(), 10U);
    energy.prepare(box.labels, region);
    std::mt19937 random(4);
    for (int round = 0; round < 50; ++round) {
        for (const int t : region) box.labels[static_cast<std::size_t>(t)] = static_cast<int>(random() % 6);
        const LabelScore a = energy.evaluate_prepared(box.labels);
        const LabelScore b = box.score();
        EXPECT_EQ(a.charts, b.charts);
        EXPECT_EQ(a.opposite, b.opposite);
        EXPECT_EQ(a.missing_sides, b.missing_sides);
        EXPECT_EQ(a.crossings, b.crossings);
        EXPECT_EQ(a.turns, b.turns);
        EXPECT_EQ(a.disorder, b.disorder);
        EXPECT_NEAR(a.infidelity, b.infidelity, 1e-12);
    }
}

TEST(LabelCosts, RiseWithTheAngleAndFastBehindThePlane) {
    for (double c = 1.0; c > -0.99; c -= 0.01) EXPECT_GT(label_cost(c - 0.01), label_cost(c));
    EXPECT_EQ(label_cost(1), 0);
    EXPECT_GT(label_cost(-0.2) - label_cost(-0.1), 10 * (label_cost(0.5) - label_cost(0.6)));
}

TEST(ChartOrder, ACycleAndAnArcToItselfAreConflicts) {
    ChartOrder order;
    order.add({0, 1, 10});
    order.add({1, 2, 11});
    order.add({0, 2, 12});
    EXPECT_TRUE(order.conflicts().empty());
    EXPECT_EQ(order.disorder(), 0);
    order.clear();
    for (const auto& [before, after] : {std::pair{0, 1}, {1, 2}, {2, 1}, {2, 3}})
        order.add({before, after, before});
    EXPECT_EQ(order.conflicts().size(), 2U);
    EXPECT_EQ(order.disorder(), 2);
    order.clear();
    order.add({4, 4, 0});
    EXPECT_EQ(order.conflicts().size(), 1U);
    EXPECT_GT(order.disorder(), 0);
}

TEST(RepairOperators, MergeAndDissolveRemoveAnIsland) {
    Box box;
    const auto island = box.triangles_near(Vec3(0.5, 0.5, 1), 0.2);
    box.set(island, 0);
    ASSERT_FALSE(box.score().valid());
    const LabelCharts charts = box.charts();
    const RepairOperators operators(box.surface, box.labels, charts);
    const int chart = charts.chart_of_triangle[static_cast<std::size_t>(island.front())];
    std::vector<LabelChange> merged, dissolved;
    operators.merge_chart(chart, merged);
    operators.dissolve_chart(chart, dissolved);
    EXPECT_TRUE(box.mended_by(merged, "merge-chart"));
    EXPECT_TRUE(box.mended_by(dissolved, "dissolve-chart"));
}

TEST(RepairOperators, InsertChartPartsOppositeLabels) {
    // The +Y side as well as half of +X's neighbour, all but the far ends, become -X: it touches +X.
    Box box;
    for (const auto f : box.mesh.faces()) {
        auto& label = box.labels[static_cast<std::size_t>(f.idx())];
        if (label == 2) label = 1;
    }
    ASSERT_EQ(box.score().opposite, 1);
    const LabelCharts charts = box.charts();
    const RepairOperators operators(box.surface, box.labels, charts);
    std::vector<LabelChange> changes;
    for (std::size_t b = 0; b < charts.boundaries.size(); ++b) {
        const auto& pair = charts.boundaries[b].charts;
        if (opposite_labels(charts.charts[static_cast<std::size_t>(pair[0])].label,
                            charts.charts[static_cast<std::size_t>(pair[1])].label))
            operators.insert_chart(static_cast<int>(b), changes);
    }
    EXPECT_TRUE(box.mended_by(changes, "insert-chart"));
}

TEST(Straighten, AZigZagBecomesMonotoneAndNothingElseChanges) {
    // Triangles of +Z across the edge to +X take +X here and there: the boundary turns back.
    Box box;
    const auto notch = box.triangles_near(Vec3(1, 0.5, 1), 0.2);
    box.set(notch, 0);
    const LabelScore before = box.score();
    ASSERT_TRUE(before.valid());
    const LabelCharts charts = box.charts();
    std::vector<LabelChange> changes;
    for (std::size_t b = 0; b < charts.boundaries.size(); ++b) {
        const auto& pair = charts.boundaries[b].charts;
        const int sum = charts.charts[static_cast<std::size_t>(pair[0])].label +
                        charts.charts[static_cast<std::size_t>(pair[1])].label;
        if (sum == 4) straighten_boundary(box.surface, box.labels, charts, static_cast<int>(b), changes);
    }
    ASSERT_FALSE(changes.empty());
    bool straight = false;
    for (const LabelChange& change : changes) {
        auto tried = box.labels;
        for (const auto& [t, label] : change.labels) {
            EXPECT_TRUE(label == 0 || label == 4);
            tried[static_cast<std::size_t>(t)] = label;
        }
        const LabelScore after = LabelEnergy(box.surface).evaluate(tried);
        straight |= after.valid() && after.turns == 0 && after.infidelity < before.infidelity;
    }
    EXPECT_TRUE(straight);
}

TEST(LabelRepair, NeverRaisesTheEnergyAndTellsEveryCost) {
    Box box;
    std::mt19937 random(8);
    for (int i = 0; i < 60; ++i) box.labels[random() % box.labels.size()] = static_cast<int>(random() % 6);
    const LabelScore before = box.score();
    ASSERT_FALSE(before.valid());
    const LabelRepair repair = repair_labels(box.mesh, box.surface, box.labels, {});
    EXPECT_TRUE(repair.score.valid());
    EXPECT_LT(repair.score.energy(1.0), before.energy(1.0));
    double cost = 0;
    for (const auto& record : repair.repairs) cost += record.cost;
    EXPECT_NEAR(cost, repair.score.infidelity - before.infidelity, 1e-9);
}

}  // namespace
}  // namespace hex
