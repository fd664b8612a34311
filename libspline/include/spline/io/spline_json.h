/// \file spline_json.h
/// A spline as JSON, for scripts.
#pragma once

#include <spline/bezier.h>

#include <filesystem>

namespace spline::io {

/// Writes an object with `control_points` ([x, y, z, weight] each), `bezier_points` (for each the ids of its
/// control points and their coefficients), `elements` (64 Bezier points each, u fastest), `level` and `cell`
/// of the elements, and `boundary_patch` (six a element, -1 inside) where known. All ids are 0-based; numbers
/// read back to the same double. Streaming. Throws Error{output}.
void write_spline_json(const std::filesystem::path& path, const BezierSpline& spline);

}  // namespace spline::io
