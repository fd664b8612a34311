// BEXT files cut off or damaged anywhere.
#include "support/damage.h"
#include "support/test_files.h"

#include <spline/io/bext.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace spline::io {
namespace {

TEST(DamagedBext, IsReadOrRefusedInLittleTimeAndMemory) {
    const hex::test::TemporaryFolder folder;
    const auto corpus = hex::test::own_data().parent_path() / "tests/fuzz/corpus/bext";
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(corpus)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    ASSERT_GE(files.size(), 2U);
    for (const auto& file : files) {
        const std::string whole = hex::test::read_text(file);
        std::mt19937 random(1);
        for (int round = 0; round < 200; ++round) {
            const auto path = folder / "d.bext";
            hex::test::write_text(path, hex::test::damaged(whole, random, 1 + round % 4));
            SCOPED_TRACE(file.filename().string() + ", round " + std::to_string(round));
            hex::test::expect_read_or_refused(path, [](const auto& damaged) { read_bext(damaged); });
        }
    }
}

}  // namespace
}  // namespace spline::io
