/// \file control_mesh_file.h
/// Control meshes of the levels, to look at and to pick elements to refine from.
#pragma once

#include <spline/spline.h>

#include <filesystem>
#include <span>
#include <vector>

namespace spline::io {

/// PREFIX_hmesh<level>_CM.vtk.
std::filesystem::path control_mesh_path(const std::filesystem::path& prefix, std::size_t level);

/// Writes `PREFIX_hmesh<l>_CM.vtk` for every level l: vertex scalar `pact` (function active), cell scalars
/// `eact` (element active) and `id` (the number that lev_rfid.txt wants). Returns the paths.
/// Throws Error{output}.
std::vector<std::filesystem::path> write_control_meshes(const std::filesystem::path& prefix,
                                                        std::span<const ControlMesh> levels);

}  // namespace spline::io
