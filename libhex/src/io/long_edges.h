/// \file long_edges.h
/// Cuts the long edges of a triangle soup.
#pragma once

#include <hex/surface/polygon_soup.h>

#include <array>
#include <cstdint>
#include <vector>

namespace hex::io {

/// Halves all edges longer than `longest`, again and again until there are none. New points lie on the edges,
/// so the surface stays as it is; triangles keep their part, and `marked` edges stay marked in pieces.
/// `longest` > 0; throws Error{unsupported} for what becomes too many triangles.
void cut_long_edges(PolygonSoup& triangles, std::vector<std::array<std::uint32_t, 2>>& marked,
                    double longest);

}  // namespace hex::io
