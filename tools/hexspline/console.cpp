#include "hexspline/console.h"

#include <hex/base/error.h>
#include <hex/base/method_call.h>
#include <hex/io/output_file.h>

#include <pthread.h>
#include <signal.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <string_view>
#include <thread>

namespace cli {
namespace {

std::stop_source& interrupt() {
    static std::stop_source source;
    return source;
}

std::atomic<bool>& finishing_takes_time() {
    static std::atomic<bool> flag = false;
    return flag;
}

spdlog::level::level_enum spdlog_level(hex::LogLevel level) {
    switch (level) {
        case hex::LogLevel::trace:
            return spdlog::level::trace;
        case hex::LogLevel::debug:
            return spdlog::level::debug;
        case hex::LogLevel::info:
            return spdlog::level::info;
        case hex::LogLevel::warn:
            return spdlog::level::warn;
        case hex::LogLevel::error:
            return spdlog::level::err;
    }
    return spdlog::level::info;
}

spdlog::level::level_enum threshold(const ConsoleOptions& options) {
    if (options.level.empty()) {
        if (options.quiet) return spdlog::level::err;
        return options.verbose ? spdlog::level::info : spdlog::level::warn;
    }
    for (const auto& [name, level] :
         {std::pair("trace", spdlog::level::trace), std::pair("debug", spdlog::level::debug),
          std::pair("info", spdlog::level::info), std::pair("warn", spdlog::level::warn),
          std::pair("error", spdlog::level::err)}) {
        if (options.level == name) return level;
    }
    throw hex::Error(hex::ErrorKind::usage, "unknown log level '" + options.level + "'", {},
                     "use trace, debug, info, warn or error");
}

/// One line on a terminal, redrawn at most ten times a second.
class ProgressBar {
  public:
    explicit ProgressBar(std::string command) : command_(std::move(command)) {}
    void show(std::string_view step, double share) {
        const auto now = std::chrono::steady_clock::now();
        if (shown_ && now - last_ < std::chrono::milliseconds(100)) return;
        last_ = now;
        shown_ = true;
        constexpr int width = 30;
        const int filled = static_cast<int>(share * width);
        std::string bar(width, ' ');
        for (int i = 0; i < filled && i < width; ++i) bar[static_cast<std::size_t>(i)] = '#';
        std::fprintf(stderr, "\r\033[K%s: %.*s [%s] %3d%%", command_.c_str(), static_cast<int>(step.size()),
                     step.data(), bar.c_str(), static_cast<int>(100 * share));
        std::fflush(stderr);
    }
    void clear() {
        if (shown_) std::fputs("\r\033[K", stderr);
        shown_ = false;
    }

  private:
    std::string command_;
    std::chrono::steady_clock::time_point last_;
    bool shown_ = false;
};

}  // namespace

bool may_tell_of_interruption() {
    static std::atomic<bool> told = false;
    return !told.exchange(true);
}

void take_time_after_interrupt() {
    finishing_takes_time() = true;
}

bool interrupted() {
    // One that nobody has taken yet counts, too.
    sigset_t waiting;
    sigemptyset(&waiting);
    sigpending(&waiting);
    return interrupt().stop_requested() || sigismember(&waiting, SIGINT) == 1 ||
           sigismember(&waiting, SIGTERM) == 1;
}

void end_well_whatever_is_thrown() {
    std::set_terminate([] {
        hex::io::abandon_output_files();
        const char* what = "an exception of unknown kind";
        hex::ErrorKind kind = hex::ErrorKind::no_result;
        try {
            if (std::current_exception()) throw;
        } catch (const std::exception& problem) {
            if (hex::is_out_of_memory_or_threads(problem)) kind = hex::ErrorKind::output;
            if (*problem.what() != '\0') what = problem.what();
        } catch (...) {
            // said above
        }
        if (kind == hex::ErrorKind::output)
            std::fprintf(stderr, "hexspline: error: %s\n", out_of_memory_or_threads);
        else
            std::fprintf(stderr, "hexspline: error: internal error: %s\n", what);
        _exit(hex::exit_code(kind));
    });
}

void watch_interrupts(const std::string& name) {
    signal(SIGPIPE, SIG_IGN);
    // Files that get too large are an error of writing, as on a full disk.
    signal(SIGXFSZ, SIG_IGN);
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    // All threads inherit the mask; this one alone takes the signals, in ordinary code instead of a signal
    // handler.
    std::thread([signals, name] {
        int number = 0;
        sigwait(&signals, &number);
        interrupt().request_stop();
        // Not every library looks whether it should stop.
        const timespec patience{0, 500'000'000};
        const bool again = sigtimedwait(&signals, nullptr, &patience) > 0;
        if (!again && finishing_takes_time()) sigwait(&signals, &number);
        hex::io::abandon_output_files();
        if (may_tell_of_interruption())
            std::fprintf(stderr, "hexspline%s%s: error: interrupted\n", name.empty() ? "" : " ",
                         name.c_str());
        _exit(hex::exit_code(hex::ErrorKind::cancelled));
    }).detach();
}

struct Console::State {
    std::shared_ptr<spdlog::logger> logger;
    std::optional<ProgressBar> progress;
    std::optional<tbb::global_control> thread_limit;
    hex::Context context;
};

Console::Console(const ConsoleOptions& options) : state_(std::make_unique<State>()) {
    const auto level = threshold(options);
    state_->logger =
        std::make_shared<spdlog::logger>(options.command, std::make_shared<spdlog::sinks::stderr_sink_mt>());
    state_->logger->set_pattern("hexspline %n: %l: %v");
    state_->logger->set_level(level);
    if (options.threads > 0)
        state_->thread_limit.emplace(tbb::global_control::max_allowed_parallelism,
                                     static_cast<std::size_t>(options.threads));

    hex::Context& context = state_->context;
    context.threads = options.threads;
    context.stop = interrupt().get_token();
    context.on_log = [this](hex::LogLevel l, std::string_view message) { log(l, message); };
    if (isatty(STDERR_FILENO) && !options.quiet) {
        state_->progress.emplace(options.command);
        context.on_progress = [this](std::string_view step, double share) {
            state_->progress->show(step, share);
        };
    }
}

Console::~Console() {
    if (state_->progress) state_->progress->clear();
}

const hex::Context& Console::context() const {
    return state_->context;
}

void Console::log(hex::LogLevel level, std::string_view message) const {
    if (state_->progress) state_->progress->clear();
    state_->logger->log(spdlog_level(level), "{}", message);
}

}  // namespace cli
