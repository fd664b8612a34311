/// Sample runs:
///   hexspline convert -i part.stl -o part.k
///   hexspline convert -i part_hex.vtk -o part_hex.vtu
///   hexspline convert -i part.stl --labels labels.txt -o part_segment.k
///   hexspline convert -i part.step -o part.k --features-out part_edges.obj
///   hexspline convert -i part.bext -o part.bxt

#include "hexspline/command.h"
#include "hexspline/spline_file.h"
#include "hexspline/surface_input.h"

#include <hex/base/error.h>
#include <hex/io/cad_file.h>
#include <hex/io/list_file.h>
#include <hex/io/mesh_file.h>
#include <spline/io/bext.h>

#include <algorithm>
#include <climits>
#include <set>

namespace cli {
namespace {

std::string list_of_formats() {
    std::string list = "Formats (r reads, w writes):\n";
    for (const auto& format : hex::io::formats()) {
        std::string extensions;
        for (const auto extension : format.extensions) extensions.append(extension) += ' ';
        extensions.resize(12, ' ');
        list += "  " + extensions;
        list += format.reads_surfaces ? "surfaces r" : "surfaces -";
        list += format.writes_surfaces ? "w" : "-";
        list += format.reads_hexahedra ? "  hexahedra r" : "  hexahedra -";
        list += format.writes_hexahedra ? "w  " : "-  ";
        list.append(format.name) += '\n';
    }
    return list +
           "A file of hexahedra is written as hexahedra, any other as a surface.\n"
           "Splines: .bext (BEXT 1) and .bxt (BEXT 2.0) are read and written, .vtu and .json written.";
}

void describe(CommandLine& line) {
    line.add_input("surface, hexahedral mesh, or spline as BEXT");
    line.add_output(
        "the same in the format of this file's extension; .txt: its labels (part id - 1), one a line");
    line.add("labels", value<std::string>("FILE"), "one label a polygon, as text: becomes the part id - 1");
    describe_repair(line);
    describe_cad_input(line);
}

hex::io::MeshFile read_input(const CommandLine& line) {
    if (hex::io::is_cad_file(line.input())) return read_surface_input(line, line.input());
    require_cad_for_its_options(line, line.input());
    return hex::io::read_mesh_file(line.input());
}

/// Names that the new format cannot hold are others there, or are lost.
void warn_of_altered_names(const CommandLine& line, const hex::io::FormatInfo& format,
                           std::span<const int> parts, const hex::io::PartNames& names) {
    const std::set<int> distinct(parts.begin(), parts.end());
    const auto written = format.names_written(std::vector<int>(distinct.begin(), distinct.end()), names);
    std::string first;
    std::size_t count = 0;
    for (const auto& [part, name] : names) {
        if (!distinct.contains(part)) continue;
        const auto found = written.find(part);
        if (found == written.end())
            line.warn(line.output().string() + ": " + std::string(format.name) + " has no name for part " +
                      std::to_string(part) + "; '" + name + "' is lost");
        if (found == written.end() || found->second == name) continue;
        if (++count == 1) first = "'" + name + "' as '" + found->second + "'";
    }
    if (count > 0)
        line.warn(line.output().string() + ": names of parts are written as " + std::string(format.name) +
                  " can hold them: " + first +
                  (count > 1 ? " (and " + std::to_string(count - 1) + " more)" : std::string()));
}

/// Says what the new format drops.
void warn_of_loss(const CommandLine& line, std::span<const int> parts, const hex::io::PartNames& names) {
    const auto* format = hex::io::find_format(line.output());
    if (format != nullptr && !format->part_names && !names.empty())
        line.warn(line.output().string() + ": " + std::string(format->name) + " carries no names of parts; " +
                  (names.size() == 1 ? "that of one is lost"
                                     : "those of " + std::to_string(names.size()) + " are lost"));
    if (format != nullptr && format->names_written != nullptr)
        warn_of_altered_names(line, *format, parts, names);
    const bool has_parts = std::any_of(parts.begin(), parts.end(), [](int part) { return part != 1; });
    if (format != nullptr && !format->part_ids && has_parts)
        line.warn(line.output().string() + ": " + std::string(format->name) +
                  " carries no part ids; they are lost");
}

/// Part ids from a file of labels: label + 1, as `segment` writes them.
void set_labels(hex::io::SurfaceFile& surface, const std::filesystem::path& path) {
    const std::vector<int> labels = hex::io::read_labels(path);
    if (labels.size() != surface.soup.size())
        throw hex::Error(hex::ErrorKind::bad_input,
                         "holds " + std::to_string(labels.size()) + " labels for " +
                             std::to_string(surface.soup.size()) + " polygons",
                         path.string());
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (labels[f] == INT_MAX)
            throw hex::Error(hex::ErrorKind::bad_input,
                             "label " + std::to_string(labels[f]) + " is too large", path.string());
        surface.soup.parts[f] = labels[f] + 1;
    }
    surface.part_names.clear();
}

/// The part ids of a surface or mesh as labels, one a line: part id - 1.
void write_label_file(const std::filesystem::path& path, std::span<const int> parts) {
    std::vector<int> labels(parts.begin(), parts.end());
    for (int& label : labels) {
        if (label == INT_MIN)
            throw hex::Error(hex::ErrorKind::unsupported, "a part id is too small for a label",
                             path.string());
        --label;
    }
    hex::io::write_labels(path, labels);
}

bool names_label_file(const std::filesystem::path& path) {
    return hex::io::extension_of(path) == ".txt";
}

std::vector<int> parts_of(const hex::HexMesh& mesh) {
    std::vector<int> parts;
    for (const hex::CellId c : mesh.cells()) parts.push_back(mesh.part(c));
    return parts;
}

int convert_spline(const CommandLine& line) {
    for (const char* name : {"labels", "repair"})
        if (line.given(name))
            throw hex::Error(hex::ErrorKind::usage,
                             std::string("--") + name + " is for surfaces; the input is a spline");
    require_cad_for_its_options(line, line.input());
    const auto format = spline_format_of(line.output());
    if (!format)
        throw hex::Error(hex::ErrorKind::usage,
                         "a spline cannot be written as " + hex::io::extension_of(line.output()),
                         line.output().string(), "use .bext, .bxt, .vtu or .json");
    const spline::BezierSpline spline = spline::io::read_bext(line.input());
    write_spline(line.output(), *format, spline, line.context());
    line.info(std::to_string(spline.function_count()) + " control points, " +
              std::to_string(spline.element_count()) + " elements");
    line.write_report({{"content", "spline"},
                       {"control_points", spline.function_count()},
                       {"bezier_elements", spline.element_count()}});
    return 0;
}

int run(CommandLine& line) {
    if (is_bext(line.input())) return convert_spline(line);
    hex::io::MeshFile file = read_input(line);
    line.context().check_cancelled();
    const bool labels_out = names_label_file(line.output());
    if (line.given("labels")) {
        auto* surface = std::get_if<hex::io::SurfaceFile>(&file);
        if (surface == nullptr)
            throw hex::Error(hex::ErrorKind::usage, "--labels is for surfaces; the input holds hexahedra");
        set_labels(*surface, line.get<std::string>("labels"));
    }
    Json repair = nullptr;
    if (auto* surface = std::get_if<hex::io::SurfaceFile>(&file))
        repair = repair_input(line, line.input(), surface->soup);
    else if (line.is_set("repair"))
        throw hex::Error(hex::ErrorKind::usage, "--repair is for surfaces; the input holds hexahedra");
    Json report;
    if (labels_out) {
        const auto* surface = std::get_if<hex::io::SurfaceFile>(&file);
        const auto parts =
            surface != nullptr ? surface->soup.parts : parts_of(std::get<hex::io::HexFile>(file).mesh);
        write_label_file(line.output(), parts);
        report = {{"content", "labels"}, {"labels", parts.size()}};
    } else if (const auto* surface = std::get_if<hex::io::SurfaceFile>(&file)) {
        line.log(surface->diagnostics);
        warn_of_loss(line, surface->soup.parts, surface->part_names);
        hex::io::write_surface(line.output(), surface->soup, surface->part_names);
        report = {{"content", "surface"},
                  {"points", surface->soup.points.size()},
                  {"polygons", surface->soup.size()},
                  {"sharp_edges", surface->sharp_edges.size()},
                  {"repair", repair},
                  {"findings", to_json(surface->diagnostics)}};
        line.info(std::to_string(surface->soup.points.size()) + " points, " +
                  std::to_string(surface->soup.size()) + " polygons");
    } else {
        const auto& hexahedra = std::get<hex::io::HexFile>(file);
        line.log(hexahedra.diagnostics);
        warn_of_loss(line, hexahedra.mesh.parts(), hexahedra.part_names);
        hex::io::Fields fields;
        fields.part_names = hexahedra.part_names;
        hex::io::write_hex_mesh(line.output(), hexahedra.mesh, fields);
        report = {{"content", "hexahedra"},
                  {"points", hexahedra.mesh.vertex_count()},
                  {"hexahedra", hexahedra.mesh.cell_count()},
                  {"findings", to_json(hexahedra.diagnostics)}};
        line.info(std::to_string(hexahedra.mesh.vertex_count()) + " points, " +
                  std::to_string(hexahedra.mesh.cell_count()) + " hexahedra");
    }
    line.write_report(report);
    return 0;
}

const RegisterCommand registered(
    {.name = "convert",
     .order = 80,
     .summary = "any mesh format in, any out that carries the same thing",
     .description = list_of_formats(),
     .sample_runs = {"hexspline convert -i part.stl -o part.k",
                     "hexspline convert -i part_hex.vtk -o part_hex.vtu",
                     "hexspline convert -i part.stl --labels labels.txt -o part_segment.k",
                     "hexspline convert -i part.step -o part.k --features-out part_edges.obj",
                     "hexspline convert -i part.bext -o part.bxt"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
