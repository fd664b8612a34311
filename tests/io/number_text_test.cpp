#include <hex/io/number_text.h>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace hex::io {
namespace {

std::string text_of(double value) {
    std::string text;
    append_number(text, value);
    return text;
}

TEST(NumberText, EveryDoubleReadsBackToTheSameBits) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (!std::isfinite(value) || value == 0.0) continue;
        const auto back = parse_double(text_of(value));
        ASSERT_TRUE(back.has_value()) << text_of(value);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(*back), std::bit_cast<std::uint64_t>(value)) << text_of(value);
    }
}

TEST(NumberText, ExtremesSurvive) {
    using Limits = std::numeric_limits<double>;
    for (const double value :
         {Limits::max(), Limits::min(), Limits::denorm_min(), Limits::lowest(), 0.1, 1.0 / 3.0})
        EXPECT_EQ(parse_double(text_of(value)), value);
}

TEST(NumberText, NegativeZeroIsWrittenAsZero) {
    EXPECT_EQ(text_of(-0.0), "0");
}

TEST(NumberText, TellsOverflowFromUnderflow) {
    for (const char* small : {"1e-400", "-1e-400", "0.5e-400", "0.000000000001e-320",
                              "123456e-999999999999999999999", "0.5E-999", ".1e-330"})
        EXPECT_EQ(parse_double(small), 0.0) << small;
    for (const char* large :
         {"1e400", "-1e400", "0.5e400", "0.001e999", "1e999999999999999999999", ".5E+320", "10.5e+400"})
        EXPECT_EQ(parse_double(large), std::nullopt) << large;
    EXPECT_EQ(parse_double("1" + std::string(400, '0')), std::nullopt);
    EXPECT_EQ(parse_double("0." + std::string(400, '0') + "1"), 0.0);
    EXPECT_EQ(parse_double("1" + std::string(400, '0') + "e-5"), std::nullopt);
}

TEST(NumberText, RefusesWhatIsNoNumber) {
    for (const char* text : {"", "+", "-", ".", "e5", "1e", "1,5", "1.5x", " 1", "1 ", "nan", "inf", "-inf",
                             "+-1", "--1", "0x10", "1d5"})
        EXPECT_EQ(parse_double(text), std::nullopt) << text;
    for (const char* text : {"", "1.0", "1e3", "+-1", "99999999999999999999", " 1", "abc"})
        EXPECT_EQ(parse_integer(text), std::nullopt) << text;
}

TEST(NumberText, TakesAPlus) {
    EXPECT_EQ(parse_double("+1.5"), 1.5);
    EXPECT_EQ(parse_integer("+15"), 15);
}

}  // namespace
}  // namespace hex::io
