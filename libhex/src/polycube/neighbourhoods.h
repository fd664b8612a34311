/// \file neighbourhoods.h
/// Neighbourhoods of patches that no polycube surface has.
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/surface/patch_layout.h>

namespace hex {

/// Findings of severity error, entity "patch", vertex ids in the message:
/// - `opposite-labels-adjacent`: patches that face opposite ways share an edge. Only asked when the part ids
///   are labels: all in 1..6, and every patch faces the way of its label;
/// - `patches-share-all-corners`: two four-sided patches have the same four corners, so a block face could
///   not tell which of them it belongs to;
/// - `edge-not-unique`: two different chains join the same two corners, so a block edge could not tell which
///   of them it follows.
Diagnostics diagnose_neighbourhoods(const TriangleMesh& mesh, const PatchLayout& layout);

}  // namespace hex
