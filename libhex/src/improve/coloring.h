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

}  // namespace hex::improving
