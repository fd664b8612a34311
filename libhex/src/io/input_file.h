/// \file input_file.h
/// A file to read, whole in memory, and the words for "where" in its errors.
#pragma once

#include <hex/base/error.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace hex::io {

/// The bytes of a file. Reading it in one go (rather than mapping it) keeps the process alive when somebody
/// truncates the file meanwhile.
class InputFile {
  public:
    /// Throws Error{bad_input} for a file that is missing, unreadable, empty or no regular file.
    explicit InputFile(const std::filesystem::path& path);
    /// Bytes from elsewhere under a name for messages.
    InputFile(std::string name, std::string_view bytes);

    const std::string& name() const { return name_; }
    std::string_view bytes() const { return {bytes_.get(), size_}; }
    /// Where the text starts: behind a UTF-8 byte order mark, if there is one.
    std::size_t text_start() const { return bytes().starts_with("\xEF\xBB\xBF") ? 3 : 0; }

    /// "name:12", the line that holds the byte at `position`.
    std::string line_place(std::size_t position) const;
    /// "name:byte 1234".
    std::string byte_place(std::size_t position) const;

  private:
    std::string name_;
    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0;
};

/// A piece of input for an error message: in quotes, on one line, at most 40 characters.
std::string in_quotes(std::string_view text);

/// `text` in lower case (ASCII letters only).
std::string lower_case(std::string_view text);
std::string upper_case(std::string_view text);

/// Blanks as every text format of ours has them, line ends included.
constexpr bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Without blanks at either end.
std::string_view trimmed(std::string_view text);

}  // namespace hex::io
