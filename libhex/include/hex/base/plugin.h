/// \file plugin.h
/// Entry point of a plug-in: a shared library that adds methods to the registries of the stages.
///
///     #include <hex/base/plugin.h>
///     #include <hex/segment/segment.h>
///
///     class MySegmenter : public hex::Segmenter { ... };
///
///     static void register_methods() {
///         hex::segmenters().add("mine", "what it does in one line", [] { return
///         std::make_unique<MySegmenter>(); });
///     }
///     HEX_PLUGIN("my-plugin", "1.0", register_methods)
///
/// Loaded with `--plugin my-plugin.so` or from the folders of HEXSPLINE_PLUGIN_PATH.
#pragma once

#include <hex/base/version.h>

namespace hex {

/// What a plug-in tells the program about itself. Plain data, so that a wrong version can be seen before any
/// code of the plug-in is called (its static constructors have run by then).
struct PluginInfo {
    int interface_version;       ///< hex::plugin_interface_version it was compiled against
    const char* name;            ///< of the plug-in, for messages
    const char* version;         ///< of the plug-in
    void (*register_methods)();  ///< adds its methods to the registries; may throw hex::Error
};

/// Name of the exported symbol of type PluginInfo.
inline constexpr const char* plugin_symbol = "hexspline_plugin";

}  // namespace hex

/// Makes a shared library a plug-in: defines and exports its PluginInfo. To be written once, outside of all
/// namespaces, in one .cpp of the library.
/// \param name     of the plug-in, a string literal
/// \param version  of the plug-in, a string literal
/// \param function `void function()`, which adds the methods to the registries; it may throw hex::Error
#define HEX_PLUGIN(name, version, function)                                                            \
    extern "C" __attribute__((visibility("default"))) const hex::PluginInfo hexspline_plugin;          \
    extern "C" const hex::PluginInfo hexspline_plugin = {hex::plugin_interface_version, name, version, \
                                                         function};
