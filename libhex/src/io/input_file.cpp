#include "io/input_file.h"

#include <hex/base/parallel.h>
#include <hex/io/text_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

namespace hex::io {
namespace {

struct Descriptor {
    int number;
    explicit Descriptor(int n) : number(n) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
};

constexpr std::size_t piece_bytes = std::size_t{4} << 20;

struct Piece {
    std::size_t size = 0;
    int problem = 0;  ///< errno
};

/// As many of `wanted` bytes as there are from `start` on.
Piece read_piece(int file, char* to, std::size_t start, std::size_t wanted) {
    Piece piece;
    while (piece.size < wanted) {
        const ssize_t got =
            ::pread(file, to + piece.size, wanted - piece.size, static_cast<off_t>(start + piece.size));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) piece.problem = errno;
        if (got <= 0) break;
        piece.size += static_cast<std::size_t>(got);
    }
    return piece;
}

[[noreturn]] void fail(const std::string& name, const std::string& what, int error_number = 0) {
    const std::string reason = error_number == 0 ? "" : std::string(" (") + std::strerror(error_number) + ")";
    throw Error(ErrorKind::bad_input, what + reason, name);
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& path) : name_(path.string()) {
    // Not blocking: opening a pipe nobody writes to must fail, not wait.
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number < 0)
        fail(name_, errno == ENOENT ? "no such file" : "cannot be opened", errno == ENOENT ? 0 : errno);
    struct stat status {};
    if (::fstat(file.number, &status) != 0) fail(name_, "cannot be read", errno);
    if (S_ISDIR(status.st_mode)) fail(name_, "is a directory, not a file");
    if (!S_ISREG(status.st_mode)) fail(name_, "is not a regular file");
    if (status.st_size == 0) fail(name_, "the file is empty");
    const auto expected = static_cast<std::size_t>(status.st_size);
    bytes_ = std::make_unique_for_overwrite<char[]>(expected);
    // Pieces of a large file side by side: most of the time goes into giving memory to the process. A file
    // that is cut short meanwhile ends where the first piece does that is not full.
    const std::size_t pieces = (expected + piece_bytes - 1) / piece_bytes;
    std::vector<Piece> read(pieces);
    parallel_for(
        pieces,
        [&](std::size_t i) {
            const std::size_t start = i * piece_bytes;
            read[i] =
                read_piece(file.number, bytes_.get() + start, start, std::min(piece_bytes, expected - start));
        },
        1);
    for (std::size_t i = 0; i < pieces; ++i) {
        if (read[i].problem != 0) fail(name_, "cannot be read", read[i].problem);
        size_ += read[i].size;
        if (read[i].size < std::min(piece_bytes, expected - i * piece_bytes)) break;
    }
    if (size_ == 0) fail(name_, "the file is empty");
}

InputFile::InputFile(std::string name, std::string_view bytes)
    : name_(std::move(name)),
      bytes_(std::make_unique_for_overwrite<char[]>(bytes.size())),
      size_(bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), bytes_.get());
}

std::string InputFile::line_place(std::size_t position) const {
    const auto before = bytes().substr(0, std::min(position, size_));
    return name_ + ":" + std::to_string(1 + std::count(before.begin(), before.end(), '\n'));
}

std::string InputFile::byte_place(std::size_t position) const {
    return name_ + ":byte " + std::to_string(position);
}

std::string read_text_file(const std::filesystem::path& path) {
    const InputFile file(path);
    return std::string(file.bytes().substr(file.text_start()));
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 40;
    std::string result = "'";
    for (const char c : text.substr(0, most)) {
        const auto byte = static_cast<unsigned char>(c);
        result += byte < 32 || byte >= 127 ? '?' : c;
    }
    if (text.size() > most) result += "...";
    return result + "'";
}

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return result;
}

std::string upper_case(std::string_view text) {
    std::string result(text);
    for (char& c : result) {
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    }
    return result;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

}  // namespace hex::io
