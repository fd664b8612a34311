#include <hex/base/error.h>
#include <hex/io/number_text.h>
#include <hex/io/output_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <set>

namespace hex::io {
namespace {

/// Names of all files that are being written, for `abandon_output_files`.
struct Unfinished {
    std::mutex mutex;
    std::set<std::string> names;
};

/// Never destroyed: files may be closed by what outlives other static objects.
Unfinished& unfinished() {
    static auto* const list = new Unfinished;
    return *list;
}

}  // namespace

void abandon_output_files() noexcept {
    // Not unlocked: whoever comes later waits for the end.
    unfinished().mutex.lock();
    for (const std::string& name : unfinished().names) ::unlink(name.c_str());
}

namespace {

/// 1 of "/dev/stdout", "/dev/fd/1" and "/proc/self/fd/1"; -1 of other names. Behind these there may be a file
/// that somebody else writes to, which is to be gone on with and not replaced.
int open_descriptor(const std::filesystem::path& path) {
    const std::string name = path.lexically_normal().string();
    if (name == "/dev/stdout") return STDOUT_FILENO;
    if (name == "/dev/stderr") return STDERR_FILENO;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!name.starts_with(folder)) continue;
        const auto number = parse_integer(std::string_view(name).substr(folder.size()));
        if (number && *number >= 0 && *number <= INT_MAX) return static_cast<int>(*number);
    }
    return -1;
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code problem, ignored;
    if (const int open = open_descriptor(path_); open >= 0) {
        if (open == STDOUT_FILENO) std::fflush(stdout);
        descriptor_ = ::fcntl(open, F_DUPFD_CLOEXEC, 0);
        if (descriptor_ < 0) fail("cannot be opened for writing", errno);
        return;
    }
    const auto status = std::filesystem::status(path_, problem);
    if (problem == std::errc::too_many_symbolic_link_levels) fail("cannot be written", problem.value());
    if (std::filesystem::is_directory(status)) fail("is a directory, not a file to write", 0);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor_ < 0) fail("cannot be opened for writing", errno);
        return;
    }
    if (std::filesystem::exists(status) && ::access(path_.c_str(), W_OK) != 0)
        fail("cannot be overwritten", errno);
    // Through a symbolic link the file it points to is made or replaced, not the link.
    while (std::filesystem::is_symlink(std::filesystem::symlink_status(path_, ignored)))
        path_ = path_.parent_path() / std::filesystem::read_symlink(path_);
    // A name may have 255 bytes; of a long one only the start goes into the name beside it.
    const std::string stem = path_.filename().string().substr(0, 200);
    std::string name = (path_.parent_path() / (stem + ".part-XXXXXX")).string();
    {
        const std::lock_guard lock(unfinished().mutex);
        descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
        if (descriptor_ >= 0) unfinished().names.insert(name);
    }
    if (descriptor_ < 0) fail("cannot be created", errno);
    temporary_ = name;
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(descriptor_, 0666 & ~mask);
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    remove_temporary();
}

void OutputFile::remove_temporary() {
    if (temporary_.empty()) return;
    const std::lock_guard lock(unfinished().mutex);
    ::unlink(temporary_.c_str());
    unfinished().names.erase(temporary_.string());
    temporary_.clear();
}

void OutputFile::write(std::string_view bytes) {
    if (bytes.size() < large / 4) {
        buffer_.append(bytes);
        flush_if_large();
        return;
    }
    flush();
    write_out(bytes);
}

void OutputFile::flush() {
    write_out(buffer_);
    buffer_.clear();
}

void OutputFile::write_out(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0) {
            if (errno == EINTR) continue;
            fail("cannot be written", errno);
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
        unsynced_ += static_cast<std::size_t>(written);
    }
#ifdef SYNC_FILE_RANGE_WRITE
    // The disk gets its work early, so that `commit` has less to wait for. No harm where that is not
    // possible.
    if (unsynced_ > 8 * large && !temporary_.empty()) {
        ::sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE);
        unsynced_ = 0;
    }
#endif
}

void OutputFile::commit() {
    flush();
    if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail("cannot be written", errno);
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail("cannot be written", errno);
    if (temporary_.empty()) return;
    int problem = 0;
    {
        const std::lock_guard lock(unfinished().mutex);
        if (::rename(temporary_.c_str(), path_.c_str()) != 0)
            problem = errno;
        else
            unfinished().names.erase(temporary_.string());
    }
    if (problem != 0) fail("cannot be replaced", problem);
    temporary_.clear();
}

void OutputFile::fail(const std::string& what, int error_number) {
    const std::string reason = error_number == 0 ? "" : std::string(" (") + std::strerror(error_number) + ")";
    // A throwing constructor runs no destructor.
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
    remove_temporary();
    throw Error(ErrorKind::output, what + reason, path_.string());
}

void write_file(const std::filesystem::path& path, std::string_view text) {
    OutputFile file(path);
    file.write(text);
    file.commit();
}

}  // namespace hex::io
