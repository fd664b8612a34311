/// \file context.h
/// What a caller can give to any stage besides its input: threads, progress, cancel, log.
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace hex {

/// How urgent a message is, ascending. Ours are debug, info and warn; who receives them chooses.
enum class LogLevel {
    trace,  ///< finer than debug
    debug,  ///< for developers of a method
    info,   ///< what was done and found
    warn,   ///< the result may not be what was wanted
    error,  ///< something failed (the libraries throw hex::Error instead)
};

/// Passed by const reference to every stage. A default-constructed one means: all cores, no progress, no
/// cancel, silent. Results never depend on it. The callbacks may be called from the calling thread only.
struct Context {
    /// Worker threads; 0 = all cores.
    int threads = 0;
    /// Called with the name of the running step and the share done in [0, 1].
    std::function<void(std::string_view step, double share)> on_progress;
    /// Called with messages of the libraries.
    std::function<void(LogLevel, std::string_view message)> on_log;
    /// Ask the stage to stop; it then throws Error{cancelled} at the next safe point.
    std::stop_token stop;

    /// Calls `on_progress`, if there is one; `share` of the step is done, in [0, 1].
    void progress(std::string_view step, double share) const {
        if (on_progress) on_progress(step, share);
    }
    /// Calls `on_log`, if there is one.
    void log(LogLevel level, std::string_view message) const {
        if (on_log) on_log(level, message);
    }
    /// Throws Error{cancelled} when a stop was asked for.
    void check_cancelled() const;
};

}  // namespace hex
