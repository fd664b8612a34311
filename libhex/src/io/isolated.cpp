#include "io/isolated.h"

#include <hex/base/error.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#ifdef HEXSPLINE_COVERAGE
extern "C" void __gcov_dump();
#endif

namespace hex::io {
namespace {

bool write_all(int to, const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = write(to, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

std::string read_all(int from) {
    std::string bytes;
    std::array<char, 65536> buffer;
    for (;;) {
        const ssize_t count = read(from, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return bytes;
        bytes.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

/// An exception that leaves `body` must not run on in the copy of the caller: it ends the child.
[[noreturn]] void run_child(int to, const std::function<std::string()>& body, unsigned seconds) noexcept {
    // Nobody waits for the answer of a child without a parent.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM})
        signal(number, SIG_DFL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const rlimit time{seconds, seconds};
    setrlimit(RLIMIT_CPU, &time);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    const bool written = write_all(to, body());
#ifdef HEXSPLINE_COVERAGE
    __gcov_dump();  // which _exit() does not
#endif
    _exit(written ? 0 : 1);
}

}  // namespace

std::string run_isolated(const std::function<std::string()>& body, unsigned seconds) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(ErrorKind::output, "no pipe can be made");
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        run_child(ends[1], body, seconds);
    }
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        throw Error(ErrorKind::output, "no process can be started");
    }
    std::string bytes = read_all(ends[0]);
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw Error(ErrorKind::bad_input, "is damaged: reading it fails", {}, "export the model again");
    return bytes;
}

}  // namespace hex::io
