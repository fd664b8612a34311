/// \file version.h
/// Version of the libraries, and of the plug-in interface (raised when a public interface changes shape).
#pragma once

namespace hex {

/// Release of the program and both libraries: "major.minor.patch".
inline constexpr const char* version = "0.1.0";
/// Counts the shapes of the plug-in interface. A plug-in that was compiled against another number is refused
/// before it registers anything.
inline constexpr int plugin_interface_version = 1;

}  // namespace hex
