/// \file version.h
/// Version of the libraries, and of the plug-in interface (raised when a public interface changes shape).
#pragma once

namespace hex {

inline constexpr const char* version = "0.1.0";
inline constexpr int plugin_interface_version = 1;

}  // namespace hex
