/// \file voxel_cells.h
/// A set of grid cells and its topology: where its boundary is no manifold, which cells can be added or
/// removed without changing it, and the components of its boundary.
#pragma once

#include "polycube/voxel_grid.h"

#include <vector>

namespace hex::voxels {

/// A connected component of the boundary: between one connected piece of the taken cells and one of the
/// others. Valid for sets without bad nodes, where any two pieces share at most one.
struct BoundaryComponent {
    int inner = 0;  ///< piece of taken cells
    int outer = 0;  ///< piece of other cells
    std::size_t faces = 0;
    std::size_t nodes = 0;
    std::size_t first_cell = 0;  ///< the first taken cell at it
    /// Of a closed quad mesh: every face has four edges and shares each with one other.
    int euler_characteristic() const { return static_cast<int>(nodes) - static_cast<int>(faces); }
};

struct Pieces {
    std::vector<int> piece;  ///< of each cell; the outermost cells are in piece 0
    int count = 0;
    std::vector<BoundaryComponent> boundaries;  ///< by inner, then outer piece
};

/// Cells of the outermost layer of the grid are never taken.
class CellSet {
  public:
    CellSet(const Grid& grid, std::vector<char> taken);

    const Grid& grid() const { return *grid_; }
    bool taken(std::size_t cell) const { return taken_[cell] != 0; }
    std::size_t size() const;
    /// Whether the cell may be added or removed at all: it is not in the outermost layer.
    bool changeable(const Cell& c) const;
    void flip(std::size_t cell) { taken_[cell] = static_cast<char>(taken_[cell] == 0); }

    /// A node is good when the boundary at it is a disk and some direction sees all its faces from outside.
    bool good_node(const Cell& node) const;
    /// Bad ones among the eight nodes of a cell.
    int bad_nodes(const Cell& c) const;
    /// Whether adding or removing the cell leaves the topology as it is (it is a simple point, by the numbers
    /// of connected pieces among its 18 neighbours) and all its nodes good.
    bool simple(const Cell& c) const;

    /// Adds and removes cells, those with shares near one half first, until every node is good. \param
    /// shares samples inside of each cell. Returns how many changed, or -1 when it does not succeed.
    int repair(const std::vector<std::uint8_t>& shares);

    Pieces pieces() const;

  private:
    unsigned pattern(const Cell& node) const;
    bool simple_here(const Cell& c) const;

    const Grid* grid_;
    std::vector<char> taken_;
    std::array<std::ptrdiff_t, 3> stride_;
};

}  // namespace hex::voxels
