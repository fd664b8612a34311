#include "spline_samples.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <spline/io/bext.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

namespace spline::test {
namespace {

TEST(Bext, RoundTripIsExact) {
    for (const bool refined : {false, true}) {
        const hex::test::TemporaryFolder folder;
        const BezierSpline written = small_spline(refined);
        io::write_bext(folder / "a.bext", written);
        const BezierSpline read = io::read_bext(folder / "a.bext");
        expect_same_extraction(read, written);
        io::write_bext(folder / "b.bext", read);
        EXPECT_EQ(hex::test::read_text(folder / "a.bext"), hex::test::read_text(folder / "b.bext"));
    }
}

TEST(Bext, LayoutIsThePublishedOne) {
    const hex::test::TemporaryFolder folder;
    io::write_bext(folder / "a.bext", build(hex::test::grid(1, 1, 1)).spline);
    std::istringstream text(hex::test::read_text(folder / "a.bext"));
    std::string line;
    std::vector<std::string> lines;
    while (std::getline(text, line)) lines.push_back(line);
    ASSERT_EQ(lines.size(), 4U + 8U + 2U + 8U);
    EXPECT_EQ(lines[0], "B E X T");
    EXPECT_EQ(lines[1], "type hex");
    EXPECT_EQ(lines[2], "nodeN 8");
    EXPECT_EQ(lines[3], "elemN 1");
    EXPECT_EQ(lines[5], "gnode 1 0 0 1");
    EXPECT_EQ(lines[12], "belem 8 3 3 3");
    EXPECT_EQ(lines[13], "0 1 2 3 4 5 6 7");
    EXPECT_EQ(lines[14].substr(0, 2), "d ");
}

TEST(Bext, RowsOfAtMostTwentyNonZerosAreSparse) {
    const hex::test::TemporaryFolder folder;
    io::write_bext(folder / "a.bext", build(hex::test::grid(3, 3, 3)).spline);
    std::istringstream text(hex::test::read_text(folder / "a.bext"));
    std::string line;
    std::size_t sparse = 0, dense = 0;
    while (std::getline(text, line)) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "s") {
            std::size_t count = 0, column = 0;
            double value = 0.0;
            words >> count;
            EXPECT_LE(count, 20U);
            for (std::size_t i = 0; i < count; ++i) {
                words >> column >> value;
                EXPECT_LT(column, 64U);
                EXPECT_NE(value, 0.0);
            }
            EXPECT_TRUE(words);
            ++sparse;
        } else if (kind == "d") {
            std::size_t non_zeros = 0;
            for (double value; words >> value;) non_zeros += value != 0.0;
            EXPECT_GT(non_zeros, 20U);
            ++dense;
        }
    }
    EXPECT_EQ(dense, 27U * 8U);
    EXPECT_GT(sparse, 0U);
}

TEST(Bext, FileIsTheSameForAnyNumberOfThreads) {
    const hex::test::TemporaryFolder folder;
    const BezierSpline spline = small_spline(true);
    hex::Context one, two;
    one.threads = 1;
    two.threads = 2;
    io::write_bext(folder / "one", spline, one);
    io::write_bext(folder / "two", spline, two);
    EXPECT_EQ(hex::test::read_text(folder / "one"), hex::test::read_text(folder / "two"));
}

struct Broken {
    const char* name;
    const char* from;  ///< first occurrence of this in a good file
    const char* to;    ///< becomes this
    const char* message;
    int line;
};

class BrokenBext : public testing::TestWithParam<Broken> {};

const Broken broken_files[] = {
    {"magic", "B E X T", "B E X X", "does not start with", 1},
    {"type", "type hex", "type tet", "type 'tet'", 2},
    {"node_count", "nodeN 8", "nodeN 9", "nodeN says 9 control points, there are 8", 0},
    {"too_many_nodes", "nodeN 8", "nodeN 7", "more control points than nodeN", 12},
    {"element_count", "elemN 1", "elemN 2", "elemN says 2 elements, there are 1", 0},
    {"no_elements", "elemN 1", "elemN 0", "has no elements", 4},
    {"huge_count", "elemN 1", "elemN 99999999999999", "elemN says", 0},
    {"coordinate", "gnode 1 0 0 1", "gnode 1 x 0 1", "'x' where a coordinate", 6},
    {"not_a_number", "gnode 1 0 0 1", "gnode 1 nan 0 1", "'nan' where a coordinate", 6},
    {"weight", "gnode 1 0 0 1", "gnode 1 0 0 -1", "weight", 6},
    {"degree", "3 3 3", "3 2 3", "degree", 13},
    {"control_point", "0 1 2 3 4 5 6 7", "0 1 2 3 4 5 6 8", "control point 8 of 8", 14},
    {"twice", "0 1 2 3 4 5 6 7", "0 1 2 3 4 5 6 6", "control point 6 twice in an element", 14},
    {"column_twice", "\nd ", "\ns 2 5 0.1 5 0.1 ", "column 5 twice in a row", 15},
    {"row_kind", "\nd ", "\nq ", "'q' where a row", 15},
    {"keyword", "belem", "delem", "unknown keyword 'delem'", 13},
};
INSTANTIATE_TEST_SUITE_P(Files, BrokenBext, testing::ValuesIn(broken_files),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST_P(BrokenBext, IsRefusedWithItsLine) {
    const hex::test::TemporaryFolder folder;
    const auto path = folder / "a.bext";
    io::write_bext(path, build(hex::test::grid(1, 1, 1)).spline);
    std::string text = hex::test::read_text(path);
    const auto at = text.find(GetParam().from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string(GetParam().from).size(), GetParam().to);
    hex::test::write_text(path, text);
    try {
        io::read_bext(path);
        FAIL();
    } catch (const hex::Error& error) {
        EXPECT_NE(error.problem().find(GetParam().message), std::string::npos) << error.what();
        EXPECT_EQ(hex::exit_code(error.kind()), 3);
        if (GetParam().line > 0) {
            EXPECT_EQ(error.where(), path.string() + ":" + std::to_string(GetParam().line)) << error.what();
        }
    }
}

TEST(Bext, TruncatedMissingEmptyAndFolderAreRefused) {
    const hex::test::TemporaryFolder folder;
    const auto path = folder / "a.bext";
    io::write_bext(path, build(hex::test::grid(1, 1, 1)).spline);
    const std::string text = hex::test::read_text(path);
    for (const std::size_t length : {std::size_t{0}, std::size_t{3}, text.size() / 3, text.size() - 200}) {
        hex::test::write_text(path, text.substr(0, length));
        EXPECT_THROW(io::read_bext(path), hex::Error) << length;
    }
    EXPECT_THROW(io::read_bext(folder / "none"), hex::Error);
    EXPECT_THROW(io::read_bext(folder.path()), hex::Error);
}

}  // namespace
}  // namespace spline::test
