#include "support/test_files.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
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

int run_python(const std::string& script, const std::vector<std::string>& arguments) {
    const std::string python = HEXSPLINE_PYTHON;
    if (python.empty() || std::system((python + " -c 'import vtkmodules' 2>/dev/null").c_str()) != 0)
        return -1;
    std::string command = python + " '" + HEXSPLINE_SOURCE_DIR + "/tests/" + script + "'";
    for (const std::string& argument : arguments) command += " '" + argument + "'";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
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
