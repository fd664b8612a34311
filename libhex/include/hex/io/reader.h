/// \file reader.h
/// Readers of formats that are not built in: what a plug-in adds (docs/extending.md).
#pragma once

#include <hex/base/registry.h>
#include <hex/io/mesh_data.h>

#include <string>
#include <string_view>

namespace hex::io {

/// Reads one format. Every command that takes a surface or hexahedra then takes files of its extension.
class Reader {
  public:
    virtual ~Reader() = default;

    /// The mesh in `bytes`, a whole file that is not empty; `name` is the file's name, for messages only.
    /// Indices are 0-based, polygons counter-clockwise seen from outside, hexahedra in VTK's order of
    /// corners, and nothing is left out silently: findings go into `diagnostics`, without the file's name.
    ///
    /// Throws Error{bad_input} or Error{unsupported} with the place, `name:LINE`. What it returns is checked
    /// before anybody uses it: indices in range, finite coordinates, one part id an element.
    virtual MeshData read(const std::string& name, std::string_view bytes) const = 0;
};

/// The readers that were added, by extension; their stage is called "read".
const Registry<Reader>& readers();

/// Adds a reader for files with this extension, in lower case with the dot (".bdf"). Throws Error{usage} when
/// it is not of that form, when a format of formats() has it, or when another reader does.
void add_reader(const std::string& extension, const std::string& description,
                Registry<Reader>::Factory factory);

}  // namespace hex::io
