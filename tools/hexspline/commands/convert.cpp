/// Sample runs:
///   hexspline convert -i part.stl -o part.k
///   hexspline convert -i part_hex.vtk -o part_hex.vtu

#include "hexspline/command.h"

#include <hex/io/mesh_file.h>

#include <algorithm>

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
    return list + "A file of hexahedra is written as hexahedra, any other as a surface.";
}

void describe(CommandLine& line) {
    line.add_input("surface or hexahedral mesh");
    line.add_output("the same in the format of this file's extension");
}

/// Says what the new format drops.
void warn_of_loss(const CommandLine& line, std::span<const int> parts) {
    const auto* format = hex::io::find_format(line.output());
    const bool has_parts = std::any_of(parts.begin(), parts.end(), [](int part) { return part != 1; });
    if (format != nullptr && !format->part_ids && has_parts)
        line.warn(line.output().string() + ": " + std::string(format->name) +
                  " carries no part ids; they are lost");
}

int run(CommandLine& line) {
    const hex::io::MeshFile file = hex::io::read_mesh_file(line.input());
    Json report;
    if (const auto* surface = std::get_if<hex::io::SurfaceFile>(&file)) {
        line.log(surface->diagnostics);
        warn_of_loss(line, surface->soup.parts);
        hex::io::write_surface(line.output(), surface->soup);
        report = {{"content", "surface"},
                  {"points", surface->soup.points.size()},
                  {"polygons", surface->soup.size()},
                  {"findings", to_json(surface->diagnostics)}};
        line.info(std::to_string(surface->soup.points.size()) + " points, " +
                  std::to_string(surface->soup.size()) + " polygons");
    } else {
        const auto& hexahedra = std::get<hex::io::HexFile>(file);
        line.log(hexahedra.diagnostics);
        hex::io::write_hex_mesh(line.output(), hexahedra.mesh);
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

const RegisterCommand registered({.name = "convert",
                                  .order = 80,
                                  .summary = "any mesh format in, any out that carries the same thing",
                                  .description = list_of_formats(),
                                  .sample_runs = {"hexspline convert -i part.stl -o part.k",
                                                  "hexspline convert -i part_hex.vtk -o part_hex.vtu"},
                                  .describe = describe,
                                  .run = run});

}  // namespace
}  // namespace cli
