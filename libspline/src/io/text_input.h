/// \file text_input.h
/// Reading the text formats of splines.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace spline::io {

/// All bytes of a file; throws Error{bad_input}.
std::string read_whole(const std::filesystem::path& path);

/// The word between apostrophes, for messages.
std::string quoted(std::string_view word);

}  // namespace spline::io
