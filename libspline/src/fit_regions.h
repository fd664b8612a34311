/// \file fit_regions.h
/// Refinement where the spline is farthest from the part.
#pragma once

#include <spline/spline.h>

#include <functional>

namespace spline {

/// Turns the regions worst_fit of the options into lists of elements, level by level: each level is judged on
/// the spline that the coarser ones give, made by `build`. Throws Error{usage} without `fit_errors`.
void list_fit_regions(const std::function<SplineResult(const SplineOptions&)>& build, SplineOptions& options);

}  // namespace spline
