/// \file console.h
/// The terminal: messages and a live progress bar on stderr, Ctrl-C, the number of threads.
#pragma once

#include <hex/base/context.h>

#include <exception>
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

/// Turns Ctrl-C into a request to stop, shown by Context::stop. Who does not follow it in half a second, or
/// gets a second one, is ended, without unfinished files. A pipe that nobody reads and a file that gets too
/// large become errors of writing. Call once, before any thread is started; throws std::system_error when
/// there is no memory for a thread. \param name put in front of the message
void watch_interrupts(const std::string& name);
/// Whether Ctrl-C was pressed.
bool interrupted();
/// Whether nobody has told of the interruption yet; true for the first who asks, who then tells.
bool may_tell_of_interruption();
/// The result is there and is being written: from now on only a second Ctrl-C ends the program before it is.
void take_time_after_interrupt();

/// What is thrown where nobody can catch it (in a thread of a library, say) ends the program like any error:
/// one line, an exit code, no unfinished files.
void end_well_whatever_is_thrown();
/// For what hex::is_out_of_memory_or_threads() says.
inline constexpr const char* out_of_memory_or_threads =
    "out of memory, or of threads that may be started; raise the limit (ulimit -v, ulimit -u)";

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
