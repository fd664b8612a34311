// What ThreadSanitizer is told of oneTBB must not hide the races of loop bodies. Only its own build can show
// this.
#include <hex/base/parallel.h>
#include <hex/base/parallel_ordered.h>

#include <gtest/gtest.h>

#ifdef HEXSPLINE_THREAD_SANITIZER

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

namespace hex {
namespace {

/// Holds a thread until another one has come as well, without giving the two an order.
class Meeting {
  public:
    void wait_for_the_other() {
        come_.fetch_add(1, std::memory_order_relaxed);
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (come_.load(std::memory_order_relaxed) < 2 && std::chrono::steady_clock::now() < end)
            std::this_thread::yield();
    }

  private:
    std::atomic<int> come_{0};
};

Context two_threads() {
    Context context;
    context.threads = 2;
    return context;
}

/// Two items of a loop add to the same number.
void race_in_a_loop() {
    Meeting meeting;
    int sum = 0;
    with_threads(two_threads(), [&] {
        parallel_for(
            2,
            [&](std::size_t) {
                meeting.wait_for_the_other();
                ++sum;
            },
            1);
    });
    std::exit(sum > 2);
}

/// Two things that are made at the same time add to the same number.
void race_in_making() {
    Meeting meeting;
    int sum = 0;
    with_threads(two_threads(), [&] {
        std::vector<int> slots(2);
        parallel_ordered(
            2, slots,
            [&](std::size_t, int&) {
                meeting.wait_for_the_other();
                ++sum;
            },
            [](std::size_t, int&) {});
    });
    std::exit(sum > 2);
}

class ThreadSanitizerDeathTest : public ::testing::Test {
  protected:
    // The child begins anew: a process that has threads already must not be forked and used.
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }

    static constexpr int exit_code_of_a_report = 66;
};

TEST_F(ThreadSanitizerDeathTest, FindsItemsOfALoopThatTouchTheSameThing) {
    EXPECT_EXIT(race_in_a_loop(), ::testing::ExitedWithCode(exit_code_of_a_report), "data race");
}

TEST_F(ThreadSanitizerDeathTest, FindsThingsThatTouchTheSameThingWhenMade) {
    EXPECT_EXIT(race_in_making(), ::testing::ExitedWithCode(exit_code_of_a_report), "data race");
}

}  // namespace
}  // namespace hex

#endif
