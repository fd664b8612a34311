/// \file parallel_ordered.h
/// Making things in parallel and taking them one after the other, as a writer of a long file does.
#pragma once

#include <hex/base/thread_sanitizer.h>

#include <tbb/parallel_pipeline.h>

#include <cstddef>
#include <vector>

namespace hex {

/// `make(i, slot)` for i in [0, count), in parallel, and `take(i, slot)` with what was made, one at a time
/// and in order, while later ones are being made. At most `slots.size()` (>= 1) things are held at a time; a
/// slot is used again and comes as it was left. The order of takes does not depend on the number of threads.
template <class Slot, class Make, class Take>
void parallel_ordered(std::size_t count, std::vector<Slot>& slots, const Make& make, const Take& take) {
    const detail::HandOver numbers, takes;
    const std::vector<detail::HandOver> slots_over(slots.size());
    std::size_t next = 0;
    const auto number = [&](tbb::flow_control& control) -> std::size_t {
        const detail::HandedOver turn(numbers, numbers);
        if (next == count) {
            control.stop();
            return 0;
        }
        return next++;
    };
    // Things are taken in order, so what is held is a run of at most slots.size() numbers: no two share one.
    const auto made = [&](std::size_t i) {
        const std::size_t slot = i % slots.size();
        const detail::HandedOver held(slots_over[slot], slots_over[slot]);
        make(i, slots[slot]);
        return i;
    };
    const auto taken = [&](std::size_t i) {
        const std::size_t slot = i % slots.size();
        const detail::HandedOver held(slots_over[slot], slots_over[slot]);
        const detail::HandedOver turn(takes, takes);
        take(i, slots[slot]);
    };
    const detail::ParallelSection section;
    using detail::PartOf;
    using tbb::filter_mode;
    tbb::parallel_pipeline(
        slots.size(),
        tbb::make_filter<void, std::size_t>(filter_mode::serial_in_order, PartOf(section, number)) &
            tbb::make_filter<std::size_t, std::size_t>(filter_mode::parallel, PartOf(section, made)) &
            tbb::make_filter<std::size_t, void>(filter_mode::serial_in_order, PartOf(section, taken)));
}

}  // namespace hex
