/// \file number_array.h
/// Long runs of numbers in a text, read in parallel.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace hex::io {

/// Reads `numbers.size()` blank-separated numbers from `text`, starting at `position`. Returns the position
/// behind the last one, or none when there is something else among them, one does not fit or is not finite,
/// or the text ends: which, and where, a scanner has to find out. The same numbers as parse_double and
/// parse_integer give, for any number of threads.
std::optional<std::size_t> parse_numbers(std::string_view text, std::size_t position,
                                         std::span<double> numbers);
std::optional<std::size_t> parse_numbers(std::string_view text, std::size_t position,
                                         std::span<std::uint32_t> numbers);

}  // namespace hex::io
