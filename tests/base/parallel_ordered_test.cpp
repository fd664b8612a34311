#include <hex/base/parallel.h>
#include <hex/base/parallel_ordered.h>

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

namespace hex::test {
namespace {

TEST(ParallelOrdered, TakesInOrderWhatWasMadeInParallel) {
    for (const int threads : {1, 2, 4}) {
        for (const std::size_t held : {1U, 3U, 8U}) {
            Context context;
            context.threads = threads;
            std::vector<std::size_t> taken;
            std::vector<std::vector<std::size_t>> slots(held);
            with_threads(context, [&] {
                parallel_ordered(
                    1000, slots, [](std::size_t i, std::vector<std::size_t>& slot) { slot.assign(i % 7, i); },
                    [&](std::size_t i, const std::vector<std::size_t>& slot) {
                        EXPECT_EQ(slot, std::vector<std::size_t>(i % 7, i)) << "nobody else used the slot";
                        taken.push_back(i);
                    });
            });
            std::vector<std::size_t> all(1000);
            std::iota(all.begin(), all.end(), std::size_t{0});
            EXPECT_EQ(taken, all);
        }
    }
}

TEST(ParallelOrdered, NothingToDoAndExceptions) {
    std::vector<int> slots(4);
    const auto nothing = [](std::size_t, int&) {};
    parallel_ordered(0, slots, nothing, [](std::size_t, int&) { FAIL() << "nothing was made"; });
    const auto fails = [](std::size_t i, int&) {
        if (i == 50) throw std::runtime_error("full");
    };
    EXPECT_THROW(parallel_ordered(100, slots, fails, nothing), std::runtime_error);
    EXPECT_THROW(parallel_ordered(100, slots, nothing, fails), std::runtime_error);
}

}  // namespace
}  // namespace hex::test
