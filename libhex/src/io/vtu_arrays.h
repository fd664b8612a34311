/// \file vtu_arrays.h
/// The numbers of a VTK XML file in all their encodings: text, raw bytes, base64, compressed by zlib or not.
#pragma once

#include "io/input_file.h"

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hex::io {

/// Number types of VTK XML.
enum class VtuType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// What the root element says about all arrays of a file.
struct VtuEncoding {
    std::endian order = std::endian::little;
    bool wide_headers = false;  ///< 64-bit block headers
    bool compressed = false;    ///< zlib
};

/// Bytes that are there as they are, or as base64 text.
class VtuBytes {
  public:
    /// Errors are placed at `place`.
    VtuBytes(std::string_view text, bool base64, std::string place)
        : text_(text), base64_(base64), place_(std::move(place)) {}
    /// The next `count` bytes; throws Error{bad_input} when they are not there.
    std::string take(std::uint64_t count);
    [[noreturn]] void fail(const std::string& what) const;

  private:
    void decode_group();

    std::string_view text_;
    bool base64_;
    std::string place_;
    std::size_t position_ = 0;
    std::string pending_;
};

/// The payload of an array whose header is next in `bytes`: exactly `expected` bytes.
std::string take_payload(VtuBytes& bytes, const VtuEncoding& encoding, std::uint64_t expected);

std::size_t size_of(VtuType type);

/// `payload` as numbers of one type, converted to `Number` (double or std::int64_t).
template <class Number>
std::vector<Number> to_numbers(const std::string& payload, VtuType type, std::endian order);

}  // namespace hex::io
