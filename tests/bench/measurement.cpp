#include "measurement.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace bench {
namespace {

/// What the child sends through the pipe.
struct Message {
    Work work;
    char problem[256] = {};
};

Message run_and_catch(const std::function<Work()>& body) {
    Message message;
    try {
        message.work = body();
    } catch (const std::exception& error) {
        std::strncpy(message.problem, error.what(), sizeof message.problem - 1);
    }
    return message;
}

}  // namespace

Measurement measure(const std::function<Work()>& body) {
    std::fflush(nullptr);
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot start a process");
    if (child == 0) {
        close(ends[0]);
        const Message message = run_and_catch(body);
        const bool sent = write(ends[1], &message, sizeof message) == sizeof message;
        _exit(sent ? 0 : 1);
    }
    close(ends[1]);
    Message message;
    const bool received = read(ends[0], &message, sizeof message) == sizeof message;
    close(ends[0]);
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    Measurement result{message.work, static_cast<double>(usage.ru_maxrss) / 1024.0, message.problem};
    if (!received) result.problem = "the process ended with status " + std::to_string(status);
    return result;
}

double seconds_of(const std::function<void()>& body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace bench
