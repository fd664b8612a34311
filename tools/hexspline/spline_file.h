/// \file spline_file.h
/// Files of splines by their format, whatever the command.
#pragma once

#include <hex/base/context.h>
#include <spline/bezier.h>

#include <filesystem>
#include <optional>
#include <string>

namespace cli {

enum class SplineFormat { bext, bext2, vtu, json };

/// "bext", "bext2", "vtu" or "json"; throws Error{usage} for another name.
SplineFormat spline_format_named(const std::string& name);
/// By the extension: .bext, .bxt or .bext2, .vtu, .json; none for another one.
std::optional<SplineFormat> spline_format_of(const std::filesystem::path& path);

/// The extension is one of BEXT.
bool is_bext(const std::filesystem::path& path);

void write_spline(const std::filesystem::path& path, SplineFormat format, const spline::BezierSpline& spline,
                  const hex::Context& context);

}  // namespace cli
