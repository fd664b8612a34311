/// \file verdict_metrics.h
/// The metrics of one hexahedron; hex/quality/hex_metrics.h says what they are.
#pragma once

#include "quality/vector.h"

#include <array>

namespace hex::quality {

using Point = Vector<double>;
using Corners = std::array<Point, 8>;

/// Verdict's numbers for "nothing" and "no value".
inline constexpr double verdict_min = 1e-30;
inline constexpr double verdict_max = 1e30;

double max_aspect_frobenius(const Corners& p);
double diagonal(const Corners& p);
double dimension(const Corners& p);
double distortion(const Corners& p);
double edge_ratio(const Corners& p);
double jacobian(const Corners& p);
double max_edge_ratio(const Corners& p);
double med_aspect_frobenius(const Corners& p);
double oddy(const Corners& p);
double relative_size_squared(const Corners& p, double average_volume);
double shape(const Corners& p);
double shear(const Corners& p);
double skew(const Corners& p);
double stretch(const Corners& p);
double taper(const Corners& p);
double volume(const Corners& p);
double nodal_jacobian_ratio(const Corners& p);

double equiangle_skew(const Corners& p);
double aspect_ratio(const Corners& p);
double min_angle(const Corners& p);
double max_angle(const Corners& p);
double warpage(const Corners& p);

}  // namespace hex::quality
