/// \file console.h
/// The terminal: messages and a live progress bar on stderr, Ctrl-C, the number of threads.
#pragma once

#include <hex/base/context.h>

#include <memory>
#include <string>

namespace cli {

struct ConsoleOptions {
    std::string command;  ///< put in front of every message
    bool verbose = false;
    bool quiet = false;
    std::string level;  ///< trace, debug, info, warn, error; overrides verbose and quiet when not empty
    int threads = 0;    ///< 0 = all cores
};

/// Turns Ctrl-C into a request to stop, shown by Context::stop. Who does not follow it in time, or gets a
/// second one, is ended, without unfinished files. Call once, before any thread is started. \param name put
/// in front of the message
void watch_interrupts(const std::string& name);
/// Whether nobody has told of the interruption yet; true for the first who asks, who then tells.
bool may_tell_of_interruption();
/// From now on one Ctrl-C is a request to finish, which may take a while.
void take_time_after_interrupt();

class Console {
  public:
    /// Throws hex::Error{usage} for an unknown level.
    explicit Console(const ConsoleOptions& options);
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    const hex::Context& context() const;
    void log(hex::LogLevel level, std::string_view message) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace cli
