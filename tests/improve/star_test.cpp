/// The parts under the methods: the star of a vertex, and the classes of vertices.

#include "improve/star.h"

#include "improve/coloring.h"
#include "improve/improve_cases.h"

#include <gtest/gtest.h>

#include <set>

namespace {

using hex::Vec3;
using hex::VertexId;
using hex::improving::Star;
using hex::test::shaken_grid;

/// Smallest scaled Jacobian around v with v at p, from the public function.
double minimum_at(hex::HexMesh mesh, VertexId v, const Vec3& p) {
    mesh.set_position(v, p);
    const auto cells = hex::vertex_cells(mesh);
    double smallest = 1.0;
    for (const hex::CellId c : cells[v.index()]) smallest = std::min(smallest, hex::scaled_jacobian(mesh, c));
    return smallest;
}

TEST(Star, HasTheQualityOfItsCells) {
    for (const double amount : {0.3, 0.9}) {
        const hex::HexMesh mesh = shaken_grid(4, 3, 3, amount, 1);
        const auto stars = hex::improving::vertex_stars(mesh);
        Star star;
        for (const VertexId v : mesh.vertices()) {
            star.gather(mesh, stars[v.index()]);
            const auto quality = star.quality(mesh.position(v));
            EXPECT_NEAR(quality.min, minimum_at(mesh, v, mesh.position(v)), 1e-14) << v;
            std::size_t inverted = 0;
            for (const auto& c : stars[v.index()])
                inverted += hex::scaled_jacobian(mesh, hex::CellId(c.cell)) <= 0.0;
            EXPECT_EQ(quality.inverted, inverted) << v;
        }
    }
}

TEST(Star, StoresTheScaledJacobiansOfItsCells) {
    const hex::HexMesh mesh = shaken_grid(3, 3, 3, 0.4, 2);
    const auto stars = hex::improving::vertex_stars(mesh);
    Star star;
    std::vector<double> values(mesh.cell_count(), 9.0);
    for (const VertexId v : mesh.vertices()) {
        star.gather(mesh, stars[v.index()]);
        star.store(mesh.position(v), values);
    }
    for (const hex::CellId c : mesh.cells())
        EXPECT_NEAR(values[c.index()], hex::scaled_jacobian(mesh, c), 1e-14) << c;
}

TEST(Star, AllowsAMoveOnlyIfTheMinimumDoesNotFall) {
    const hex::HexMesh mesh = shaken_grid(4, 4, 4, 0.4, 3);
    const auto stars = hex::improving::vertex_stars(mesh);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> shift(-0.05, 0.05);
    Star star;
    int allowed = 0;
    int refused = 0;
    for (const VertexId v : mesh.vertices()) {
        const Vec3& here = mesh.position(v);
        star.gather(mesh, stars[v.index()]);
        const double before = minimum_at(mesh, v, here);
        for (int i = 0; i < 5; ++i) {
            const Vec3 there = here + Vec3(shift(random), shift(random), shift(random));
            const double after = minimum_at(mesh, v, there);
            if (star.allows(here, there, before)) {
                ++allowed;
                EXPECT_GE(after, before);
            } else {
                ++refused;
            }
        }
    }
    EXPECT_GT(allowed, 50);
    EXPECT_GT(refused, 50);
}

TEST(Star, DirectionsRaiseTheMinimum) {
    const hex::HexMesh mesh = shaken_grid(6, 6, 6, 0.45, 5);
    const auto stars = hex::improving::vertex_stars(mesh);
    const auto anywhere = [](const Vec3& gradient) { return gradient; };
    Star star;
    int tried = 0;
    for (const VertexId v : mesh.vertices()) {
        const Vec3& here = mesh.position(v);
        star.gather(mesh, stars[v.index()]);
        star.compute_terms(here);
        const Vec3 steepest = star.steepest_ascent(1e-9, anywhere);
        const double before = minimum_at(mesh, v, here);
        if (!(steepest.norm() > 1e-3)) continue;
        const double step = 1e-6;
        const double rise = (minimum_at(mesh, v, here + step * steepest.normalized()) - before) / step;
        const double fall = (before - minimum_at(mesh, v, here - step * steepest.normalized())) / step;
        if (rise == 0.0 && fall == 0.0) continue;  // the minimum belongs to a corner that does not see v
        ++tried;
        EXPECT_NEAR(rise, steepest.norm(), 1e-4 * (1.0 + steepest.norm())) << v;
    }
    EXPECT_GT(tried, 60);
}

TEST(Star, TheWeightedDirectionIsTheGradientOfTheWorstWhenItStandsAlone) {
    // With a tiny softness only the smallest number counts; compare with central differences of the minimum.
    const hex::HexMesh mesh = shaken_grid(5, 5, 5, 0.4, 6);
    const auto stars = hex::improving::vertex_stars(mesh);
    Star star;
    int tried = 0;
    for (const VertexId v : mesh.vertices()) {
        const Vec3& here = mesh.position(v);
        star.gather(mesh, stars[v.index()]);
        star.compute_terms(here);
        const Vec3 direction = star.weighted_ascent(1e-6);
        Vec3 difference;
        const double step = 1e-6;
        for (Eigen::Index d = 0; d < 3; ++d) {
            const Vec3 shift = step * Vec3::Unit(d);
            difference[d] =
                (minimum_at(mesh, v, here + shift) - minimum_at(mesh, v, here - shift)) / (2.0 * step);
        }
        if (difference.isZero(0.0)) continue;  // the minimum belongs to a corner that does not see v
        ++tried;
        EXPECT_NEAR((direction - difference).norm(), 0.0, 1e-4 * (1.0 + difference.norm())) << v;
    }
    EXPECT_GT(tried, 20);
}

TEST(IndependentClasses, NeverHaveTwoVerticesInOneCell) {
    for (const hex::HexMesh& mesh : {hex::test::shuffled_grid(6, 5, 4, 7), hex::test::fan(5, 3)}) {
        const std::vector<char> all(mesh.vertex_count(), 1);
        const auto classes = hex::improving::independent_classes(mesh, all);
        std::vector<std::size_t> class_of(mesh.vertex_count(), classes.size());
        std::size_t total = 0;
        for (std::size_t k = 0; k < classes.size(); ++k) {
            EXPECT_TRUE(std::is_sorted(classes[k].begin(), classes[k].end()));
            for (const VertexId v : classes[k]) class_of[v.index()] = k;
            total += classes[k].size();
        }
        EXPECT_EQ(total, mesh.vertex_count()) << "each vertex is in one class";
        for (const hex::CellId c : mesh.cells()) {
            std::set<std::size_t> seen;
            for (const VertexId v : mesh.cell(c)) seen.insert(class_of[v.index()]);
            EXPECT_EQ(seen.size(), 8u) << "cell " << c;
        }
        EXPECT_LE(classes.size(), 27u);
    }
}

TEST(IndependentClasses, KeepApartWhoReadsWhom) {
    const hex::HexMesh mesh = hex::test::grid(8, 2, 2);
    const std::vector<char> all(mesh.vertex_count(), 1);
    hex::CompressedRows<VertexId> reads;  // v reads v + 3 and v + 5, whatever cells they are in
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        for (const std::size_t step : {3, 5})
            if (v + step < mesh.vertex_count()) reads.values.emplace_back(v + step);
        reads.offsets.push_back(reads.values.size());
    }
    std::size_t total = 0;
    for (const auto& members :
         hex::improving::independent_classes(mesh, hex::vertex_cells(mesh), all, reads)) {
        total += members.size();
        const std::set<VertexId> set(members.begin(), members.end());
        for (const VertexId v : members)
            for (const VertexId other : reads[v.index()])
                EXPECT_EQ(set.count(other), 0u) << v << " reads " << other;
    }
    EXPECT_EQ(total, mesh.vertex_count());
}

TEST(IndependentClasses, HoldTheWantedVerticesOnly) {
    const hex::HexMesh mesh = hex::test::grid(3, 3, 3);
    std::vector<char> wanted(mesh.vertex_count(), 0);
    wanted[21] = wanted[22] = wanted[42] = 1;
    std::set<VertexId> found;
    for (const auto& members : hex::improving::independent_classes(mesh, wanted))
        found.insert(members.begin(), members.end());
    EXPECT_EQ(found, (std::set<VertexId>{VertexId(21), VertexId(22), VertexId(42)}));
}

}  // namespace
