/// \file isolated.h
/// Runs foreign code that may crash on damaged input in a process of its own.
#pragma once

#include <functional>
#include <string>

namespace hex::io {

/// Runs `body` in a forked child, with its standard output and error closed, and returns the bytes it
/// returns. What `body` throws must not leave it. Throws Error{bad_input} when the child dies of a signal or
/// takes more than `seconds` of processor time, and Error{output} when no process can be made.
///
/// Memory is not limited: address sanitizers reserve more than any sensible limit.
std::string run_isolated(const std::function<std::string()>& body, unsigned seconds);

}  // namespace hex::io
