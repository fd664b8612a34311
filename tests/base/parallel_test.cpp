#include <hex/base/error.h>
#include <hex/base/parallel.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace hex {
namespace {

Context with(int threads) {
    Context context;
    context.threads = threads;
    return context;
}

TEST(Parallel, ALoopVisitsEveryIndexOnce) {
    for (const std::size_t count : {0u, 1u, 255u, 256u, 257u, 10000u}) {
        std::vector<int> visits(count, 0);
        with_threads(with(2), [&] { parallel_for(count, [&](std::size_t i) { ++visits[i]; }); });
        EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
}

TEST(Parallel, ASumOfDoublesHasTheSameBitsForAnyNumberOfThreads) {
    // Terms of very different size: another order of additions gives another sum.
    const std::size_t count = 200000;
    const auto term = [](std::size_t i) { return std::sin(double(i)) * std::pow(10.0, double(i % 30) - 15); };
    const auto sum = [&](int threads) {
        return with_threads(with(threads), [&] {
            return parallel_reduce(
                count, 0.0, [&](double value, std::size_t i) { return value + term(i); }, std::plus<>());
        });
    };
    const double one = sum(1);
    for (int repeat = 0; repeat < 10; ++repeat) {
        EXPECT_EQ(sum(2), one);
        EXPECT_EQ(sum(4), one);
    }
    double reverse = 0;
    for (std::size_t i = count; i-- > 0;) reverse += term(i);
    EXPECT_NE(reverse, one) << "the terms do not tell orders apart";
    EXPECT_NEAR(reverse, one, 1e-6 * std::abs(one));
}

TEST(Parallel, AReductionJoinsHalvesInTheirOrder) {
    const auto joined = [](std::size_t count, std::size_t grain) {
        return with_threads(with(2), [&] {
            return parallel_reduce(
                count, std::string(),
                [](std::string text, std::size_t i) { return text.append(std::to_string(i)); },
                [](const std::string& a, const std::string& b) {
                    return std::string("(").append(a).append(" ").append(b).append(")");
                },
                grain);
        });
    };
    EXPECT_EQ(joined(5, 1), "((0 1) (2 (3 4)))");
    EXPECT_EQ(joined(7, 3), "(012 (34 56))");
    EXPECT_EQ(joined(3, 3), "012");
}

TEST(Parallel, AReductionOfNothingIsItsIdentity) {
    EXPECT_EQ(parallel_reduce(
                  0, 42, [](int, std::size_t) { return 0; }, [](int a, int) { return a; }),
              42);
}

TEST(Parallel, ValuesAndExceptionsComeThrough) {
    EXPECT_EQ(with_threads(with(2), [] { return 7; }), 7);
    EXPECT_THROW(with_threads(with(2),
                              [] {
                                  parallel_for(1000, [](std::size_t i) {
                                      if (i == 500) throw Error(ErrorKind::no_result, "found nothing");
                                  });
                              }),
                 Error);
}

TEST(Parallel, NoMoreWorkersRunThanAskedFor) {
    with_threads(with(1), [] { EXPECT_EQ(tbb::this_task_arena::max_concurrency(), 1); });
    with_threads(with(3), [] { EXPECT_EQ(tbb::this_task_arena::max_concurrency(), 3); });
}

}  // namespace
}  // namespace hex
