/// \file mesh_file.h
/// Files that may hold a surface or a hexahedral mesh, and the table of all formats.
#pragma once

#include <hex/io/hex_file.h>
#include <hex/io/surface_file.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace hex::io {

/// A file format: what it is called, and what we read from it and write to it.
struct FormatInfo {
    std::string_view name;  ///< for messages, such as "VTK legacy"
    /// Lower case with the dot; the first is the usual one.
    std::vector<std::string_view> extensions;
    /// read_surface takes files of this format; those of CAD only in a build with Open CASCADE.
    bool reads_surfaces = false;
    bool writes_surfaces = false;   ///< write_surface makes such files
    bool reads_hexahedra = false;   ///< read_hex_mesh takes such files
    bool writes_hexahedra = false;  ///< write_hex_mesh makes such files
    /// Part ids survive writing and reading.
    bool part_ids = false;
    /// And so do their names.
    bool part_names = false;
    /// Largest polygon that can be written; 0 = any.
    int most_corners = 0;
    /// Scalar fields can be written with hexahedra.
    bool fields = false;
    /// How numbers are written: "text, exact" or "binary, exact".
    std::string_view written_as;
    /// The names that `parts` (distinct) have in such a file, where some are written as others; a part that
    /// is left out has none there.
    PartNames (*names_written)(std::span<const int> parts, const PartNames& names) = nullptr;
};

/// All formats that are built in, in the order of docs/formats.md.
const std::vector<FormatInfo>& formats();

/// The extension that names a format: in lower case, with its dot; "" without one.
std::string extension_of(const std::filesystem::path& path);

/// The format that the extension of `path` names, or nullptr.
const FormatInfo* find_format(const std::filesystem::path& path);

/// Extensions of the formats for which `flag` is set, separated by blanks, for messages and help:
/// `extensions_of(&FormatInfo::writes_hexahedra)` is ".k .key .vtk .vtu .mesh ...". What is read includes the
/// extensions of added readers (reader.h).
std::string extensions_of(bool FormatInfo::*flag);

/// A surface or a hexahedral mesh.
using MeshFile = std::variant<SurfaceFile, HexFile>;

/// Reads either: a hexahedral mesh when the file holds hexahedra, else a surface. Throws as read_surface and
/// read_hex_mesh do.
MeshFile read_mesh_file(const std::filesystem::path& path);

}  // namespace hex::io
