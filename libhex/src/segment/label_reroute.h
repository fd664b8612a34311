/// \file label_reroute.h
/// New courses for the boundary between two charts, its ends kept.
#pragma once

#include "segment/repair_operators.h"

#include <vector>

namespace hex {

/// The axis along which a boundary between these two labels runs in a polycube; -1 between opposite ones.
int boundary_axis(int label, int other);

/// How often the boundary turns back along its axis.
int count_turns(const LabelSurface& surface, const LabelCharts& charts, const LabelBoundary& boundary);

/// straighten-boundary: cheap paths of edges from end to end through the two charts, that never turn back
/// along the axis of the boundary, or, where there is none, rarely do; each with the labels that it asks
/// for. Prefers creases and edges on which the normals are undecided. Nothing for closed boundaries.
void straighten_boundary(const LabelSurface& surface, const std::vector<int>& labels,
                         const LabelCharts& charts, int boundary, std::vector<LabelChange>& out);

}  // namespace hex
