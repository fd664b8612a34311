/// \file text_input.h
/// Reading the text formats of splines.
#pragma once

#include <hex/base/error.h>
#include <hex/base/linear_algebra.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace spline::io {

/// The words of a text, with their line for messages: separated by blanks. With `comments` a line that starts
/// with '$' is left out.
class Words {
  public:
    Words(const std::filesystem::path& path, std::string_view text, bool comments)
        : path_(path), text_(text), comments_(comments) {}

    bool at_end();
    /// No further word on this line.
    bool at_end_of_line() { return !skip_within_line() || text_[at_] == '\n'; }

    /// The next word; `wanted` says in messages what should be there. Throws Error{bad_input} with file and
    /// line at the end of the text, or where the word is not a number of the kind.
    std::string_view next(const char* wanted);
    std::int64_t integer(const char* wanted);
    std::size_t count(const char* wanted);  ///< >= 0
    double real(const char* wanted);
    struct WeightedPoint {
        hex::Vec3 point;
        double weight;
    };
    /// Three coordinates and a positive weight.
    WeightedPoint weighted_point();
    /// A 1-based id up to `most`, made 0-based.
    std::uint32_t id(const char* wanted, std::size_t most);
    void keyword(const char* word);

    std::size_t bytes_left() const { return text_.size() - at_; }
    /// A header that lies must not make us ask for more memory than the file could fill.
    std::size_t at_most_left(std::size_t count) const { return std::min(count, bytes_left() / 2 + 1); }

    [[noreturn]] void fail(const std::string& what, hex::ErrorKind kind = hex::ErrorKind::bad_input,
                           const std::string& advice = {}) const;

  private:
    bool skip_within_line();

    const std::filesystem::path& path_;
    std::string_view text_;
    bool comments_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
};

/// The word between apostrophes, for messages.
std::string quoted(std::string_view word);

}  // namespace spline::io
