/// \file mesh_result.h
/// What every method that gives a hexahedral mesh owes to the next stage.
#pragma once

#include <hex/volume/hex_mesh.h>

namespace hex {

/// Throws Error{bad_input} for a mesh without hexahedra and for a vertex that is not finite; the rest is
/// sound in any HexMesh, however it was made.
void require_mesh(const HexMesh& mesh);

/// Throws Error{bad_input} unless every vertex is used by a cell and every part is one of 1..`parts`.
void require_compact(const HexMesh& mesh, std::size_t parts);

}  // namespace hex
