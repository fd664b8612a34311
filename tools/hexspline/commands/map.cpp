/// Sample runs:
///   hexspline map -i part_patches.k -p part_blocks.k -o part_hex.vtk
///   hexspline map -i rod_initial_read.k -p rod_polycube_structure_hex.k -s 2 -o rod_hex.vtk
///   hexspline map -i part_patches.k -p part_blocks.k --target-hexes 20000 -o part_hex.vtk

#include "hexspline/command.h"
#include "hexspline/element_size.h"
#include "hexspline/inputs.h"

#include <hex/base/error.h>
#include <hex/io/hex_file.h>
#include <hex/io/surface_file.h>
#include <hex/map/map.h>
#include <hex/quality/scaled_jacobian.h>

#include <fmt/format.h>

#include <optional>

namespace cli {
namespace {

void describe(CommandLine& line) {
    line.add_input("triangles whose part ids are four-sided patches");
    line.add_output("hexahedral mesh; part id = index of the block + 1");
    line.add("blocks,p", value<std::string>()->required(),
             "hexahedral block structure, one boundary quad a patch, its corners on the patch corners");
    describe_element_size(line);
    line.add("method", value<std::string>("NAME")->default_value(hex::MapOptions().method),
             "patchwise, or a plug-in's (hexspline plugins)");
}

/// Faces of a file that holds no hexahedra but a surface; none when it cannot be read as one.
std::optional<std::size_t> surface_faces(const std::filesystem::path& path) {
    try {
        return hex::io::read_surface(path).soup.size();
    } catch (const hex::Error&) {
        return std::nullopt;
    }
}

/// The paper's own command line names the polycube's quads where the hexahedra are meant.
hex::HexMesh load_blocks(const CommandLine& line, const std::filesystem::path& path) {
    try {
        return load_hexahedra(line, path);
    } catch (const hex::Error& error) {
        if (error.kind() != hex::ErrorKind::bad_input && error.kind() != hex::ErrorKind::unsupported) throw;
        const auto faces = surface_faces(path);
        if (!faces || *faces == 0) throw;
        throw hex::Error(
            hex::ErrorKind::bad_input,
            fmt::format("has {} quads or triangles, but -p needs hexahedral blocks", *faces), path.string(),
            "give the block structure, a file like rod_polycube_structure_hex.k, not the polycube surface");
    }
}

Json report_of(const hex::MapResult& result, const hex::QualitySummary& quality,
               const hex::MapOptions& options) {
    Json patches = Json::array();
    for (const auto& record : result.report.patch_maps)
        patches.push_back({{"patch", record.patch},
                           {"part", record.part},
                           {"weights", record.weights},
                           {"flipped", record.flipped},
                           {"split_edges", record.split_edges}});
    return {{"method", result.report.method},
            {"level", result.report.edge_length > 0 ? Json(nullptr) : Json(options.level)},
            {"edge_length", result.report.edge_length > 0 ? Json(result.report.edge_length) : Json(nullptr)},
            {"divisions", result.report.divisions},
            {"interior", hex::name_of(options.interior)},
            {"held_back_nodes", result.report.held_back_nodes},
            {"patches", result.report.patches},
            {"blocks", result.report.blocks},
            {"vertices", quality.vertices},
            {"hexes", quality.cells},
            {"min_scaled_jacobian", quality.min},
            {"mean_scaled_jacobian", quality.mean},
            {"inverted", quality.inverted},
            {"largest_snap", result.report.largest_snap},
            {"patch_maps", patches},
            {"diagnostics", to_json(result.report.diagnostics)}};
}

int run(CommandLine& line) {
    hex::MapOptions options = element_size(line);
    options.method = line.get<std::string>("method");
    const std::filesystem::path blocks_file = line.get<std::string>("blocks");
    const hex::TriangleMesh surface = load_triangles(line, line.input());
    const hex::HexMesh blocks = load_blocks(line, blocks_file);

    hex::MapResult result;
    try {
        result = hex::map(surface, blocks, options, line.context());
    } catch (const hex::Error& error) {
        if (error.kind() != hex::ErrorKind::bad_input) throw;
        throw error.located(line.input().string() + " with " + blocks_file.string());
    }
    line.log(result.report.diagnostics, blocks_file.string());

    hex::io::write_hex_mesh(line.output(), result.mesh);
    const hex::QualitySummary quality = hex::summarize(result.mesh, line.context());
    line.info(fmt::format("{} vertices, {} hexahedra, scaled Jacobian at least {:.3f}, {:.3f} on average",
                          quality.vertices, quality.cells, quality.min, quality.mean));
    if (quality.inverted > 0)
        line.warn(
            fmt::format("{} of {} hexahedra are inverted (scaled Jacobian <= 0); improve the mesh before use",
                        quality.inverted, quality.cells));
    line.write_report(report_of(result, quality, options));
    return 0;
}

const RegisterCommand registered(
    {.name = "map",
     .order = 30,
     .summary = "fill a block structure with hexahedra that follow a surface of four-sided patches",
     .description =
         "Each boundary quad of the blocks is paired with the patch that has its four corners. Patches are\n"
         "mapped harmonically, blocks filled as --interior says. A patch without a quad, a quad\n"
         "without a patch or a patch that is not four-sided is named, and the exit code is 3.",
     .sample_runs =
         {"hexspline map -i part_patches.k -p part_blocks.k -o part_hex.vtk",
          "hexspline map -i rod_initial_read.k -p rod_polycube_structure_hex.k -s 2 -o rod_hex.vtk",
          "hexspline map -i part_patches.k -p part_blocks.k --target-hexes 20000 -o part_hex.vtk"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
