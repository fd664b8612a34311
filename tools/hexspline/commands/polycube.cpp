/// Sample runs:
///   hexspline polycube -i part_patches.k -o part_polycube.k
///   hexspline polycube -i rod_initial_read.k -o rod_polycube_structure.k -c 1
///   hexspline polycube -i part_segment.k --patches part_patches.k --blocks part_blocks.k
///   hexspline polycube -i part.stl --method voxel --blocks part_cells.vtk

#include "hexspline/command.h"
#include "hexspline/inputs.h"

#include <hex/base/error.h>
#include <hex/io/hex_file.h>
#include <hex/io/list_file.h>
#include <hex/io/surface_file.h>
#include <hex/polycube/blocks.h>
#include <hex/polycube/polycube.h>
#include <hex/polycube/voxel.h>

namespace cli {
namespace {

void describe(CommandLine& line) {
    line.add_input("triangles whose part ids are patches, or labels + 1 for --patches and --blocks");
    line.add_output("polycube surface: one quad per patch", false);
    line.add_output_file(
        "patches", "write the triangles cut into four-sided patches, made from labels; part id = patch");
    line.add_output_file("blocks", "write the hexahedral blocks of those patches, made from labels");
    line.add(
        "unit", value<double>("H")->default_value(0.0),
        "length of one unit of the integer polycube, for --patches and --blocks; of voxel the cell size; 0: "
        "from the volume");
    line.add("corner-files,c", value<int>("0|1")->default_value(0),
             "1 writes NAME_corner.txt, NAME_edge.txt and NAME_face.txt beside the output NAME");
    line.add("method", value<std::string>("NAME")->default_value("patches"),
             "patches; voxel (--blocks are the cells of a grid, for any closed surface); or a plug-in's "
             "(hexspline plugins)");
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

Json report_of(const hex::BlocksReport& report) {
    return {{"bodies", report.bodies},
            {"turned_shells", report.turned_shells},
            {"charts", report.charts},
            {"sides", report.sides},
            {"polycube_corners", report.corners},
            {"orders", report.orders},
            {"turned_sides", report.turned_sides},
            {"rounds", report.rounds},
            {"planes", report.planes},
            {"cells", report.cells},
            {"blocks", report.blocks},
            {"patches", report.patches},
            {"lines_cut_alone", report.cut_alone},
            {"slides", report.slides},
            {"unit", report.unit},
            {"min_scaled_jacobian", report.min_scaled_jacobian},
            {"inverted_corners", report.inverted_corners},
            {"violations", to_json(report.violations)}};
}

void write_quads(const CommandLine& line, const hex::PolycubeResult& result, const Json& report) {
    const hex::Polycube& cube = result.polycube;
    line.log(result.report.violations, line.input().string());
    const auto wrong = hex::count_at_least(result.report.violations, hex::Severity::error);
    if (wrong > 0) {
        line.write_report(report);
        throw hex::Error(hex::ErrorKind::no_result,
                         "the patches form no polycube surface: " + std::to_string(wrong) + " violations, " +
                             std::to_string(result.report.invalid_patches) + " of " +
                             std::to_string(result.report.patches) + " patches are not four-sided",
                         line.input().string(), "cut the surface into patches with four corners each");
    }
    if (!line.given("output")) return;
    hex::io::write_surface(line.output(), hex::polycube_surface(cube));
    if (line.get<int>("corner-files") == 1) {
        hex::io::write_corner_list(list_file(line, "corner"), cube.corners, cube.corner_points);
        hex::io::write_edge_list(list_file(line, "edge"), cube.edges);
        hex::io::write_face_list(list_file(line, "face"), cube.quads);
    }
}

/// The blocks of a labelled surface; of a patched one the labels are what its patches face.
hex::BlocksResult blocks_of(CommandLine& line, const hex::TriangleMesh& mesh) {
    hex::Segmentation segmentation{hex::labels_of_parts(mesh)};
    if (segmentation.labels.empty()) {
        line.info("the part ids are no labels: every patch is labelled with the axis that it faces");
        segmentation = hex::segment_from_patches(mesh).segmentation;
    }
    hex::BlocksOptions options;
    options.unit = line.get<double>("unit");
    hex::BlocksResult result = hex::make_blocks(mesh, segmentation, options, line.context());
    line.log(result.report.violations, line.input().string());
    const auto wrong = hex::count_at_least(result.report.violations, hex::Severity::error);
    if (wrong > 0) {
        line.write_report({{"method", "labels"}, {"block_structure", report_of(result.report)}});
        throw hex::Error(hex::ErrorKind::no_result,
                         "the labels describe no polycube: " + std::to_string(wrong) + " violations",
                         line.input().string(), "mend the labels (`segment`)");
    }
    line.info(std::to_string(result.report.charts) + " charts, " + std::to_string(result.report.blocks) +
              " blocks, " + std::to_string(result.report.patches) + " patches");
    return result;
}

int run_from_labels(CommandLine& line) {
    const hex::TriangleMesh mesh = load_triangles(line, line.input());
    const hex::BlocksResult made = blocks_of(line, mesh);
    const hex::PolycubeResult surface = hex::polycube(made.patches, {}, line.context());
    Json report = report_of(surface);
    report["block_structure"] = report_of(made.report);
    if (line.given("patches"))
        hex::io::write_surface(line.get<std::string>("patches"), hex::to_soup(made.patches));
    if (line.given("blocks")) hex::io::write_hex_mesh(line.get<std::string>("blocks"), made.blocks);
    write_quads(line, surface, report);
    line.write_report(report);
    return 0;
}

int run_voxel(CommandLine& line) {
    if (!line.given("blocks") || line.given("patches") || line.given("output"))
        throw hex::Error(hex::ErrorKind::usage, "method voxel makes cells only", {},
                         "give --blocks, and neither --patches nor -o");
    hex::VoxelOptions options;
    options.cell_size = line.get<double>("unit");
    const hex::TriangleMesh mesh = load_triangles(line, line.input());
    const hex::VoxelResult result = hex::voxel_blocks(mesh, options, line.context());
    const hex::VoxelReport& report = result.report;
    hex::io::write_hex_mesh(line.get<std::string>("blocks"), result.cells);
    line.info(std::to_string(report.cells) + " cells, " + std::to_string(report.bodies) + " bodies");
    line.write_report({{"method", "voxel"},
                       {"grid", report.grid},
                       {"cell_size", report.cell_size},
                       {"planes_on_flat_faces", report.planes},
                       {"cells", report.cells},
                       {"grids_tried", report.tries},
                       {"cells_changed_for_a_manifold", report.repairs},
                       {"specks", report.specks},
                       {"cells_added_along_thin_parts", report.grown},
                       {"cells_removed_along_thin_gaps", report.carved},
                       {"distance", report.distance},
                       {"bodies", report.bodies},
                       {"surfaces", report.surfaces},
                       {"euler_characteristic", report.euler_characteristic}});
    return 0;
}

int run(CommandLine& line) {
    if (line.get<std::string>("method") == "voxel") return run_voxel(line);
    line.require_range("corner-files", line.get<int>("corner-files"), 0, 1);
    const bool from_labels = line.given("patches") || line.given("blocks");
    if (!from_labels && !line.given("output"))
        throw hex::Error(hex::ErrorKind::usage, "nothing to write: give -o, --patches or --blocks");
    if (line.get<int>("corner-files") == 1 && !line.given("output"))
        throw hex::Error(hex::ErrorKind::usage, "-c 1 writes beside -o, which is missing");
    if (from_labels) return run_from_labels(line);

    hex::PolycubeOptions options;
    options.method = line.get<std::string>("method");
    const hex::TriangleMesh mesh = load_triangles(line, line.input());
    const hex::PolycubeResult result = hex::polycube(mesh, options, line.context());
    write_quads(line, result, report_of(result));
    line.info(std::to_string(result.report.patches) + " patches, " + std::to_string(result.report.corners) +
              " corners");
    line.write_report(report_of(result));
    return 0;
}

const RegisterCommand registered(
    {.name = "polycube",
     .order = 20,
     .summary = "make the polycube surface of four-sided patches, or patches and blocks of labels",
     .description =
         "A patch is a connected component of triangles of equal part id. When a patch is not a disk\n"
         "with four corners, every one is named, nothing is written, and the exit code is 4.\n"
         "With --patches or --blocks the part ids are labels (`segment`): the polycube is made from them,\n"
         "filled with blocks, and the triangles are cut into one four-sided patch for each quad of the "
         "blocks.",
     .sample_runs = {"hexspline polycube -i part_patches.k -o part_polycube.k",
                     "hexspline polycube -i rod_initial_read.k -o rod_polycube_structure.k -c 1",
                     "hexspline polycube -i part_segment.k --patches part_patches.k --blocks part_blocks.k",
                     "hexspline polycube -i part.stl --method voxel --blocks part_cells.vtk"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
