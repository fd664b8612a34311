/// \file inputs.h
/// Input files as the stages want them, with errors and warnings that name the file.
#pragma once

#include "hexspline/command.h"

#include <hex/io/surface_file.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <filesystem>

namespace cli {

/// A closed triangle surface; polygons are triangulated. What the reader and the surface's inspection noticed
/// is logged. Throws hex::Error{bad_input} with the file's name.
hex::TriangleMesh load_triangles(const CommandLine& line, const std::filesystem::path& path);

/// The same of a file that is already read from `path`.
hex::TriangleMesh triangles_of(const CommandLine& line, const hex::io::SurfaceFile& file,
                               const std::filesystem::path& path);

/// A hexahedral mesh or block structure.
hex::HexMesh load_hexahedra(const CommandLine& line, const std::filesystem::path& path);

}  // namespace cli
