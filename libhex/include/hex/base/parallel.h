/// \file parallel.h
/// oneTBB as the stages use it: loops and reductions whose results do not depend on the number of threads.
#pragma once

#include <hex/base/context.h>
#include <hex/base/thread_sanitizer.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <utility>
#include <vector>

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
    const auto items = [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
    };
    const detail::ParallelSection section;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), detail::PartOf(section, items));
}

namespace detail {

/// Ends of the parts of [first, last) that halving gives until none is longer than `grain`.
inline void halve(std::size_t first, std::size_t last, std::size_t grain, std::vector<std::size_t>& ends) {
    if (last - first <= grain) {
        ends.push_back(last);
        return;
    }
    const std::size_t middle = first + (last - first) / 2;
    halve(first, middle, grain, ends);
    halve(middle, last, grain, ends);
}

/// What halving took apart, joined pairwise in the same tree; `part` is the next part's value.
template <class Value, class Part, class Combine>
Value join_halves(std::size_t first, std::size_t last, std::size_t grain, Part& part,
                  const Combine& combine) {
    if (last - first <= grain) return std::move((part++)->value);
    const std::size_t middle = first + (last - first) / 2;
    const Value left = join_halves<Value>(first, middle, grain, part, combine);
    const Value right = join_halves<Value>(middle, last, grain, part, combine);
    return combine(left, right);
}

}  // namespace detail

/// Reduction over i in [0, count) with the same association of operations, and so the same bits, for any
/// number of threads. `accumulate(value, i)` returns the value with i added; `combine(a, b)` joins two
/// partial results.
template <class Value, class Accumulate, class Combine>
Value parallel_reduce(std::size_t count, const Value& identity, const Accumulate& accumulate,
                      const Combine& combine, std::size_t grain = 1024) {
    if (count == 0) return identity;
    struct Part {
        Value value;  // of its own: a vector of bool would share bytes between threads
    };
    std::vector<std::size_t> ends;
    detail::halve(0, count, grain, ends);
    std::vector<Part> parts(ends.size(), Part{identity});
    parallel_for(
        parts.size(),
        [&](std::size_t p) {
            Value value = identity;
            for (std::size_t i = p == 0 ? 0 : ends[p - 1]; i < ends[p]; ++i)
                value = accumulate(std::move(value), i);
            parts[p].value = std::move(value);
        },
        1);
    auto part = parts.begin();
    return detail::join_halves<Value>(0, count, grain, part, combine);
}

}  // namespace hex
