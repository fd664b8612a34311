/// \file measurement.h
/// Time and peak memory of a piece of work, each in a process of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace bench {

/// What a piece of work says of itself: what it went through, and how long the part that counts took.
struct Work {
    std::size_t elements = 0;
    double seconds = 0.0;
};

/// One row of the table.
struct Measurement {
    Work work;
    double peak_megabytes = 0.0;  ///< of the whole process, its input included
    std::string problem;          ///< empty when all went well
};

/// Runs `body` in a forked child and waits for it, so that the peak is its own. The caller must not have
/// started threads.
Measurement measure(const std::function<Work()>& body);

/// Seconds that `body` takes.
double seconds_of(const std::function<void()>& body);

}  // namespace bench
