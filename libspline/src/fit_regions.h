/// \file fit_regions.h
/// Refinement where the spline is farthest from the part.
#pragma once

#include <spline/spline.h>

namespace spline {

/// Turns the regions worst_fit of the options into lists of elements, level by level: each level is judged on
/// the spline that the coarser ones give. Throws Error{usage} without `fit_errors`.
void list_fit_regions(const SplineBuilder& builder, const hex::HexMesh& mesh, SplineOptions& options,
                      const hex::Context& context);

}  // namespace spline
