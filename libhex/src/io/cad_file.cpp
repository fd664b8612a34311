#include "io/cad_message.h"
#include "io/cad_shape.h"
#include "io/input_file.h"
#include "io/long_edges.h"

#include <hex/base/error.h>
#include <hex/base/isolated.h>
#include <hex/io/cad_file.h>
#include <hex/io/mesh_file.h>

#include <cmath>
#include <optional>

namespace hex::io {
namespace {

std::optional<CadFormat> format_named(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    if (extension == ".step" || extension == ".stp") return CadFormat::step;
    if (extension == ".iges" || extension == ".igs") return CadFormat::iges;
    if (extension == ".brep") return CadFormat::brep;
    return std::nullopt;
}

/// What every file of the format has; found missing here it is told in plain words, before Open CASCADE
/// looks.
void require_frame(CadFormat format, const InputFile& file) {
    const std::string_view text = file.bytes().substr(file.text_start());
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::bad_input, what, file.name(), "export the model again");
    };
    switch (format) {
        case CadFormat::step:
            if (trimmed(text.substr(0, 256)).substr(0, 12) != "ISO-10303-21")
                fail("is no STEP file: it does not begin with ISO-10303-21");
            if (text.find("END-ISO-10303-21") == std::string_view::npos)
                fail("ends early: END-ISO-10303-21 is missing");
            break;
        case CadFormat::iges: {
            if (text.size() < 80 || text[72] != 'S')
                fail("is no IGES file: its first line is no start section");
            // The last line has a T in column 73.
            const std::string_view end = trimmed(text);
            const std::size_t line = end.find_last_of('\n');
            const std::string_view last = line == std::string_view::npos ? end : end.substr(line + 1);
            if (last.size() < 73 || last[72] != 'T') fail("ends early: the terminate section is missing");
            break;
        }
        case CadFormat::brep:
            if (text.substr(0, 256).find("DBRep_DrawableShape") == std::string_view::npos &&
                text.substr(0, 256).find("CASCADE Topology V") == std::string_view::npos)
                fail("is no BREP file of Open CASCADE");
            break;
    }
}

void require_options(const CadOptions& options) {
    const auto positive = [](double value) { return value > 0.0; };
    if (!(options.deflection >= 0.0) || !std::isfinite(options.deflection))
        throw Error(ErrorKind::usage, "the deflection must be a number that is not negative");
    if (!positive(options.angle) || options.angle > 90.0)
        throw Error(ErrorKind::usage, "the angle between segments must be above 0 and at most 90 degrees");
    if (!(options.longest_edge >= 0.0))
        throw Error(ErrorKind::usage, "the longest edge must be a number that is not negative");
    if (!(options.sharp_angle >= 0.0) || options.sharp_angle > 180.0)
        throw Error(ErrorKind::usage, "the sharp angle must be 0 .. 180 degrees");
}

std::string to_bytes(const CadTriangles& cad) {
    ByteWriter out;
    out.value(true);
    const PolygonSoup& soup = cad.data.surface;
    std::vector<std::array<double, 3>> points;
    for (const Vec3& p : soup.points) points.push_back({p.x(), p.y(), p.z()});
    out.list(points.data(), points.size());
    out.list(soup.corners.data(), soup.corners.size());
    out.list(soup.offsets.data(), soup.offsets.size());
    out.list(soup.parts.data(), soup.parts.size());
    out.list(cad.sharp_edges.data(), cad.sharp_edges.size());
    out.value(cad.data.diagnostics.size());
    for (const Diagnostic& finding : cad.data.diagnostics) {
        out.value(finding.severity);
        out.text(finding.code);
        out.text(finding.message);
        out.text(finding.entity);
        out.list(finding.ids.data(), finding.ids.size());
    }
    return out.take();
}

std::string to_bytes(ErrorKind kind, const std::string& what, const std::string& advice) {
    ByteWriter out;
    out.value(false);
    out.value(kind);
    out.text(what);
    out.text(advice);
    return out.take();
}

CadTriangles from_bytes(const std::string& bytes) {
    ByteReader in(bytes);
    if (!in.value<bool>()) {
        const auto kind = in.value<ErrorKind>();
        std::string what = in.text();
        throw Error(kind, std::move(what), {}, in.text());
    }
    CadTriangles cad;
    PolygonSoup& soup = cad.data.surface;
    for (const auto& p : in.list<std::array<double, 3>>()) soup.points.emplace_back(p[0], p[1], p[2]);
    soup.corners = in.list<std::uint32_t>();
    soup.offsets = in.list<std::size_t>();
    soup.parts = in.list<int>();
    cad.sharp_edges = in.list<std::array<std::uint32_t, 2>>();
    const auto findings = in.value<std::size_t>();
    for (std::size_t i = 0; i < findings; ++i) {
        Diagnostic finding;
        finding.severity = in.value<Severity>();
        finding.code = in.text();
        finding.message = in.text();
        finding.entity = in.text();
        finding.ids = in.list<std::int64_t>();
        cad.data.diagnostics.push_back(std::move(finding));
    }
    return cad;
}

/// Open CASCADE crashes on some damaged files, so it works in a process of its own.
CadTriangles tessellate_safely(CadFormat format, const InputFile& file, const std::string& path,
                               const CadOptions& options) {
    // Some damaged files make Open CASCADE loop. A sound one of a megabyte takes a few seconds.
    const auto seconds = static_cast<unsigned>(30 + file.bytes().size() / 20000);
    const auto work = [&] {
        try {
            return to_bytes(tessellate_cad(format, path, file.bytes(), options));
        } catch (const Error& error) {
            return to_bytes(error.kind(), error.problem(), error.advice());
        } catch (const std::exception& error) {
            return to_bytes(ErrorKind::bad_input, std::string("cannot be read: ") + error.what(),
                            "export the model again");
        }
    };
    const IsolatedResult result = run_isolated(work, {.processor_seconds = seconds, .seconds = 0});
    if (!result.failure.empty())
        throw Error(ErrorKind::bad_input, "is damaged: reading it fails", {}, "export the model again");
    return from_bytes(result.bytes);
}

double diagonal_of(const std::vector<Vec3>& points) {
    BoundingBox box;
    for (const Vec3& p : points) box.add(p);
    return box.diagonal();
}

}  // namespace

bool is_cad_file(const std::filesystem::path& path) {
    return format_named(path).has_value();
}

SurfaceFile read_cad(const std::filesystem::path& path, const CadOptions& options) {
    require_options(options);
    const InputFile file(path);
    const std::optional<CadFormat> format = format_named(path);
    if (!format)
        throw Error(ErrorKind::unsupported, "is no CAD file by its extension", path.string(),
                    "use one of .step .stp .iges .igs .brep");
    require_frame(*format, file);
    CadTriangles cad;
    try {
        cad = tessellate_safely(*format, file, path.string(), options);
    } catch (const Error& error) {
        throw error.located(path.string());
    }
    if (cad.data.surface.size() == 0)
        throw Error(ErrorKind::bad_input, "holds no faces", path.string(), "export solids");
    const double longest =
        options.longest_edge > 0.0 ? options.longest_edge : 0.05 * diagonal_of(cad.data.surface.points);
    if (longest > 0.0 && std::isfinite(longest)) cut_long_edges(cad.data.surface, cad.sharp_edges, longest);
    for (Diagnostic& finding : cad.data.diagnostics) finding.message = path.string() + ": " + finding.message;
    return {std::move(cad.data.surface), {}, std::move(cad.data.diagnostics), std::move(cad.sharp_edges)};
}

}  // namespace hex::io
