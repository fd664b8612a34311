/// \file plugin_loader.h
/// Loads plug-ins (hex/base/plugin.h) with Boost.DLL.
#pragma once

#include <string>
#include <vector>

namespace cli {

/// Loads every *.so in the folders of the environment variable HEXSPLINE_PLUGIN_PATH (separated by ':', each
/// in the order of names), then `files`. They stay loaded until the program ends. Throws
/// hex::Error{bad_input} naming the file for one that cannot be loaded, is no plug-in, or was built for
/// another version of the interface.
void load_plugins(const std::vector<std::string>& files);

}  // namespace cli
