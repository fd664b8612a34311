/// \file hex_file.h
/// Hexahedral meshes and block structures from and to files, by extension (docs/formats.md has the table).
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/io/part_names.h>
#include <hex/volume/hex_mesh.h>

#include <filesystem>
#include <string>
#include <vector>

namespace hex::io {

/// A hexahedral mesh as read, with what the reader noticed.
struct HexFile {
    /// Numbered in the order of the file unless docs/formats.md says otherwise; points that no cell uses are
    /// kept.
    HexMesh mesh;
    PartNames part_names;     ///< of the part ids of `mesh`, where the format has names
    Diagnostics diagnostics;  ///< each message begins with the file's name, and its line where there is one
};

/// A named scalar a cell or a vertex, written to formats that can carry it (.vtk, .vtu); write_hex_mesh
/// throws Error{unsupported} for the others.
struct ScalarField {
    std::string name;            ///< of the data array in the file
    std::vector<double> values;  ///< one a cell, or one a vertex, in the order of the mesh
};
/// What is written with a hexahedral mesh besides its points, cells and part ids.
struct Fields {
    /// One value a cell each; write_hex_mesh throws Error{usage} for another number of values.
    std::vector<ScalarField> cell;
    /// One value a vertex each; Error{usage} likewise.
    std::vector<ScalarField> vertex;
    /// Of part ids; used by formats that have them (.k, .inp, .msh, .msh2), passed over by the others.
    PartNames part_names = {};
};

/// Reads .k .key .vtk .vtu .mesh .mfem .inp .msh .msh2 .ovm (any case). A file of shells or triangles gives
/// Error{bad_input} that says so. Throws Error{bad_input} with `file:line` (or byte offset),
/// Error{unsupported} for an unknown extension.
HexFile read_hex_mesh(const std::filesystem::path& path);

/// Writes the format of the extension; throws Error{unsupported} or Error{output}. Part ids are kept where
/// the format can.
void write_hex_mesh(const std::filesystem::path& path, const HexMesh& mesh, const Fields& fields = {});

}  // namespace hex::io
