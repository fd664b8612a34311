/// \file spline_result.h
/// What every method that gives a spline owes to what uses it.
#pragma once

#include <spline/spline.h>

namespace spline {

/// Throws hex::Error{bad_input} for a spline without elements, lists that do not belong together, indices out
/// of range, and numbers that are not finite or weights that are not positive. Linear in what it holds.
void require_spline(const SplineResult& result);

}  // namespace spline
