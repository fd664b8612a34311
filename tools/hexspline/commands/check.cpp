/// Sample runs:
///   hexspline check part.vtk
///   hexspline check -i part.vtk --min-scaled-jacobian 0.3 --json -

#include "hexspline/command.h"
#include "hexspline/inputs.h"

#include <hex/base/error.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/volume/topology.h>

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <string>

namespace cli {
namespace {

struct Findings {
    hex::QualitySummary summary;
    std::vector<std::int64_t> inverted;  ///< cells with a scaled Jacobian <= 0
    hex::Diagnostics diagnostics;
};

void describe(CommandLine& line) {
    line.add_input("hexahedral mesh");
    line.add("min-scaled-jacobian", value<double>("X"),
             "exit with 1 when a scaled Jacobian is below X (without it: when one is not positive)");
}

Findings examine(const hex::HexMesh& mesh, const hex::Context& context) {
    Findings findings;
    const std::vector<double> values = hex::scaled_jacobians(mesh, context);
    findings.summary = hex::summarize(mesh, values, context);
    for (std::size_t c = 0; c < values.size(); ++c)
        if (values[c] <= 0.0) findings.inverted.push_back(static_cast<std::int64_t>(c));
    findings.diagnostics = hex::inspect(mesh);
    return findings;
}

/// Ten lines of two bins each, with a bar of up to 50 characters.
std::string histogram_text(const hex::QualitySummary& summary) {
    const auto& bins = summary.histogram;
    const std::size_t largest = std::max<std::size_t>(1, *std::max_element(bins.begin(), bins.end()));
    std::size_t first = 0;
    while (first + 1 < bins.size() && bins[first] == 0) ++first;
    std::string text;
    for (std::size_t i = first; i < bins.size(); ++i) {
        const double lower = -1.0 + 2.0 * static_cast<double>(i) / static_cast<double>(bins.size());
        const std::string bar(bins[i] == 0 ? 0 : 1 + bins[i] * 49 / largest, '#');
        text += fmt::format("  {:4.1f} .. {:4.1f} {:>9}  {}\n", lower, lower + 0.1, bins[i], bar);
    }
    return text;
}

void print_table(const Findings& findings) {
    const hex::QualitySummary& summary = findings.summary;
    std::string text;
    text += fmt::format("vertices              {}\n", summary.vertices);
    text += fmt::format("hexahedra             {}\n", summary.cells);
    if (summary.cells > 0) {
        text += fmt::format("min scaled Jacobian   {:.6g}  (hexahedron {})\n", summary.min,
                            summary.worst.value());
        text += fmt::format("mean scaled Jacobian  {:.6g}\n", summary.mean);
    }
    text += fmt::format("inverted              {}", summary.inverted);
    if (!findings.inverted.empty()) text += "  (" + hex::list_ids(findings.inverted) + ")";
    text += "\nhistogram of the scaled Jacobian\n" + histogram_text(summary);
    for (const auto& finding : findings.diagnostics) text += "note: " + finding.message + "\n";
    std::cout << text;
}

Json report_of(const Findings& findings) {
    const hex::QualitySummary& summary = findings.summary;
    Json worst = nullptr;
    if (summary.worst.valid()) worst = summary.worst.value();
    return {{"vertices", summary.vertices},
            {"hexes", summary.cells},
            {"min_scaled_jacobian", summary.min},
            {"mean_scaled_jacobian", summary.mean},
            {"worst", worst},
            {"inverted", summary.inverted},
            {"inverted_ids", findings.inverted},
            {"histogram", summary.histogram},
            {"diagnostics", to_json(findings.diagnostics)}};
}

int run(CommandLine& line) {
    const bool gate = line.given("min-scaled-jacobian");
    const double least = line.get_or<double>("min-scaled-jacobian", 0.0);
    if (gate) line.require_range("min-scaled-jacobian", least, -1.0, 1.0);
    const hex::HexMesh mesh = load_hexahedra(line, line.input());
    const Findings findings = examine(mesh, line.context());
    const bool passed = gate ? findings.summary.min >= least || mesh.empty() : findings.summary.inverted == 0;

    if (line.get_or<std::string>("json", "") != "-") print_table(findings);
    Json report = report_of(findings);
    report["passed"] = passed;
    line.write_report(report);
    if (passed) return 0;
    if (!gate)
        throw hex::Error(hex::ErrorKind::quality,
                         fmt::format("{} hexahedra are inverted: {}", findings.summary.inverted,
                                     hex::list_ids(findings.inverted)),
                         line.input().string(),
                         "improve the mesh, or set --min-scaled-jacobian below the minimum");
    throw hex::Error(hex::ErrorKind::quality,
                     fmt::format("the smallest scaled Jacobian is {:.6g} (hexahedron {}), asked for is {:g}",
                                 findings.summary.min, findings.summary.worst.value(), least),
                     line.input().string());
}

const RegisterCommand registered(
    {.name = "check",
     .order = 60,
     .summary = "measure a hexahedral mesh and fail when it is not good enough",
     .description = "Exit code 0: good; 1: not as good as asked for.",
     .sample_runs = {"hexspline check part.vtk",
                     "hexspline check -i part.vtk --min-scaled-jacobian 0.3 --json -"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
