/// \file test_files.h
/// Files that tests read and write.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace hex::test {

/// Folder of the published models, or an empty path when the build was configured without
/// HEXSPLINE_REFERENCE_DATA.
std::filesystem::path reference_data();

/// The project's own data/ folder.
std::filesystem::path own_data();

/// Runs a Python script of tests/ (path relative to it) with words as arguments, with the interpreter that
/// has VTK. Returns its exit code, or -1 when there is no such interpreter.
int run_python(const std::string& script, const std::vector<std::string>& arguments);

/// A fresh folder that is removed at the end of its life.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace hex::test

/// Skips a test that needs the published models when they are not there.
#define HEX_NEEDS_REFERENCE_DATA() \
    if (hex::test::reference_data().empty()) GTEST_SKIP() << "skipped: HEXSPLINE_REFERENCE_DATA is not set"
