/// \file byte_order.h
/// Numbers in binary files, in either byte order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace hex::io {

/// The number whose bytes start at `bytes`.
template <class Number>
Number load(const char* bytes, std::endian order) {
    std::array<char, sizeof(Number)> copy;
    std::memcpy(copy.data(), bytes, sizeof(Number));
    if (order != std::endian::native) std::reverse(copy.begin(), copy.end());
    return std::bit_cast<Number>(copy);
}

template <class Number>
void append_little_endian(std::string& text, Number value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    text.append(bytes.data(), bytes.size());
}

}  // namespace hex::io
