#include "support/test_files.h"

#include <unistd.h>

#include <fstream>
#include <sstream>

namespace hex::test {

std::filesystem::path reference_data() {
    const std::filesystem::path path = HEXSPLINE_REFERENCE_DATA;
    return std::filesystem::exists(path) ? path : std::filesystem::path();
}

std::filesystem::path own_data() {
    return std::filesystem::path(HEXSPLINE_SOURCE_DIR) / "data";
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hexspline-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

}  // namespace hex::test
