/// \file plane_placement.h
/// Real coordinates for the planes of a block complex, near those of the surface.
#pragma once

#include "polycube/block_complex.h"

#include <hex/base/linear_algebra.h>

#include <vector>

namespace hex {

/// A place for each block vertex in a polycube with real coordinates. Vertices in one plane of the complex
/// (connected by block edges across an axis) share the coordinate along this axis; along every block edge it
/// grows by at least a tenth of `unit`. Under these conditions the sum of the squares of
///  - what each side's length differs from that of its chain, and
///  - a tenth of what each chart's plane differs from `level`, its mean coordinate in space,
/// is made small by cyclic minimisation, starting from the integer coordinates.
std::vector<Vec3> place_planes(const ChartGraph& graph, const BlockComplex& complex,
                               const std::vector<double>& level, double unit);

}  // namespace hex
