/// Sample runs:
///   hexspline polycube -i part_patches.k -o part_polycube.k
///   hexspline polycube -i rod_initial_read.k -o rod_polycube_structure.k -c 1

#include "hexspline/command.h"
#include "hexspline/inputs.h"

#include <hex/base/error.h>
#include <hex/io/list_file.h>
#include <hex/io/surface_file.h>
#include <hex/polycube/polycube.h>

namespace cli {
namespace {

void describe(CommandLine& line) {
    line.add_input("triangles whose part ids are patches");
    line.add_output("polycube surface: one quad per patch");
    line.add("corner-files,c", value<int>("0|1")->default_value(0),
             "1 writes NAME_corner.txt, NAME_edge.txt and NAME_face.txt beside the output NAME");
    line.add("method", value<std::string>("NAME")->default_value("patches"),
             "patches, or a plug-in's (hexspline plugins)");
}

Json report_of(const hex::PolycubeResult& result) {
    Json patches = Json::array();
    for (const auto& patch : result.polycube.layout.patches) {
        Json entry = {
            {"part", patch.part}, {"triangles", patch.triangles.size()}, {"four_sided", patch.four_sided}};
        entry["corners"] = patch.four_sided ? Json(patch.corners) : Json(nullptr);
        patches.push_back(std::move(entry));
    }
    return {{"method", result.report.method},
            {"patches", result.report.patches},
            {"corners", result.report.corners},
            {"invalid_patches", result.report.invalid_patches},
            {"patch_list", patches},
            {"violations", to_json(result.report.violations)}};
}

/// NAME_what.txt beside the output NAME.k.
std::filesystem::path list_file(const CommandLine& line, const std::string& what) {
    return line.output().parent_path() / (line.output().stem().string() + "_" + what + ".txt");
}

int run(CommandLine& line) {
    line.require_range("corner-files", line.get<int>("corner-files"), 0, 1);
    hex::PolycubeOptions options;
    options.method = line.get<std::string>("method");
    const hex::TriangleMesh mesh = load_triangles(line, line.input());
    const hex::PolycubeResult result = hex::polycube(mesh, options, line.context());
    const hex::Polycube& cube = result.polycube;

    line.log(result.report.violations, line.input().string());
    const auto wrong = hex::count_at_least(result.report.violations, hex::Severity::error);
    if (wrong > 0) {
        line.write_report(report_of(result));
        throw hex::Error(hex::ErrorKind::no_result,
                         "the patches form no polycube surface: " + std::to_string(wrong) + " violations, " +
                             std::to_string(result.report.invalid_patches) + " of " +
                             std::to_string(result.report.patches) + " patches are not four-sided",
                         line.input().string(), "cut the surface into patches with four corners each");
    }

    hex::io::write_surface(line.output(), hex::polycube_surface(cube));
    if (line.get<int>("corner-files") == 1) {
        hex::io::write_corner_list(list_file(line, "corner"), cube.corners, cube.corner_points);
        hex::io::write_edge_list(list_file(line, "edge"), cube.edges);
        hex::io::write_face_list(list_file(line, "face"), cube.quads);
    }
    line.info(std::to_string(result.report.patches) + " patches, " + std::to_string(result.report.corners) +
              " corners");
    line.write_report(report_of(result));
    return 0;
}

const RegisterCommand registered(
    {.name = "polycube",
     .order = 20,
     .summary = "make the polycube surface of a surface cut into four-sided patches",
     .description =
         "A patch is a connected component of triangles of equal part id. When a patch is not a disk\n"
         "with four corners, every one is named, nothing is written, and the exit code is 4.",
     .sample_runs = {"hexspline polycube -i part_patches.k -o part_polycube.k",
                     "hexspline polycube -i rod_initial_read.k -o rod_polycube_structure.k -c 1"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
