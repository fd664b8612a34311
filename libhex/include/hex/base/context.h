/// \file context.h
/// What a caller can give to any stage besides its input: threads, progress, cancel, log.
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace hex {

enum class LogLevel { trace, debug, info, warn, error };

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

    void progress(std::string_view step, double share) const {
        if (on_progress) on_progress(step, share);
    }
    void log(LogLevel level, std::string_view message) const {
        if (on_log) on_log(level, message);
    }
    /// Throws Error{cancelled} when a stop was asked for.
    void check_cancelled() const;
};

}  // namespace hex
