/// \file shrink_set.h
/// The cells that a layer is put around, and their faces.
#pragma once

#include <hex/volume/topology.h>

#include <vector>

namespace hex::improving {

/// Cells with two boundary faces on one smooth part of the boundary: the normals of the faces have a cosine
/// of at least `cosine` at the edge between them. One flag a cell.
std::vector<char> cells_with_flat_edges(const HexMesh& mesh, double cosine);

/// Adds neighbours until the cells flagged, around each of their vertices, are one piece with one rim: then
/// their faces are a surface without pinches, around which a layer fits. Linear in the cells added.
void grow_to_manifold(const HexMesh& mesh, std::vector<char>& flagged);

/// The faces between flagged cells and the others or the outside, like the boundary of a mesh of the flagged
/// cells alone: half-faces, quads, vertices and quads around vertices of all that meets at least one flagged
/// cell.
BoundaryQuads faces_around(const HexMesh& mesh, const std::vector<char>& flagged);

}  // namespace hex::improving
