/// \file parallel.h
/// oneTBB as the stages use it: loops and reductions whose results do not depend on the number of threads.
#pragma once

#include <hex/base/context.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <utility>

namespace hex {

/// Runs `body()` with `context.threads` workers; every parallel loop that it calls uses these. Stages wrap
/// their work in it once. Returns what `body` returns and lets its exceptions through.
template <class Body>
auto with_threads(const Context& context, Body&& body) {
    tbb::task_arena arena(context.threads > 0 ? context.threads : tbb::task_arena::automatic);
    return arena.execute(std::forward<Body>(body));
}

/// `body(i)` for i in [0, count), in parallel, in no particular order. `body` must write only to what i owns.
template <class Body>
void parallel_for(std::size_t count, const Body& body, std::size_t grain = 256) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
    });
}

/// Reduction over i in [0, count) with the same association of operations, and so the same bits, for any
/// number of threads. `accumulate(value, i)` returns the value with i added; `combine(a, b)` joins two
/// partial results.
template <class Value, class Accumulate, class Combine>
Value parallel_reduce(std::size_t count, const Value& identity, const Accumulate& accumulate,
                      const Combine& combine, std::size_t grain = 1024) {
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, count, grain), identity,
        [&](const auto& range, Value value) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
                value = accumulate(std::move(value), i);
            return value;
        },
        combine);
}

}  // namespace hex
