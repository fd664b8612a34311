#include <hex/base/error.h>
#include <hex/base/integer_program.h>

#include <gtest/gtest.h>

#include <cmath>

using hex::IntegerProgram;
using Outcome = hex::IntegerProgram::Outcome;

TEST(IntegerProgram, NearestInteger) {
    IntegerProgram program;
    const int x = program.add_variable({.lower = 1, .integer = true});
    program.add_distance({{x, 1.0}}, 2.6, 1.0);
    const auto result = program.minimise();
    EXPECT_EQ(result.outcome, Outcome::optimal);
    EXPECT_EQ(result.integer(x), 3);
    EXPECT_NEAR(result.objective, 0.4, 1e-9);
}

// A knapsack whose linear relaxation is fractional, against all its 2^10 subsets.
TEST(IntegerProgram, KnapsackEqualsEnumeration) {
    const std::vector<int> weights = {23, 31, 29, 44, 53, 38, 63, 85, 89, 82};
    const std::vector<int> gains = {92, 57, 49, 68, 60, 43, 67, 84, 87, 72};
    const int capacity = 165;
    IntegerProgram program;
    std::vector<IntegerProgram::Term> row;
    for (std::size_t i = 0; i < weights.size(); ++i)
        row.emplace_back(
            program.add_variable({.lower = 0, .upper = 1, .cost = -double(gains[i]), .integer = true}),
            weights[i]);
    program.add_row(row, -IntegerProgram::infinity, capacity);

    int best = 0;
    for (unsigned subset = 0; subset < (1u << weights.size()); ++subset) {
        int weight = 0, gain = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if ((subset >> i & 1u) == 0) continue;
            weight += weights[i];
            gain += gains[i];
        }
        if (weight <= capacity) best = std::max(best, gain);
    }
    const auto result = program.minimise();
    ASSERT_EQ(result.outcome, Outcome::optimal);
    EXPECT_NEAR(-result.objective, best, 1e-6);
}

TEST(IntegerProgram, EqualitiesHoldAndRepeatedTermsAddUp) {
    IntegerProgram program;
    const int a = program.add_variable({.lower = 1, .upper = 50, .cost = 1, .integer = true});
    const int b = program.add_variable({.lower = 1, .upper = 50, .cost = 1, .integer = true});
    program.add_row({{a, 1.0}, {a, 2.0}, {b, -5.0}}, 1, 1);  // 3 a - 5 b = 1
    const auto result = program.minimise();
    ASSERT_TRUE(result.solved());
    EXPECT_EQ(result.integer(a), 2);
    EXPECT_EQ(result.integer(b), 1);
}

TEST(IntegerProgram, SaysWhenThereIsNoSolution) {
    IntegerProgram cycle;  // a < b < c < a
    const int a = cycle.add_variable({.integer = true});
    const int b = cycle.add_variable({.integer = true});
    const int c = cycle.add_variable({.integer = true});
    for (const auto& [low, high] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        cycle.add_row({{high, 1.0}, {low, -1.0}}, 1, IntegerProgram::infinity);
    EXPECT_EQ(cycle.minimise().outcome, Outcome::infeasible);

    IntegerProgram parity;  // feasible for reals, not for integers: 2 x = 2 y + 1, 0 <= x, y <= 9
    const int x = parity.add_variable({.lower = 0, .upper = 9, .integer = true});
    const int y = parity.add_variable({.lower = 0, .upper = 9, .integer = true});
    parity.add_row({{x, 2.0}, {y, -2.0}}, 1, 1);
    EXPECT_EQ(parity.minimise().outcome, Outcome::infeasible);
}

TEST(IntegerProgram, RefusesNonsense) {
    IntegerProgram program;
    EXPECT_THROW(program.add_variable({.lower = 2, .upper = 1}), hex::Error);
    EXPECT_THROW(program.add_variable({.lower = std::nan("")}), hex::Error);
    EXPECT_THROW(program.add_row({{0, 1.0}}, 0, 1), hex::Error);
    EXPECT_EQ(program.minimise().outcome, Outcome::optimal);
}

TEST(IntegerProgram, PrintsNothing) {
    testing::internal::CaptureStdout();
    IntegerProgram program;
    const int x = program.add_variable({.lower = 0, .upper = 9, .cost = -1, .integer = true});
    program.add_row({{x, 2.0}}, -IntegerProgram::infinity, 7);
    EXPECT_EQ(program.minimise().integer(x), 3);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}
