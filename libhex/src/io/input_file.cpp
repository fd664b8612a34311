#include "io/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

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
    while (size_ < expected) {
        const ssize_t got = ::read(file.number, bytes_.get() + size_, expected - size_);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(name_, "cannot be read", errno);
        if (got == 0) break;
        size_ += static_cast<std::size_t>(got);
    }
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
