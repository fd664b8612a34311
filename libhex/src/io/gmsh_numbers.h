/// \file gmsh_numbers.h
/// The numbers of a Gmsh file, in text or binary.
#pragma once

#include "io/byte_order.h"
#include "io/text_scanner.h"

#include <hex/base/error.h>

#include <cmath>
#include <cstdint>

namespace hex::io {

/// One number after the other. Binary files have 32-bit integers and, in version 4.1, 64-bit sizes; their
/// sections start and end with lines of text all the same.
class GmshNumbers {
  public:
    explicit GmshNumbers(const InputFile& file) : text_(file) {}

    TextScanner& text() { return text_; }
    bool binary() const { return binary_; }
    std::size_t position() const { return text_.position(); }

    /// From the next line on numbers are binary. The first of them is a one, which tells the byte order.
    void start_binary(bool wide_sizes) {
        binary_ = true;
        wide_sizes_ = wide_sizes;
        next_line();
        if (take<std::int32_t>("the mark of the byte order") == 1) return;
        text_.seek(text_.position() - sizeof(std::int32_t));
        order_ = std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
        if (take<std::int32_t>("the mark of the byte order") != 1)
            fail("the mark of the byte order is not 1");
    }
    /// Binary numbers start behind the end of the line.
    void next_line() {
        if (binary_) text_.rest_of_line();
    }

    long long integer(const char* what) { return binary_ ? take<std::int32_t>(what) : text_.integer(what); }
    int small_integer(const char* what) {
        return binary_ ? take<std::int32_t>(what) : text_.small_integer(what);
    }
    /// A tag or a count of version 4.1; any integer of version 2.2.
    long long size(const char* what) {
        if (binary_ && wide_sizes_) return take<std::int64_t>(what);
        return integer(what);
    }
    long long positive(const char* what) {
        const long long value = size(what);
        if (value < 1) fail(std::string(what) + " should be positive, not " + std::to_string(value));
        return value;
    }
    /// How many things follow, each at least `bytes_each` bytes of text or one binary integer.
    std::size_t count(const char* what, std::size_t bytes_each) {
        if (!binary_) return text_.count(what, bytes_each);
        const long long value = size(what);
        const std::size_t left = text_.text().size() - position();
        if (value < 0 || static_cast<unsigned long long>(value) > left / sizeof(std::int32_t))
            fail(std::string(what) + " is " + std::to_string(value) +
                 ", which the rest of the file cannot hold");
        return static_cast<std::size_t>(value);
    }
    double real(const char* what) {
        if (!binary_) return text_.real(what);
        const auto value = take<double>(what);
        if (!std::isfinite(value)) fail(std::string(what) + " is not finite");
        return value;
    }
    Vec3 point() {
        const double x = real("a coordinate");
        const double y = real("a coordinate");
        return {x, y, real("a coordinate")};
    }

    [[noreturn]] void fail(const std::string& what) const { fail_at(position(), what); }
    [[noreturn]] void fail_at(std::size_t position, const std::string& what) const {
        throw Error(ErrorKind::bad_input, what, place(position));
    }
    [[noreturn]] void unsupported(const std::string& what, const std::string& advice) const {
        throw Error(ErrorKind::unsupported, what, place(position()), advice);
    }

  private:
    std::string place(std::size_t position) const {
        if (binary_) return text_.file().byte_place(position);
        // The line of the number before.
        return text_.file().line_place(position == 0 ? 0 : position - 1);
    }
    template <class Number>
    Number take(const char* what) {
        if (text_.text().size() - position() < sizeof(Number))
            fail(std::string("the file ends where ") + what + " should be");
        const auto value = load<Number>(text_.text().data() + position(), order_);
        text_.seek(position() + sizeof(Number));
        return value;
    }

    TextScanner text_;
    bool binary_ = false;
    bool wide_sizes_ = false;
    std::endian order_ = std::endian::native;
};

}  // namespace hex::io
