/// \file surface_input.h
/// The surface that a chain starts from: any format, CAD models too, repaired when asked for.
#pragma once

#include "hexspline/command.h"

#include <hex/base/linear_algebra.h>
#include <hex/io/surface_file.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <filesystem>
#include <vector>

namespace cli {

/// --deflection, --longest-edge, --features-out.
void describe_cad_input(CommandLine& line);
/// --repair.
void describe_repair(CommandLine& line);

/// Throws hex::Error{usage} when an option of describe_cad_input is given and `path` is no CAD model.
void require_cad_for_its_options(const CommandLine& line, const std::filesystem::path& path);

/// Reads a surface as the options of describe_cad_input say, and writes --features-out. The findings are in
/// the result, not logged.
hex::io::SurfaceFile read_surface_input(const CommandLine& line, const std::filesystem::path& path);

/// The repair of a soup, told in warnings; what was done as JSON, null without --repair.
Json repair_input(const CommandLine& line, const std::filesystem::path& path, hex::PolygonSoup& soup);

struct SurfaceInput {
    hex::TriangleMesh mesh;
    Json repair;
};

/// load_triangles with all of these options.
SurfaceInput load_surface_input(const CommandLine& line, const std::filesystem::path& path);

}  // namespace cli
