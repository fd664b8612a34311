// BEXT files cut off or damaged anywhere.
#include "support/damage.h"
#include "support/test_files.h"

#include <spline/io/bext.h>

#include <gtest/gtest.h>

namespace spline::io {
namespace {

TEST(DamagedBext, IsReadOrRefusedInLittleTimeAndMemory) {
    const hex::test::TemporaryFolder folder;
    const auto corpus = hex::test::own_data().parent_path() / "tests/fuzz/corpus/bext";
    for (const char* name : {"cube.bext", "cube2.bext"}) {
        const std::string whole = hex::test::read_text(corpus / name);
        std::mt19937 random(1);
        for (int round = 0; round < 200; ++round) {
            const auto path = folder / "d.bext";
            hex::test::write_text(path, hex::test::damaged(whole, random, 1 + round % 4));
            SCOPED_TRACE(std::string(name) + ", round " + std::to_string(round));
            hex::test::expect_read_or_refused(path, [](const auto& file) { read_bext(file); });
        }
    }
}

}  // namespace
}  // namespace spline::io
