#include <hex/base/error.h>
#include <hex/base/isolated.h>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>

#ifdef HEXSPLINE_COVERAGE
extern "C" void __gcov_dump();
#endif

namespace hex {
namespace {

using Clock = std::chrono::steady_clock;

/// Comes after what the body returned, so that a child that ended before is told from one that returned
/// nothing.
constexpr char end_mark = '.';

bool write_all(int to, const std::string& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = write(to, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

/// Milliseconds until `end`, as poll() wants them.
int time_left(Clock::time_point end) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    return static_cast<int>(std::max<long long>(0, left));
}

/// Appends what comes until the other end is closed; false when that takes more than `seconds` (0: any time).
bool read_all(int from, unsigned seconds, std::string& bytes) {
    const Clock::time_point end = Clock::now() + std::chrono::seconds(seconds);
    std::array<char, 65536> buffer;
    for (;;) {
        pollfd waiting{from, POLLIN, 0};
        const int ready = poll(&waiting, 1, seconds == 0 ? -1 : time_left(end));
        if (ready < 0 && errno == EINTR) continue;
        if (ready == 0) return false;
        const ssize_t count = read(from, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return true;
        bytes.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

/// An exception that leaves `body` must not run on in the copy of the caller: it ends the child.
[[noreturn]] void run_child(int to, const std::function<std::string()>& body,
                            const IsolatedLimits& limits) noexcept {
    // Nobody waits for the answer of a child without a parent.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // What the caller does at its end (removing its unfinished files, say) is not for its copy to do.
    std::set_terminate(std::abort);
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM})
        signal(number, SIG_DFL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    if (limits.processor_seconds > 0) {
        const rlimit time{limits.processor_seconds, limits.processor_seconds};
        setrlimit(RLIMIT_CPU, &time);
    }
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    const bool written = write_all(to, body() + end_mark);
#ifdef HEXSPLINE_COVERAGE
    __gcov_dump();  // which _exit() does not
#endif
    _exit(written ? 0 : 1);
}

std::string why_it_ended(int status) {
    if (WIFSIGNALED(status)) return std::string("it was ended by a signal: ") + strsignal(WTERMSIG(status));
    return "it ended the process, with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

IsolatedResult run_isolated(const std::function<std::string()>& body, const IsolatedLimits& limits) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(ErrorKind::output, "no pipe can be made");
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        run_child(ends[1], body, limits);
    }
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        throw Error(ErrorKind::output, "no process can be started");
    }
    IsolatedResult result;
    const bool in_time = read_all(ends[0], limits.seconds, result.bytes);
    close(ends[0]);
    if (!in_time) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!in_time) {
        result.failure = "it took more than " + std::to_string(limits.seconds) + " seconds";
    } else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !result.bytes.ends_with(end_mark)) {
        result.failure = why_it_ended(status);
    } else {
        result.bytes.pop_back();
    }
    return result;
}

}  // namespace hex
