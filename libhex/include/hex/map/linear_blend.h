/// \file linear_blend.h
/// The inside of a face or block by straight lines between opposite sides.
#pragma once

#include <hex/map/transfinite.h>

namespace hex {

/// Sets the inner points of a face: of the two straight lines through (u, v) between opposite sides, each is
/// taken with the weight 1 / (t (1 - t)), t being the parameter along it, so that the line to the nearest
/// side counts most and the sides are met. The weights add up to one: affine maps of space commute with it,
/// bilinear faces are reproduced.
///
/// The published program interpolates x along u, y along v and z along w instead, which depends on how the
/// part lies in space.
void blend_linearly(FaceGrid& face);

/// The same for a block with three lines between its opposite faces.
void blend_linearly(BlockGrid& block);

}  // namespace hex
