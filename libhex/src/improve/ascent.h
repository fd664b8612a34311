/// \file ascent.h
/// Moves one vertex so that the worst cell around it gets better.
#pragma once

#include "improve/sweep.h"

namespace hex::improving {

/// Line search from the vertex along the directions in which the bad cells of its star improve together. The
/// first step is `step` times the mean length of its edges; it is halved until it improves, and doubled as
/// long as that improves more. Moves only for a strictly better star (fewer inverted cells, then a larger
/// minimum), and along the boundary where the vertex is on it. Returns whether it moved.
bool raise_star_minimum(Sweeper& sweeper, VertexId v, double step, Workspace& workspace);

}  // namespace hex::improving
