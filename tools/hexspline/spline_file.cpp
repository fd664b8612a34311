#include "hexspline/spline_file.h"

#include <hex/base/error.h>
#include <hex/io/mesh_file.h>
#include <spline/io/bext.h>
#include <spline/io/bext2.h>
#include <spline/io/bezier_vtu.h>
#include <spline/io/spline_json.h>

namespace cli {

SplineFormat spline_format_named(const std::string& name) {
    if (name == "bext") return SplineFormat::bext;
    if (name == "bext2") return SplineFormat::bext2;
    if (name == "vtu") return SplineFormat::vtu;
    if (name == "json") return SplineFormat::json;
    throw hex::Error(hex::ErrorKind::usage, "unknown --format '" + name + "'", {},
                     "known: bext, bext2, vtu, json");
}

std::optional<SplineFormat> spline_format_of(const std::filesystem::path& path) {
    const std::string extension = hex::io::extension_of(path);
    if (extension == ".bext") return SplineFormat::bext;
    if (extension == ".bxt" || extension == ".bext2") return SplineFormat::bext2;
    if (extension == ".vtu") return SplineFormat::vtu;
    if (extension == ".json") return SplineFormat::json;
    return {};
}

bool is_bext(const std::filesystem::path& path) {
    const auto format = spline_format_of(path);
    return format == SplineFormat::bext || format == SplineFormat::bext2;
}

void write_spline(const std::filesystem::path& path, SplineFormat format, const spline::BezierSpline& spline,
                  const hex::Context& context) {
    switch (format) {
        case SplineFormat::bext:
            return spline::io::write_bext(path, spline, context);
        case SplineFormat::bext2:
            return spline::io::write_bext2(path, spline, context);
        case SplineFormat::vtu:
            return spline::io::write_bezier_vtu(path, spline);
        case SplineFormat::json:
            return spline::io::write_spline_json(path, spline);
    }
}

}  // namespace cli
