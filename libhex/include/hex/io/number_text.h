/// \file number_text.h
/// Numbers to text and back, independent of the locale. Every text format of ours goes through here.
#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace hex::io {

/// Appends the shortest decimal form that reads back to the same double. Never writes "-0".
inline void append_number(std::string& text, double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value == 0.0 ? 0.0 : value).ptr;
    text.append(buffer, end);
}

/// Appends all digits of an integer, with a '-' before a negative one.
template <std::integral Integer>
void append_number(std::string& text, Integer value) {
    char buffer[24];
    text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

/// The whole of `text` (a leading '+' is allowed, no blanks) as a number; none when it is not one, does not
/// fit, or is not finite. Numbers too small for a double become 0.
std::optional<double> parse_double(std::string_view text);
/// The same for decimal integers: "1.0" and "1e3" are none.
std::optional<long long> parse_integer(std::string_view text);

}  // namespace hex::io
