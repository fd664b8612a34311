/// \file added_reader.h
/// Files of formats that a plug-in reads.
#pragma once

#include <hex/io/mesh_data.h>

#include <filesystem>
#include <string>

namespace hex::io {

/// Somebody added a reader for the extension of `path`.
bool has_added_reader(const std::filesystem::path& path);

/// Reads with it. Throws what it throws, and Error{bad_input} when it returns a mesh that is none.
MeshData read_with_added_reader(const std::filesystem::path& path);

/// Extensions of all added readers, each with a blank in front.
std::string added_extensions();

}  // namespace hex::io
