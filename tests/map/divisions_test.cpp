#include "map/cases.h"

#include <hex/map/divisions.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace hex {
namespace {

/// Blocks of a grid whose planes are given, turned against each other, with the lengths of their edges.
struct Structure {
    HexMesh blocks;
    EdgeTable edges;
    BlockSheets sheets;
    std::vector<double> lengths;

    explicit Structure(HexMesh mesh)
        : blocks(std::move(mesh)), edges(edge_table(blocks)), sheets(find_sheets(blocks, edges)) {
        for (const auto& [a, b] : edges.vertices)
            lengths.push_back((blocks.position(b) - blocks.position(a)).norm());
    }
    SheetDivider divider() const { return {blocks, edges, sheets, lengths}; }
};

Structure stretched(const std::array<std::vector<double>, 3>& planes, unsigned seed = 1) {
    const auto size = [&](std::size_t axis) { return static_cast<int>(planes[axis].size()) - 1; };
    return Structure(test::moved(test::shuffled_grid(size(0), size(1), size(2), seed), [&](const Vec3& p) {
        Vec3 q;
        for (int axis = 0; axis < 3; ++axis)
            q[axis] = planes[static_cast<std::size_t>(axis)][static_cast<std::size_t>(std::lround(p[axis]))];
        return q;
    }));
}

/// Pieces along each axis of each layer of a stretched grid.
std::multiset<int> pieces_of(const Structure& s, double edge_length) {
    const auto pieces = s.divider().for_length(edge_length).pieces;
    return {pieces.begin(), pieces.end()};
}

double count_of(const Structure& s, const std::vector<int>& pieces) {
    double sum = 0;
    for (const CellId b : s.blocks.cells()) {
        double product = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) product *= pieces[s.sheets.of_axis(s.edges, b, axis)];
        sum += product;
    }
    return sum;
}

/// What divisions.h says is minimised, written down once more.
double energy_of(const Structure& s, const std::vector<int>& pieces, double edge_length) {
    const auto log_ratio = [&](double length) { return std::log(std::max(1.0, length / edge_length)); };
    std::vector<double> total(s.sheets.count), edges_of(s.sheets.count);
    for (const CellId b : s.blocks.cells())
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const std::size_t e : edges_of_axis[axis]) {
                total[s.sheets.of_axis(s.edges, b, axis)] +=
                    s.lengths[s.edges.cell_edges[b.index()][e].index()];
                edges_of[s.sheets.of_axis(s.edges, b, axis)] += 1;
            }
    double sum = 0;
    for (const CellId b : s.blocks.cells()) {
        std::array<double, 3> size{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t sheet = s.sheets.of_axis(s.edges, b, axis);
            const double cut = std::log(pieces[sheet]);
            double mean = 0;
            for (const std::size_t e : edges_of_axis[axis]) {
                const double length = s.lengths[s.edges.cell_edges[b.index()][e].index()];
                mean += length / 4;
                const double weight = length / (total[sheet] / edges_of[sheet]);
                sum += weight * std::pow(log_ratio(length) - cut, 2) / 4;
            }
            size[axis] = log_ratio(mean) - cut;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) sum += std::pow(size[axis] - size[(axis + 1) % 3], 2);
    }
    return sum;
}

TEST(BlockSheets, GridHasOneAlongEachLayer) {
    for (unsigned seed = 0; seed < 5; ++seed) {
        const HexMesh blocks = test::shuffled_grid(3, 2, 4, seed);
        const EdgeTable edges = edge_table(blocks);
        const BlockSheets sheets = find_sheets(blocks, edges);
        EXPECT_EQ(sheets.count, 9U);
        for (const CellId b : blocks.cells())
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const std::size_t e : edges_of_axis[axis])
                    EXPECT_EQ(sheets.sheet_of_edge[edges.cell_edges[b.index()][e].index()],
                              sheets.of_axis(edges, b, axis));
    }
}

/// Around an edge with an odd number of blocks the sheets run through two blocks each.
TEST(BlockSheets, FanHasOneThroughEachSector) {
    const HexMesh blocks = test::fan(5, 2);
    EXPECT_EQ(find_sheets(blocks, edge_table(blocks)).count, 5U + 2U);
}

TEST(Divisions, WholeRatiosAreMet) {
    const Structure s = stretched({{{0, 3, 4}, {0, 2}, {0, 1, 6}}});
    EXPECT_EQ(pieces_of(s, 1.0), (std::multiset<int>{3, 1, 2, 1, 5}));
    EXPECT_EQ(pieces_of(s, 0.1), (std::multiset<int>{30, 10, 20, 10, 50}));
}

TEST(Divisions, NeverLessThanOne) {
    const Structure s = stretched({{{0, 3, 4}, {0, 2}, {0, 1, 6}}});
    EXPECT_EQ(pieces_of(s, 1000.0), (std::multiset<int>{1, 1, 1, 1, 1}));
}

