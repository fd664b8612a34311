/// \file straight_cut.h
/// Cuts a flattened region of triangles along a straight line.
#pragma once

#include "polycube/cut_mesh.h"

#include <optional>
#include <vector>

namespace hex {

/// Cuts the region at work along the segment between the places of the two ends of the line; the region has
/// been flattened. Edges ahead are split; vertices nearly met are moved onto the line, in the plane only.
/// Returns the vertices along it, or nothing when the walk gets stuck. The caller finishes the line.
std::optional<std::vector<CutMesh::Vertex>> cut_straight(CutMesh& cut_mesh, const CutLine& line);

}  // namespace hex
