#include "hexspline/surface_input.h"

#include <hex/base/error.h>
#include <hex/io/cad_file.h>
#include <hex/io/list_file.h>
#include <hex/surface/polygon_soup.h>
#include <hex/surface/repair.h>

#include <limits>

namespace cli {

void describe_cad_input(CommandLine& line) {
    line.add("deflection", value<double>("H"),
             "CAD input: how far triangles may leave their face (default: 0.0005 of the diagonal)");
    line.add("longest-edge", value<double>("H"),
             "CAD input: cut longer edges of triangles; 0 leaves them (default: 0.05 of the diagonal)");
    line.add_output_file("features-out",
                         "CAD input: write the sharp edges of the model as lines of an .obj file");
}

void describe_repair(CommandLine& line) {
    line.add_switch("repair",
                    "mend the surface: merge points, remove bad polygons, orient, fill small holes");
}

void require_cad_for_its_options(const CommandLine& line, const std::filesystem::path& path) {
    if (hex::io::is_cad_file(path)) return;
    for (const char* name : {"deflection", "longest-edge", "features-out"})
        if (line.given(name))
            throw hex::Error(hex::ErrorKind::usage, std::string("--") + name + " needs a CAD model as input",
                             path.string(), "give a .step, .iges or .brep file");
}

hex::io::SurfaceFile read_surface_input(const CommandLine& line, const std::filesystem::path& path) {
    require_cad_for_its_options(line, path);
    if (!hex::io::is_cad_file(path)) return hex::io::read_surface(path);
    hex::io::CadOptions options;
    if (line.given("deflection")) {
        options.deflection = line.get<double>("deflection");
        line.require_range("deflection", options.deflection, 1e-300, 1e300);
    }
    if (line.given("longest-edge")) {
        options.longest_edge = line.get<double>("longest-edge");
        line.require_range("longest-edge", options.longest_edge, 0, 1e300);
        if (options.longest_edge == 0) options.longest_edge = std::numeric_limits<double>::infinity();
    }
    hex::io::SurfaceFile file = hex::io::read_cad(path, options);
    if (line.given("features-out"))
        hex::io::write_feature_lines(line.get<std::string>("features-out"), file.soup.points,
                                     file.sharp_edges);
    return file;
}

Json repair_input(const CommandLine& line, const std::filesystem::path& path, hex::PolygonSoup& soup) {
    if (!line.is_set("repair")) return nullptr;
    try {
        const hex::Diagnostics findings = hex::describe(hex::repair(soup));
        if (findings.empty()) line.info(path.string() + ": nothing to repair");
        for (const auto& finding : findings) line.warn(path.string() + ": repair: " + finding.message);
        return to_json(findings);
    } catch (const hex::Error& error) {
        throw error.located(path.string());
    }
}

/// An error of a surface, with what --repair would make of it.
hex::Error advised(const CommandLine& line, const hex::Error& error, hex::PolygonSoup soup) {
    if (line.is_set("repair")) return error;
    try {
        hex::repair(soup);
        (void)hex::make_triangle_mesh(soup);
    } catch (const hex::Error&) {
        return error;
    }
    const std::string own = error.advice().empty() ? std::string() : error.advice() + ", or ";
    return hex::Error(error.kind(), error.problem(), error.where(),
                      own + "give --repair, which mends this surface");
}

SurfaceInput load_surface_input(const CommandLine& line, const std::filesystem::path& path) {
    hex::io::SurfaceFile file = read_surface_input(line, path);
    line.log(file.diagnostics);
    SurfaceInput input;
    input.repair = repair_input(line, path, file.soup);
    try {
        input.mesh = hex::make_triangle_mesh(file.soup);
        line.log(hex::inspect(input.mesh), path.string());
    } catch (const hex::Error& error) {
        throw advised(line, error, file.soup).located(path.string());
    }
    return input;
}

}  // namespace cli
