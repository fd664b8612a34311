/// Sample runs:
///   hexspline segment -i part.stl -o part_segment.k
///   hexspline segment -i rod_tri.k -o rod_initial_write.k -m rod_manual.txt -l 0.1
///   hexspline segment -i part_patches.k -o part_checked.k --from-patches --require

#include "hexspline/command.h"
#include "hexspline/segment_report.h"
#include "hexspline/surface_input.h"

#include <hex/base/error.h>
#include <hex/io/list_file.h>
#include <hex/io/surface_file.h>
#include <hex/segment/segment.h>

#include <algorithm>
#include <map>

namespace cli {
namespace {

void describe(CommandLine& line) {
    line.add_input("closed triangle surface; polygons are triangulated");
    line.add_output("labelled triangles, part id = label + 1");
    line.add("manual,m", value<std::string>(), "labels set by hand: lines `triangle label`, applied last");
    line.add("manual-base", value<int>("0|1")->default_value(0), "what the numbers in -m count from");
    line.add("weight,l", value<double>()->default_value(0.1),
             "weight of hbecvt's boundary-enhanced term, >= 0: more for straighter boundaries");
    line.add("method", value<std::string>("NAME")->default_value("auto"),
             "auto, hbecvt (what -l alone means), cvt, or a plug-in's (hexspline plugins)");
    line.add("attempt", value<int>("0|1|2|3")->default_value(0),
             "auto: other labels, to try when no polycube can be built from the first");
    line.add_switch("align", "auto: turn the part to its best axes; -o holds it turned, the report says how");
    line.add_output_file("labels", "write one label 0..5 = +X -X +Y -Y +Z -Z per triangle as text");
    line.add_switch(
        "from-patches",
        "the part ids of -i are patches made by hand: check them, and make those for triangles of part 0");
    describe_repair(line);
    describe_cad_input(line);
    line.add_switch("require", "exit with 1 when a condition on a polycube segmentation is violated");
}

hex::SegmentOptions options_of(const CommandLine& line) {
    hex::SegmentOptions options;
    // The published command lines give a weight and no method.
    options.method =
        line.given("weight") && !line.given("method") ? "hbecvt" : line.get<std::string>("method");
    options.boundary_weight = line.get<double>("weight");
    options.attempt = line.get<int>("attempt");
    line.require_range("attempt", options.attempt, 0, 3);
    options.align = line.is_set("align");
    const int base = line.get<int>("manual-base");
    line.require_range("manual-base", base, 0, 1);
    if (!line.given("manual")) return options;
    const auto file = line.get<std::string>("manual");
    for (const auto& entry : hex::io::read_overrides(file, base))
        options.manual.push_back({entry.triangle, entry.label, file + ":" + std::to_string(entry.line)});
    return options;
}

void require_no_labelling_options(const CommandLine& line) {
    for (const char* name : {"manual", "manual-base", "weight", "method", "attempt", "align"}) {
        if (line.given(name))
            throw hex::Error(hex::ErrorKind::usage,
                             std::string("--") + name + " has no meaning with --from-patches", {},
                             "leave one of them out");
    }
}

Json report_of(const hex::SegmentResult& result, const hex::SegmentOptions& options) {
    const hex::SegmentReport& report = result.report;
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row)
        rotation.push_back({result.rotation(row, 0), result.rotation(row, 1), result.rotation(row, 2)});
    Json counts = Json::object();
    for (int label = 0; label < 6; ++label)
        counts[hex::label_name(label)] = report.label_counts[static_cast<std::size_t>(label)];
    Json generators = Json::array();
    for (const auto& g : report.generators) generators.push_back({g.x(), g.y(), g.z()});
    Json sweeps = Json::array();
    for (const auto& sweep : report.sweeps)
        sweeps.push_back({{"phase", sweep.phase},
                          {"sweep", sweep.sweep},
                          {"moves", sweep.moves},
                          {"energy", sweep.energy}});
    return {{"method", report.method},
            {"weight", report.sweeps.empty() ? Json(nullptr) : Json(options.boundary_weight)},
            {"label_counts", counts},
            {"charts", report.charts},
            {"boundaries", report.boundaries},
            {"corners", report.corners},
            {"rotation", rotation},
            {"repairs", to_json(report.repairs)},
            {"manual_changes", report.manual_changes},
            {"generators", generators},
            {"sweeps", sweeps},
            {"violations", to_json(report.violations)}};
}

/// One warning for each kind of violation; every single one with -v.
void tell_violations(const CommandLine& line, const hex::Diagnostics& violations) {
    struct Kind {
        std::size_t count = 0;
        std::string first;
    };
    std::map<std::string, Kind> kinds;
    for (const auto& violation : violations) {
        line.info(violation.message);
        if (violation.severity == hex::Severity::note) continue;
        Kind& kind = kinds[violation.code];
        if (kind.count++ == 0) kind.first = violation.message;
    }
    for (const auto& [code, kind] : kinds)
        line.warn(
            code + ": " + kind.first +
            (kind.count > 1 ? " (and " + std::to_string(kind.count - 1) + " more; see -v or --json)" : ""));
}

void tell_summary(const CommandLine& line, const hex::SegmentReport& report) {
    for (const auto& sweep : report.sweeps)
        line.info(sweep.phase + " sweep " + std::to_string(sweep.sweep) + ": " + std::to_string(sweep.moves) +
                  " moves, energy " + std::to_string(sweep.energy));
    for (const auto& repair : report.repairs)
        line.info(repair.repair + " at triangle " + std::to_string(repair.triangle) + " (" + repair.reason +
                  "): " + std::to_string(repair.triangles) + " triangles, cost " +
                  std::to_string(repair.cost));
    std::string counts;
    for (int label = 0; label < 6; ++label)
        counts += std::string(label > 0 ? ", " : "") + hex::label_name(label) + " " +
                  std::to_string(report.label_counts[static_cast<std::size_t>(label)]);
    line.info("triangles: " + counts + "; " + std::to_string(report.manual_changes) + " changed by hand");
    line.info(std::to_string(report.charts) + " charts, " + std::to_string(report.boundaries) +
              " boundaries, " + std::to_string(report.corners) + " corners");
}

/// Patches for the triangles that the user left without one.
hex::CompletedPatches complete(const CommandLine& line, const hex::TriangleMesh& mesh) {
    hex::CompletedPatches completed = hex::complete_patches(mesh, {}, line.context());
    if (completed.triangles > 0)
        line.warn(line.input().string() + ": " + std::to_string(completed.triangles) +
                  " triangles without a patch became " + std::to_string(completed.parts.size()) +
                  " patches, from part id " + std::to_string(completed.parts.front()) + " on");
    return completed;
}

int run(CommandLine& line) {
    const bool from_patches = line.is_set("from-patches");
    if (from_patches) require_no_labelling_options(line);
    const hex::SegmentOptions options = options_of(line);
    const SurfaceInput input = load_surface_input(line, line.input());
    const hex::CompletedPatches completed =
        from_patches ? complete(line, input.mesh) : hex::CompletedPatches{input.mesh, 0, {}};
    const hex::TriangleMesh& mesh = completed.mesh;
    const hex::SegmentResult result =
        from_patches ? hex::segment_from_patches(mesh) : hex::segment(mesh, options, line.context());

    const auto labelled = from_patches
                              ? mesh
                              : hex::with_labels(options.align ? hex::rotated(mesh, result.rotation) : mesh,
                                                 result.segmentation);
    hex::io::write_surface(line.output(), hex::to_soup(labelled));
    if (line.given("labels"))
        hex::io::write_labels(line.get<std::string>("labels"), result.segmentation.labels);
    tell_summary(line, result.report);
    tell_violations(line, result.report.violations);
    Json report = report_of(result, options);
    report["repair"] = input.repair;
    if (from_patches) report["completed"] = {{"triangles", completed.triangles}, {"parts", completed.parts}};
    line.write_report(report);

    const auto violated = hex::count_at_least(result.report.violations, hex::Severity::warning);
    if (line.is_set("require") && violated > 0)
        throw hex::Error(hex::ErrorKind::quality,
                         "the segmentation violates " + std::to_string(violated) +
                             " conditions on a polycube segmentation",
                         line.input().string(), "see -v or --json for every one with its ids");
    return 0;
}

const RegisterCommand registered(
    {.name = "segment",
     .order = 10,
     .summary = "label the triangles of a surface with the six axis directions",
     .description = "Violations of the conditions that a polycube needs are warnings: raw labels normally\n"
                    "still have to be cut into four-sided patches.",
     .sample_runs = {"hexspline segment -i part.stl -o part_segment.k",
                     "hexspline segment -i rod_tri.k -o rod_initial_write.k -m rod_manual.txt -l 0.1",
                     "hexspline segment -i part_patches.k -o part_checked.k --from-patches --require"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
