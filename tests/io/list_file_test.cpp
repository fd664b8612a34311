#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/list_file.h>

#include <gtest/gtest.h>

namespace hex::io {
namespace {

using test::TemporaryFolder;

template <class Read>
std::string message_of(const std::string& text, const Read& read) {
    const TemporaryFolder folder;
    test::write_text(folder / "list.txt", text);
    try {
        read(folder / "list.txt");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        const std::string name = (folder / "list.txt").string();
        EXPECT_EQ(error.where().find(name), 0u);
        return error.where().substr(name.size()) + " " + error.problem();
    }
    return "accepted";
}

TEST(Labels, ReadBackAsWritten) {
    const TemporaryFolder folder;
    const std::vector<int> labels = {0, 5, 3, 3, 1};
    write_labels(folder / "labels.txt", labels);
    EXPECT_EQ(test::read_text(folder / "labels.txt"), "0\n5\n3\n3\n1\n");
    EXPECT_EQ(read_labels(folder / "labels.txt"), labels);
}

TEST(Labels, NameTheLineThatIsWrong) {
    EXPECT_EQ(message_of("0\n\nx\n", [](const auto& p) { read_labels(p); }),
              ":3 a label should be an integer, not 'x'");
    EXPECT_EQ(message_of("0\n1 2\n", [](const auto& p) { read_labels(p); }),
              ":2 a line should hold one label, not 2 values");
    EXPECT_EQ(message_of("99999999999\n", [](const auto& p) { read_labels(p); }),
              ":1 label 99999999999 is out of range");
}

TEST(Overrides, BothColumnsAreCountedFromTheBase) {
    const TemporaryFolder folder;
    test::write_text(folder / "m.txt", "# by hand\r\n355 1\r\n\r\n495,6");
    const auto overrides = read_overrides(folder / "m.txt", 1);
    ASSERT_EQ(overrides.size(), 2u);
    EXPECT_EQ(overrides[0].triangle, 354);
    EXPECT_EQ(overrides[0].label, 0);
    EXPECT_EQ(overrides[0].line, 2);
    EXPECT_EQ(overrides[1].triangle, 494);
    EXPECT_EQ(overrides[1].label, 5);
    EXPECT_EQ(overrides[1].line, 4);
    EXPECT_EQ(read_overrides(folder / "m.txt", 0)[0].triangle, 355);
}

TEST(Overrides, NameTheLineThatIsWrong) {
    EXPECT_EQ(message_of("1 2\n3\n", [](const auto& p) { read_overrides(p); }),
              ":2 a line should hold an element and a label, not 1 values");
    EXPECT_EQ(message_of("0 1\n", [](const auto& p) { read_overrides(p, 1); }),
              ":1 element and label are counted from 1; found 0 1");
}

TEST(SharpVertices, TakeTheLastIntegerOfALine) {
    const TemporaryFolder folder;
    test::write_text(folder / "sharp.txt", "0\t\t1426\t\t\t\r\n17\r\n0\t12\t0.5");
    EXPECT_EQ(read_sharp_vertices(folder / "sharp.txt"), (std::vector<std::int64_t>{1426, 17, 12}));
    EXPECT_EQ(message_of("1\nabc\n", [](const auto& p) { read_sharp_vertices(p); }),
              ":2 the line holds no vertex index");
    EXPECT_EQ(message_of("-1\n", [](const auto& p) { read_sharp_vertices(p); }), ":1 vertex -1 is negative");
}

TEST(Refinement, ListsElementsByLevel) {
    const TemporaryFolder folder;
    test::write_text(folder / "lev.txt", "0\t\t\t950\t\t\t\r\n2 7\r\n0 948");
    const auto levels = read_refinement(folder / "lev.txt");
    EXPECT_EQ(levels, (std::vector<std::vector<std::int64_t>>{{950, 948}, {}, {7}}));
    EXPECT_EQ(message_of("0 1\n1000000 1\n", [](const auto& p) { read_refinement(p); }),
              ":2 level 1000000 is more than 30");
    EXPECT_EQ(message_of("-1 1\n", [](const auto& p) { read_refinement(p); }), ":1 level -1 is negative");
    EXPECT_EQ(message_of("1\n", [](const auto& p) { read_refinement(p); }),
              ":1 a line should hold a level and an element, not 1 values");
}

TEST(PolycubeLists, AreWrittenAsThePaperDoes) {
    const TemporaryFolder folder;
    write_corner_list(folder / "c.txt", std::array{21, 143},
                      std::array{Vec3(4.06622, 0.0052, 2.31336), Vec3(16.4588, 0.7317, 2.29912)});
    EXPECT_EQ(test::read_text(folder / "c.txt"), "21 4.06622 0.0052 2.31336 \n143 16.4588 0.7317 2.29912 \n");
    write_edge_list(folder / "e.txt", std::array{std::array{371, 446}, std::array{436, 446}});
    EXPECT_EQ(test::read_text(folder / "e.txt"), "371,446\n436,446\n");
    write_face_list(folder / "f.txt", std::vector<std::array<int, 4>>{{371, 446, 436, 442}});
    EXPECT_EQ(test::read_text(folder / "f.txt"), "371,446,436,442,\n");
}

}  // namespace
}  // namespace hex::io