/// 1.45 rounded by itself is 2 (in ratio), 1.38 is 1: together they are neither.
TEST(Divisions, NearlyCubicBlocksStayNearlyCubic) {
    for (unsigned seed = 0; seed < 6; ++seed) {
        const std::multiset<int> pieces =
            pieces_of(stretched({{{0, 1.45}, {0, 1.38}, {0, 1.41}}}, seed), 1.0);
        EXPECT_EQ(*pieces.begin(), *pieces.rbegin());
    }
}

/// A plate cannot be cut less than once; that must not refine its faces.
TEST(Divisions, ThinPlatesDoNotRefineTheirFaces) {
    EXPECT_EQ(pieces_of(stretched({{{0, 10}, {0, 7}, {0, 0.05}}}), 1.0), (std::multiset<int>{10, 7, 1}));
}

/// Against all choices.
TEST(Divisions, AreTheBestOfAll) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(0.3, 4.0);
    for (int trial = 0; trial < 20; ++trial) {
        const double a = number(random), b = number(random), c = number(random), d = number(random);
        Structure s = stretched({{{0, a, a + b}, {0, c}, {0, d}}});
        // Edges of a sheet differ in length.
        for (double& length : s.lengths) length *= 0.5 + 0.25 * number(random);
        const std::vector<int> chosen = s.divider().for_length(1.0).pieces;
        double best = energy_of(s, chosen, 1.0);
        std::vector<int> pieces(4);
        for (int k = 0; k < 7 * 7 * 7 * 7; ++k) {
            pieces = {1 + k % 7, 1 + k / 7 % 7, 1 + k / 49 % 7, 1 + k / 343};
            EXPECT_GE(energy_of(s, pieces, 1.0), best - 1e-5) << trial << ": " << k;
        }
    }
}

/// Of a sheet that is thin nearly everywhere, the one long edge is cut: elements a block long miss the
/// surface.
TEST(Divisions, LongEdgesOfAThinSheetAreCut) {
    Structure s = stretched({{{0, 1, 2, 3, 4, 5, 6, 7, 8}, {0, 1}, {0, 1}}});
    const std::size_t sheet = s.sheets.of_axis(s.edges, CellId(0), 1);
    bool first = true;
    for (std::size_t e = 0; e < s.lengths.size(); ++e) {
        if (s.sheets.sheet_of_edge[e] != sheet) continue;
        s.lengths[e] = first ? 12.0 : 1.0;
        first = false;
    }
    EXPECT_GE(s.divider().for_length(1.0).pieces[sheet], 2);
}

TEST(Divisions, CountIsThatOfTheHexahedra) {
    const Structure s = stretched({{{0, 3, 4}, {0, 2}, {0, 1, 6}}});
    for (const std::size_t target : {1U, 10U, 100U, 1000U, 12345U, 1000000U}) {
        const SheetDivisions found = s.divider().for_count(target);
        EXPECT_EQ(static_cast<double>(found.hexes), count_of(s, found.pieces));
        if (target >= 100) {
            EXPECT_NEAR(std::log(static_cast<double>(found.hexes) / static_cast<double>(target)), 0.0, 0.2);
        }
    }
    EXPECT_EQ(s.divider().for_count(1).hexes, s.blocks.cell_count());
}

/// All sheets are alike, so by size alone they would change at once: 8, 64, 216, ...
TEST(Divisions, SymmetricBlocksAreNotAllCutAtOnce) {
    const Structure s = stretched({{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}}});
    for (const std::size_t target : {30U, 120U, 500U}) {
        const SheetDivisions found = s.divider().for_count(target);
        EXPECT_NEAR(std::log(static_cast<double>(found.hexes) / static_cast<double>(target)), 0.0, 0.2)
            << target;
    }
}

TEST(Divisions, DoNotDependOnTheUnit) {
    Structure s = stretched({{{0, 3.3, 4.1}, {0, 2.7}, {0, 1.4, 6}}});
    const SheetDivisions metres = s.divider().for_length(0.77);
    const SheetDivisions counted = s.divider().for_count(500);
    for (double& length : s.lengths) length *= 1000;
    EXPECT_EQ(s.divider().for_length(770).pieces, metres.pieces);
    EXPECT_EQ(s.divider().for_count(500).pieces, counted.pieces);
}

TEST(Divisions, EdgesWithoutLength) {
    Structure s = stretched({{{0, 1, 2}, {0, 1}, {0, 1}}});
    s.lengths.assign(s.lengths.size(), 0.0);
    EXPECT_EQ(s.divider().for_length(1.0).hexes, 2U);
    EXPECT_EQ(s.divider().for_count(100).hexes, 2U);
}

}  // namespace
}  // namespace hex
