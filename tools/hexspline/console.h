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

/// Turns Ctrl-C into a request to stop, shown by Context::stop; a second one ends the program at once. Call
/// once, before any thread is started.
void watch_interrupts();

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
