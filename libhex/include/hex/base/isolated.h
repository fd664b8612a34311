/// \file isolated.h
/// Runs foreign code that may crash in a process of its own.
#pragma once

#include <functional>
#include <string>

namespace hex {

/// What became of a child process.
struct IsolatedResult {
    std::string bytes;    ///< what the body returned; not to be used after a failure
    std::string failure;  ///< empty, or why the child ended without returning anything, in words
};

/// When a child process is ended.
struct IsolatedLimits {
    unsigned processor_seconds = 0;  ///< of computing; 0: no limit
    unsigned seconds = 0;            ///< by the clock on the wall; 0: no limit
};

/// Runs `body` in a forked child, with its standard output and error going nowhere, and returns the bytes it
/// returns, or what stopped the child before that: a signal, a call of exit(), a limit. What `body` throws
/// must not leave it. Throws Error{output} when no process can be made.
///
/// Memory is not limited: address sanitizers reserve more than any sensible limit.
IsolatedResult run_isolated(const std::function<std::string()>& body, const IsolatedLimits& limits);

}  // namespace hex
