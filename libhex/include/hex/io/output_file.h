/// \file output_file.h
/// A file that appears complete or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hex::io {

/// Writes beside the target and renames on `commit`. Destroyed without a commit, it leaves nothing behind and
/// an old file of that name as it was. A target that exists and is no regular file (/dev/null, a pipe) is
/// written directly, and so is what /dev/stdout, /dev/stderr and /dev/fd/N stand for. Every failure throws
/// Error{output} with the path.
class OutputFile {
  public:
    /// Makes the file beside the target at once, so that a place that cannot be written is known before the
    /// work. Where `path` is a symbolic link, the target is the file that it points to.
    explicit OutputFile(std::filesystem::path path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Buffered; cheap to call often.
    void write(std::string_view bytes);
    /// A buffer to append to with append_number; call `flush_if_large` now and then.
    std::string& buffer() { return buffer_; }
    /// Writes the buffer out and empties it once it holds more than 1 MiB.
    void flush_if_large() {
        if (buffer_.size() > large) flush();
    }
    /// Flushes, syncs the data to the disk and gives the file its name.
    void commit();

  private:
    static constexpr std::size_t large = std::size_t{1} << 20;
    void flush();
    void write_out(std::string_view bytes);
    void remove_temporary();
    [[noreturn]] void fail(const std::string& what, int error_number);

    std::filesystem::path path_;
    std::filesystem::path temporary_;
    std::string buffer_;
    int descriptor_ = -1;
    std::size_t unsynced_ = 0;  ///< bytes written since the disk was last told to begin
};

/// For a program that ends at once: removes what unfinished OutputFiles have written, and lets no other
/// appear from now on; `commit` and the destructor do not return any more. Thread-safe.
void abandon_output_files() noexcept;

/// The whole text as a file, all or nothing.
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace hex::io
