/// \file text_scanner.h
/// Words and numbers of a text file, one after the other; every failure names file and line.
#pragma once

#include "io/input_file.h"

#include <hex/base/linear_algebra.h>
#include <hex/io/number_text.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace hex::io {

/// Walks over blank-separated words. `comment` starts a comment that goes to the end of its line.
class TextScanner {
  public:
    explicit TextScanner(const InputFile& file, char comment = '\0')
        : file_(file),
          text_(file.bytes()),
          position_(file.text_start()),
          word_start_(position_),
          comment_(comment) {}
    /// Over a text that is a part of the file or was made from it; all errors are placed at `place`.
    TextScanner(const InputFile& file, std::string_view text, std::string place)
        : file_(file), text_(text), position_(0), word_start_(0), comment_('\0'), place_(std::move(place)) {}

    /// True when only blanks and comments are left.
    bool at_end() {
        skip_blanks();
        return position_ == text_.size();
    }

    /// The next word; throws when there is none, saying that `what` was expected.
    std::string_view word(const char* what) {
        skip_blanks();
        word_start_ = position_;
        while (position_ < text_.size() && !is_blank(text_[position_])) {
            if (comment_ != '\0' && text_[position_] == comment_) break;
            ++position_;
        }
        if (word_start_ == position_) fail(std::string("the file ends where ") + what + " should be");
        return text_.substr(word_start_, position_ - word_start_);
    }
    /// The line of the next word, from 1.
    std::int64_t line() {
        skip_blanks();
        const std::string_view before = text_.substr(0, position_);
        return 1 + std::count(before.begin(), before.end(), '\n');
    }
    /// The next word without taking it or the blanks before it; empty at the end.
    std::string_view peek() {
        const std::size_t start = position_;
        const std::string_view result = at_end() ? std::string_view() : word("a word");
        position_ = start;
        return result;
    }

    double real(const char* what) {
        const auto text = word(what);
        const auto value = parse_double(text);
        if (!value) fail(std::string(what) + " should be a finite number, not " + in_quotes(text));
        return *value;
    }
    Vec3 point() {
        const double x = real("a coordinate");
        const double y = real("a coordinate");
        return {x, y, real("a coordinate")};
    }
    long long integer(const char* what) {
        const auto text = word(what);
        const auto value = parse_integer(text);
        if (!value) fail(std::string(what) + " should be an integer, not " + in_quotes(text));
        return *value;
    }
    /// An integer in the range of int.
    int small_integer(const char* what) {
        const long long value = integer(what);
        if (value < INT32_MIN || value > INT32_MAX)
            fail(std::string(what) + " " + std::to_string(value) + " is out of range");
        return static_cast<int>(value);
    }
    /// The number of things that follow, each at least `bytes_each` bytes long: no more than fit in the rest
    /// of the file.
    std::size_t count(const char* what, std::size_t bytes_each) {
        const long long value = integer(what);
        check_count(value, what, bytes_each);
        return static_cast<std::size_t>(value);
    }
    void check_count(long long value, const char* what, std::size_t bytes_each) const {
        if (value < 0) fail(std::string(what) + " is negative: " + std::to_string(value));
        // The last number of a file need not have a blank behind it.
        if (static_cast<unsigned long long>(value) > (text_.size() - position_ + 1) / bytes_each)
            fail(std::string(what) + " is " + std::to_string(value) +
                 ", more than the rest of the file can hold");
    }
    /// The index of one of `count` points, counted from `base` in the file.
    std::uint32_t point_index(std::size_t count, long long base) {
        const long long value = integer("a point index");
        if (value < base || value - base >= static_cast<long long>(count))
            fail("point index " + std::to_string(value) + " is not in " + std::to_string(base) + ".." +
                 std::to_string(static_cast<long long>(count) - 1 + base));
        return static_cast<std::uint32_t>(value - base);
    }

    /// The rest of this line, without its end; the next word is then the first of the next line.
    std::string_view rest_of_line() {
        const std::size_t start = position_;
        const std::size_t end = std::min(text_.find('\n', start), text_.size());
        position_ = std::min(end + 1, text_.size());
        return trimmed(text_.substr(start, end - start));
    }

    std::size_t position() const { return position_; }
    void seek(std::size_t position) { position_ = position; }
    std::string_view text() const { return text_; }
    const InputFile& file() const { return file_; }

    /// File and line of the last word. Linear in the position: for messages.
    std::string place() const { return place_.empty() ? file_.line_place(word_start_) : place_; }
    /// Throws Error{bad_input} at the line of the last word.
    [[noreturn]] void fail(const std::string& what, const std::string& advice = {}) const {
        throw Error(ErrorKind::bad_input, what, place(), advice);
    }
    [[noreturn]] void unsupported(const std::string& what, const std::string& advice = {}) const {
        throw Error(ErrorKind::unsupported, what, place(), advice);
    }

  private:
    void skip_blanks() {
        while (position_ < text_.size()) {
            if (is_blank(text_[position_])) {
                ++position_;
            } else if (comment_ != '\0' && text_[position_] == comment_) {
                rest_of_line();
            } else {
                return;
            }
        }
    }

    const InputFile& file_;
    std::string_view text_;
    std::size_t position_;
    std::size_t word_start_;
    char comment_;
    std::string place_;
};

}  // namespace hex::io
