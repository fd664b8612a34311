/// \file bodies.h
/// A closed surface cut into the bodies that it bounds: an outer shell each, with the voids right inside it.
#pragma once

#include <hex/surface/mesh_types.h>

#include <vector>

namespace hex {

struct Body {
    /// Outer shell oriented outwards, voids inwards, however they were.
    TriangleMesh surface;
    std::vector<int> vertices;   ///< of the whole surface, one for each of this one
    std::vector<int> triangles;  ///< of the whole surface, ascending, one for each of this one
    std::vector<bool> turned;    ///< triangles whose orientation is not that in the whole surface
    std::size_t turned_shells = 0;
};

/// The bodies of a closed surface in the order of their first triangles. Shells that meet each other bound
/// different bodies, which may overlap. Nesting is decided by exact predicates.
std::vector<Body> bodies_of(const TriangleMesh& surface);

}  // namespace hex
