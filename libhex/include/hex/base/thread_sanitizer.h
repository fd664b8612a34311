/// \file thread_sanitizer.h
/// The order that oneTBB keeps between its tasks, told to ThreadSanitizer. Distributions build libtbb without
/// it, so it would see no order between what comes before a loop, the loop's items and what comes after, and
/// report every one of them. Told only this much it still finds two items of one loop that touch the same
/// thing. In all other builds these do nothing.
#pragma once

#if defined(__SANITIZE_THREAD__)
#define HEXSPLINE_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define HEXSPLINE_THREAD_SANITIZER 1
#endif
#endif

#include <utility>

#ifdef HEXSPLINE_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
/// A function whose own reads and writes ThreadSanitizer does not see; those of what it calls it sees.
#define HEXSPLINE_UNSEEN_BY_THREAD_SANITIZER __attribute__((no_sanitize("thread")))
#else
#define HEXSPLINE_UNSEEN_BY_THREAD_SANITIZER
#endif

namespace hex::detail {

/// A point that threads hand work over at, known by its address. What a thread did before `leave` comes
/// before what a thread does after a later `take` of the same point.
class HandOver {
  public:
    /// Hands over what this thread has done so far.
    void leave() const noexcept {
#ifdef HEXSPLINE_THREAD_SANITIZER
        __tsan_release(const_cast<char*>(&place_));
#endif
    }
    /// Takes what was handed over here so far.
    void take() const noexcept {
#ifdef HEXSPLINE_THREAD_SANITIZER
        __tsan_acquire(const_cast<char*>(&place_));
#endif
    }

#ifdef HEXSPLINE_THREAD_SANITIZER
  private:
    char place_ = 0;
#endif
};

/// While it lives, what its thread does comes after everything left at `from`, and before what is taken at
/// `to`.
class HandedOver {
  public:
    /// Takes what was left at `from`; `to` must outlive this.
    HandedOver(const HandOver& from, const HandOver& to) noexcept : to_(to) { from.take(); }
    ~HandedOver() { to_.leave(); }
    HandedOver(const HandedOver&) = delete;
    HandedOver& operator=(const HandedOver&) = delete;

  private:
    const HandOver& to_;
};

/// A parallel section of the thread that makes it: parts begin after its start and end before it does. What
/// the parts read is made before it.
class ParallelSection {
  public:
    ParallelSection() noexcept { start_.leave(); }
    ~ParallelSection() { end_.take(); }
    ParallelSection(const ParallelSection&) = delete;
    ParallelSection& operator=(const ParallelSection&) = delete;

    /// What another thread does for this section while the result lives.
    [[nodiscard]] HandedOver part() const noexcept { return HandedOver(start_, end_); }

  private:
    HandOver start_, end_;
};

/// `work` as a part of `section`, for oneTBB to carry in its tasks; both must outlive the loop. oneTBB copies
/// it from task to task while the section runs, so its start does not tell of these copies: the two addresses
/// in them are read unseen, and the work is done after the section's start and before its end.
template <class Work>
class PartOf {
  public:
    /// Keeps the addresses of both.
    PartOf(const ParallelSection& section, const Work& work) noexcept : section_(&section), work_(&work) {}

    /// What `work` returns for these.
    template <class... Arguments>
    HEXSPLINE_UNSEEN_BY_THREAD_SANITIZER decltype(auto) operator()(Arguments&&... arguments) const {
        return run(*section_, *work_, std::forward<Arguments>(arguments)...);
    }

  private:
    template <class... Arguments>
    static decltype(auto) run(const ParallelSection& section, const Work& work, Arguments&&... arguments) {
        const auto part = section.part();
        return work(std::forward<Arguments>(arguments)...);
    }

    const ParallelSection* section_;
    const Work* work_;
};

}  // namespace hex::detail
