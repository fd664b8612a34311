#include "io/vtu_arrays.h"

#include "io/byte_order.h"

#include <hex/base/error.h>

#include <zlib.h>

#include <array>

namespace hex::io {
namespace {

int base64_value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::uint64_t take_header(VtuBytes& bytes, const VtuEncoding& encoding) {
    return encoding.wide_headers ? load<std::uint64_t>(bytes.take(8).data(), encoding.order)
                                 : load<std::uint32_t>(bytes.take(4).data(), encoding.order);
}

std::string take_compressed(VtuBytes& bytes, const VtuEncoding& encoding, std::uint64_t expected) {
    const std::uint64_t blocks = take_header(bytes, encoding);
    if (blocks == 0 && expected == 0) return {};
    const std::uint64_t block_size = take_header(bytes, encoding);
    const std::uint64_t last_size = take_header(bytes, encoding);
    if (blocks == 0 || block_size == 0 || (blocks - 1) > expected / block_size)
        bytes.fail("the header of a compressed array does not fit its size");
    std::vector<std::uint64_t> sizes;
    for (std::uint64_t b = 0; b < blocks; ++b) sizes.push_back(take_header(bytes, encoding));
    std::string result;
    for (std::uint64_t b = 0; b < blocks; ++b) {
        const std::string packed = bytes.take(sizes[b]);
        const std::uint64_t size = b + 1 == blocks && last_size != 0 ? last_size : block_size;
        // zlib never shrinks data by more than 1032 to 1: a larger claim is wrong, and not worth the memory.
        if (size > expected - result.size() || size / 1100 > packed.size() + 16)
            bytes.fail("the header of a compressed array does not fit its size");
        const std::size_t start = result.size();
        result.resize(start + size);
        uLongf unpacked = size;
        const int status = ::uncompress(reinterpret_cast<Bytef*>(result.data() + start), &unpacked,
                                        reinterpret_cast<const Bytef*>(packed.data()), packed.size());
        if (status != Z_OK || unpacked != size) bytes.fail("a compressed array cannot be unpacked");
    }
    if (result.size() != expected) bytes.fail("a compressed array is shorter than it should be");
    return result;
}

template <class Stored, class Number>
std::vector<Number> convert(const std::string& payload, std::endian order) {
    std::vector<Number> numbers(payload.size() / sizeof(Stored));
    for (std::size_t i = 0; i < numbers.size(); ++i)
        numbers[i] = static_cast<Number>(load<Stored>(payload.data() + i * sizeof(Stored), order));
    return numbers;
}

}  // namespace

void VtuBytes::fail(const std::string& what) const {
    throw Error(ErrorKind::bad_input, what, place_);
}

void VtuBytes::decode_group() {
    std::array<int, 4> values{};
    int digits = 0, padding = 0;
    while (digits + padding < 4) {
        if (position_ == text_.size()) fail("the data of an array is cut off");
        const char c = text_[position_++];
        if (is_blank(c)) continue;
        if (c == '=' && digits >= 2) {
            ++padding;
            continue;
        }
        const int value = base64_value(c);
        if (value < 0 || padding > 0) fail("an array holds characters that are not base64");
        values[static_cast<std::size_t>(digits++)] = value;
    }
    const int bits = values[0] << 18 | values[1] << 12 | values[2] << 6 | values[3];
    for (int i = 0; i < digits - 1; ++i) pending_ += static_cast<char>(bits >> (16 - 8 * i) & 255);
}

std::string VtuBytes::take(std::uint64_t count) {
    const std::uint64_t left = text_.size() - position_;
    if (count > pending_.size() + left) fail("the data of an array is cut off");
    if (!base64_) {
        std::string result(text_.substr(position_, count));
        position_ += count;
        return result;
    }
    pending_.reserve(count + 3);
    while (pending_.size() < count) decode_group();
    std::string rest = pending_.substr(count);
    pending_.resize(count);
    std::swap(rest, pending_);
    return rest;
}

std::string take_payload(VtuBytes& bytes, const VtuEncoding& encoding, std::uint64_t expected) {
    if (encoding.compressed) return take_compressed(bytes, encoding, expected);
    const std::uint64_t size = take_header(bytes, encoding);
    if (size != expected)
        bytes.fail("an array has " + std::to_string(size) + " bytes instead of " + std::to_string(expected));
    return bytes.take(size);
}

std::size_t size_of(VtuType type) {
    static constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

template <class Number>
std::vector<Number> to_numbers(const std::string& payload, VtuType type, std::endian order) {
    switch (type) {
        case VtuType::int8:
            return convert<std::int8_t, Number>(payload, order);
        case VtuType::uint8:
            return convert<std::uint8_t, Number>(payload, order);
        case VtuType::int16:
            return convert<std::int16_t, Number>(payload, order);
        case VtuType::uint16:
            return convert<std::uint16_t, Number>(payload, order);
        case VtuType::int32:
            return convert<std::int32_t, Number>(payload, order);
        case VtuType::uint32:
            return convert<std::uint32_t, Number>(payload, order);
        case VtuType::int64:
            return convert<std::int64_t, Number>(payload, order);
        case VtuType::uint64:
            return convert<std::uint64_t, Number>(payload, order);
        case VtuType::float32:
            return convert<float, Number>(payload, order);
        case VtuType::float64:
            break;
    }
    return convert<double, Number>(payload, order);
}

template std::vector<double> to_numbers(const std::string&, VtuType, std::endian);
template std::vector<std::int64_t> to_numbers(const std::string&, VtuType, std::endian);

}  // namespace hex::io
