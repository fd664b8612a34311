/// \file coloring.h
/// Classes of vertices that can be moved at the same time.
#pragma once

#include <hex/volume/topology.h>

#include <vector>

namespace hex::improving {

/// Splits the vertices with `wanted[v]` into classes such that no two of a class are in one cell: each can be
/// judged and moved without the others knowing. Greedy in vertex order, so the same for every run; a class
/// lists its vertices in ascending order. Linear in the number of cells.
std::vector<std::vector<VertexId>> independent_classes(const HexMesh& mesh, const std::vector<char>& wanted);

/// The same, and nobody is in a class with a vertex of its row of `reads`: those whose places, besides those
/// of its own cells, matter for it.
/// \param cells the cells around each vertex
std::vector<std::vector<VertexId>> independent_classes(const HexMesh& mesh,
                                                       const CompressedRows<CellId>& cells,
                                                       const std::vector<char>& wanted,
                                                       const CompressedRows<VertexId>& reads);

}  // namespace hex::improving
