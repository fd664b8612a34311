/// Sample runs:
///   hexspline run part.stl -o out
///   hexspline run rod.stl --segmentation rod_patches.k --blocks rod_blocks.k -o out
///   hexspline run rod.stl --from improve -o out

#include "hexspline/chain.h"
#include "hexspline/element_size.h"
#include "hexspline/surface_input.h"

namespace cli {
namespace {

void describe(CommandLine& line) {
    line.add_input("triangle surface of the part");
    line.add_output("output folder", true);
    line.add("segmentation", value<std::string>(),
             "the surface cut into four-sided patches (part id = patch)");
    line.add("blocks", value<std::string>(), "hexahedral block structure that fits the patches");
    line.add("from", value<std::string>("STAGE")->default_value("segment"),
             "first stage to run; what comes before is read from the output folder");
    line.add("to", value<std::string>("STAGE")->default_value("spline"), "last stage to run");
    line.add(
        "route", value<std::string>("NAME")->default_value("auto"),
        "how blocks are made when none are given: labelling, voxel, or auto: voxel where labelling gives no "
        "valid mesh");
    describe_repair(line);
    describe_cad_input(line);
    describe_element_size(line);
    line.add("weight,l", value<double>()->default_value(0.1, "0.1"),
             "segment: weight of the boundary-enhanced term; with it the method is hbecvt");
    line.add("improve", value<std::string>("LIST")->default_value("auto"),
             "methods of stage improve, in order, separated by commas; none to leave the mesh as it is");
    line.add("sharp-cosine,t", value<double>()->default_value(0.8, "0.8"),
             "improve, spline: cosine of the angle between normals below which a boundary edge is sharp");
}

const RegisterCommand registered(
    {.name = "run",
     .order = 5,
     .summary = "the whole chain, from the surface to the spline",
     .description = "Writes 1-segment.k, 1-labels.txt, 2-polycube.k, 2-patches.k, 2-blocks.k, 3-map.vtk, "
                    "4-improve.vtk,\n"
                    "5-spline.bext, 5-spline.vtu and report.json into the output folder. Edit any of them "
                    "and go on with\n"
                    "--from.",
     .sample_runs = {"hexspline run part.stl -o out",
                     "hexspline run rod.stl --segmentation rod_patches.k --blocks rod_blocks.k -o out",
                     "hexspline run rod.stl --from improve -o out"},
     .describe = describe,
     .run = [](CommandLine& line) { return Chain(line).run(); }});

}  // namespace
}  // namespace cli
