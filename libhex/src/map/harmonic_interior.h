/// \file harmonic_interior.h
/// Inner nodes of a subdivided block structure by a discrete Laplace equation.
#pragma once

#include <hex/base/context.h>
#include <hex/map/block_numbering.h>

#include <vector>

namespace hex {

struct HarmonicReport {
    int iterations = 0;               ///< of conjugate gradients
    std::size_t held_back_nodes = 0;  ///< nodes held back because an element got worse
};

/// Moves every node that is not on the boundary, those on inner block vertices, edges and faces too, to the
/// weighted mean of its neighbours in the grid. `positions` is the start, with the boundary in place.
///
/// The weights are those of the Laplace operator by finite volumes where each block is a box with the mean
/// lengths of its edges: blocks cut into uneven pieces do not pull their neighbours. The system is symmetric
/// positive definite.
///
/// A harmonic map onto a domain that is not convex may fold. Where an element has a scaled Jacobian below 0.3
/// and was better at the start, its nodes and those around move a part of the way only, or not at all: no
/// element gets worse than min(0.3, its start).
HarmonicReport relax_harmonically(const HexMesh& blocks, const EdgeTable& edges,
                                  const BlockNumbering& numbering, const std::vector<double>& edge_lengths,
                                  const std::vector<HexCell>& cells, std::vector<Vec3>& positions,
                                  const Context& context);

}  // namespace hex
