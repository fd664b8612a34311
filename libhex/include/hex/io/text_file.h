/// \file text_file.h
/// A text file as one string, for formats that are read elsewhere.
#pragma once

#include <filesystem>
#include <string>

namespace hex::io {

/// The text of a file, without a byte order mark; line ends as they are. Throws Error{bad_input} for a file
/// that is missing, unreadable, empty or no regular file: a pipe or a device could keep us waiting, or never
/// end.
std::string read_text_file(const std::filesystem::path& path);

}  // namespace hex::io
