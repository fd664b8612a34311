/// \file guide_options.h
/// What the options of `improve` say about the surface to stay on and its sharp curves.
#pragma once

#include "improve/surface_curves.h"

#include <hex/improve/improve.h>

namespace hex::improving {

/// The surface that the options ask for, with the edges that count as sharp. Throws Error{bad_input} when
/// listed vertices do not exist.
GuideSurface make_guide_surface(const HexMesh& mesh, const BoundaryQuads& boundary,
                                const ImproveOptions& options);

/// Which sharp edges of it are curves.
CurveOptions curve_options(const ImproveOptions& options);

}  // namespace hex::improving
