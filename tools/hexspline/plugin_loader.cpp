#include "hexspline/plugin_loader.h"

#include <hex/base/error.h>
#include <hex/base/isolated.h>
#include <hex/base/method_call.h>
#include <hex/base/plugin.h>
#include <hex/base/registry.h>

#include <boost/dll/shared_library.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>

namespace cli {
namespace {

[[noreturn]] void reject(const std::string& file, const std::string& what, const std::string& advice = {}) {
    throw hex::Error(hex::ErrorKind::bad_input, what, file, advice);
}

/// Methods keep pointers to code of the library, so libraries are never unloaded.
std::vector<boost::dll::shared_library>& loaded_libraries() {
    static auto* libraries = new std::vector<boost::dll::shared_library>();
    return *libraries;
}

/// Names the origin of what registers during its life.
class OriginGuard {
  public:
    explicit OriginGuard(const std::string& origin) : before_(hex::registration_origin()) {
        hex::registration_origin() = origin;
    }
    ~OriginGuard() { hex::registration_origin() = before_; }
    OriginGuard(const OriginGuard&) = delete;
    OriginGuard& operator=(const OriginGuard&) = delete;

  private:
    std::string before_;
};

/// A pipe or a device would keep the loader waiting.
void require_regular_file(const std::string& file) {
    std::error_code problem;
    const auto status = std::filesystem::status(file, problem);
    if (status.type() == std::filesystem::file_type::not_found) reject(file, "there is no such plug-in");
    if (!std::filesystem::status_known(status))
        reject(file, "cannot be opened as a plug-in (" + problem.message() + ")");
    if (!std::filesystem::is_regular_file(status)) reject(file, "is no plug-in, not even a regular file");
}

/// What dlopen() says of the file, without the file and without what Boost puts around it: "boost::dll::
/// shared_library::load() failed (dlerror system message: FILE: REASON): LAST ERROR".
std::string loader_reason(const std::string& path, const std::exception& problem) {
    std::string text = hex::message_of(problem);
    constexpr std::string_view mark = "dlerror system message: ";
    const auto start = text.find(mark), end = text.rfind("): ");
    if (start == std::string::npos || end == std::string::npos || end < start + mark.size()) return text;
    text = text.substr(start + mark.size(), end - start - mark.size());
    return text.starts_with(path + ": ") ? text.substr(path.size() + 2) : text;
}

/// Loads the library and lets it register its methods. Throws hex::Error{bad_input}.
void open_plugin(const std::string& file) {
    const OriginGuard origin(file);
    const std::string path = std::filesystem::absolute(file).string();
    boost::dll::shared_library library;
    try {
        library.load(path, boost::dll::load_mode::rtld_now);
    } catch (const std::exception& problem) {
        reject(file, "cannot be loaded as a plug-in: " + loader_reason(path, problem));
    }
    if (!library.has(hex::plugin_symbol))
        reject(file, "is no hexspline plug-in: it does not export '" + std::string(hex::plugin_symbol) + "'",
               "use the macro HEX_PLUGIN");
    const auto& info = library.get<const hex::PluginInfo>(hex::plugin_symbol);
    if (info.interface_version != hex::plugin_interface_version)
        reject(file,
               "was built for plug-in interface " + std::to_string(info.interface_version) +
                   ", this program has " + std::to_string(hex::plugin_interface_version),
               "build it again");
    if (info.register_methods == nullptr) reject(file, "registers nothing");
    try {
        info.register_methods();
    } catch (const std::exception& problem) {
        reject(file, "failed to register its methods: " + hex::message_of(problem));
    } catch (...) {
        reject(file, "failed to register its methods: an exception of unknown kind");
    }
    loaded_libraries().push_back(std::move(library));
}

/// Opens the plug-in in a process of its own: one that crashes there, ends the process or never comes back
/// is refused instead of taking the program with it. Throws hex::Error{bad_input}, and Error{output} when no
/// process can be made.
void try_plugin(const std::string& file) {
    constexpr unsigned patience = 10;
    constexpr char separator = '\0';
    const auto outcome = hex::run_isolated(
        [&]() -> std::string {
            try {
                open_plugin(file);
                return {};
            } catch (const hex::Error& error) {
                return error.problem() + separator + error.advice();
            } catch (const std::exception& problem) {
                return std::string("cannot be loaded as a plug-in: ") + problem.what() + separator;
            }
        },
        {.processor_seconds = 0, .seconds = patience});
    if (!outcome.failure.empty()) reject(file, "fails while it is loaded as a plug-in: " + outcome.failure);
    if (outcome.bytes.empty()) return;
    const auto end = outcome.bytes.find(separator);
    reject(file, outcome.bytes.substr(0, end), outcome.bytes.substr(end + 1));
}

void load_plugin(const std::string& file) {
    require_regular_file(file);
    try_plugin(file);
    open_plugin(file);
}

std::vector<std::string> plugins_of_path() {
    std::vector<std::string> files;
    const char* path = std::getenv("HEXSPLINE_PLUGIN_PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (folder.empty()) continue;
        std::error_code problem;
        std::vector<std::string> in_folder;
        for (const auto& entry : std::filesystem::directory_iterator(folder, problem)) {
            if (entry.path().extension() == ".so") in_folder.push_back(entry.path().string());
        }
        if (problem) reject(folder, "HEXSPLINE_PLUGIN_PATH names a folder that cannot be read");
        std::sort(in_folder.begin(), in_folder.end());
        files.insert(files.end(), in_folder.begin(), in_folder.end());
    }
    return files;
}

}  // namespace

void load_plugins(const std::vector<std::string>& files) {
    for (const auto& file : plugins_of_path()) load_plugin(file);
    for (const auto& file : files) load_plugin(file);
}

}  // namespace cli
