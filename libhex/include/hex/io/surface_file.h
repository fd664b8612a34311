/// \file surface_file.h
/// Surfaces from and to files, by extension (docs/formats.md has the table).
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/io/part_names.h>
#include <hex/surface/polygon_soup.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace hex::io {

/// A surface as read, with what the reader noticed (unknown keywords, skipped elements, ...).
struct SurfaceFile {
    /// Numbered in the order of the file unless docs/formats.md says otherwise.
    PolygonSoup soup;
    PartNames part_names;     ///< of the part ids of `soup`, where the format has names
    Diagnostics diagnostics;  ///< each message begins with the file's name, and its line where there is one
    /// Sharp edges that the file itself knows of, as pairs of points: those of CAD models (cad_file.h).
    std::vector<std::array<std::uint32_t, 2>> sharp_edges = {};
};

/// Reads .k .key .vtk .vtu .mesh .mfem .inp .msh .msh2 .ovm .stl .obj .off .ply, .step .stp .iges .igs .brep
/// by read_cad with its default options (any case). A file of hexahedra gives Error{bad_input} that says so.
/// Points that no polygon uses are kept; whether the polygons make a surface is not asked here
/// (make_poly_mesh does). Throws Error{bad_input} with `file:line` (or byte offset for binary formats),
/// Error{unsupported} for an unknown extension.
SurfaceFile read_surface(const std::filesystem::path& path);

/// Writes the format of the extension; throws Error{unsupported} for one that cannot carry a surface,
/// Error{output} when the file cannot be written. Doubles round-trip exactly in every text format.
/// `part_names` are used by formats that have them (.k, .key, .inp, .msh, .msh2).
void write_surface(const std::filesystem::path& path, const PolygonSoup& soup,
                   const PartNames& part_names = {});

}  // namespace hex::io
