/// \file label_cut.h
/// The labelling of least infidelity plus boundary length, by a graph cut.
#pragma once

#include "segment/label_surface.h"

#include <vector>

namespace hex {

/// Alpha expansion (Boykov, Veksler, Zabih 2001, as CGAL has it) from the axes nearest to the normals, of
/// the sum of the costs plus `compactness` times the sum of the weights of the edges between labels; within
/// a factor of two of the least. Deterministic.
std::vector<int> cut_labels(const LabelSurface& surface, double compactness);

/// The cheapest label of each triangle; the first of the cheapest.
std::vector<int> nearest_labels(const LabelSurface& surface);

}  // namespace hex
