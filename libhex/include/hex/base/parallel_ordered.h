/// \file parallel_ordered.h
/// Making things in parallel and taking them one after the other, as a writer of a long file does.
#pragma once

#include <tbb/parallel_pipeline.h>

#include <cstddef>
#include <vector>

namespace hex {

/// `make(i, slot)` for i in [0, count), in parallel, and `take(i, slot)` with what was made, one at a time
/// and in order, while later ones are being made. At most `slots.size()` (>= 1) things are held at a time; a
/// slot is used again and comes as it was left. The order of takes does not depend on the number of threads.
template <class Slot, class Make, class Take>
void parallel_ordered(std::size_t count, std::vector<Slot>& slots, const Make& make, const Take& take) {
    std::size_t next = 0;
    const auto number = [&](tbb::flow_control& control) -> std::size_t {
        if (next == count) {
            control.stop();
            return 0;
        }
        return next++;
    };
    // Things are taken in order, so what is held is a run of at most slots.size() numbers: no two share one.
    const auto slot_of = [&](std::size_t i) -> Slot& { return slots[i % slots.size()]; };
    tbb::parallel_pipeline(
        slots.size(), tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, number) &
                          tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel,
                                                                     [&](std::size_t i) {
                                                                         make(i, slot_of(i));
                                                                         return i;
                                                                     }) &
                          tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order,
                                                              [&](std::size_t i) { take(i, slot_of(i)); }));
}

}  // namespace hex
