/// \file divisions.h
/// Into how many pieces each sheet of a block structure is cut, for elements of a given size.
#pragma once

#include <hex/base/context.h>
#include <hex/map/block_sheets.h>

#include <cstddef>
#include <vector>

namespace hex {

/// The numbers of pieces that were chosen.
struct SheetDivisions {
    std::vector<int> pieces;   ///< one a sheet, at least 1
    double edge_length = 0.0;  ///< what they were chosen for
    std::size_t hexes = 0;     ///< hexahedra that they give
};

/// Chooses one number of pieces n a sheet that minimises, over all blocks, the squares of
///
///     log(length / (n H))      of the 12 edges, a quarter each, times the edge's length over the mean of its
///                              sheet: elements as large as asked, above all where they are long
///     log(p) - log(q)          for the mean edge lengths p, q of its elements along two axes: near-cubic
///
/// with n >= 1. Without the second sum every sheet would be rounded by itself, and blocks of 1.4 H to 1.5 H
/// would become elements of aspect 2; with it the choice is an integer program (CBC): a binary variable for
/// each sheet and candidate, a product for each two sheets that cross in a block, in the local marginal
/// formulation (Werner: A linear programming approach to max-sum problem, PAMI 29 (2007)). An edge shorter
/// than H counts as H, since it cannot be cut less: thin plates do not refine their faces.
///
/// Structures with more than a few hundred crossing pairs are left at the best that changing one sheet at a
/// time finds. The result depends on ratios of lengths only, and is the same for every place of the blocks in
/// space but for exact ties, which the numbering of the sheets breaks.
class SheetDivider {
  public:
    /// `lengths`: one an edge of the table, of the curve it is mapped to; not negative.
    SheetDivider(const HexMesh& blocks, const EdgeTable& edges, const BlockSheets& sheets,
                 const std::vector<double>& lengths);

    /// H = `edge_length` > 0.
    SheetDivisions for_length(double edge_length, const Context& context = {}) const;

    /// H is sought so that the number of hexahedra comes near to `hexes`. Where many sheets change at the
    /// same H, as in symmetric parts, that leaves a gap; it is closed to 2 % where it can be by one piece
    /// more or less in single sheets, the cheapest first. The number is never below that of the blocks.
    SheetDivisions for_count(std::size_t hexes, const Context& context = {}) const;

  private:
    struct Axis {
        std::size_t sheet;
        double mean_length;
    };
    struct Model;

    Model model(double edge_length) const;
    /// Of one edge in the sum over its sheet; 1 on average.
    double weight_in(std::size_t sheet, double length) const;
    double count(const std::vector<int>& pieces) const;
    double energy_around(std::size_t sheet, const std::vector<int>& pieces, double edge_length) const;
    SheetDivisions nudged(SheetDivisions divisions, double target) const;
    SheetDivisions solved(double edge_length, const Context& context) const;

    std::size_t sheet_count_;
    std::vector<std::array<Axis, 3>> blocks_;
    std::vector<std::vector<double>> sheet_lengths_;      ///< four a block axis
    std::vector<double> sheet_mean_;                      ///< of these lengths
    std::vector<std::vector<std::size_t>> sheet_blocks_;  ///< blocks that a sheet runs through
};

}  // namespace hex
