/// Sample runs:
///   hexspline check part.vtk
///   hexspline check part.vtk --metric scaled_jacobian:0.2 --metric aspect_ratio::10 --bad-share 0.01
///   hexspline check part.vtk --profile ls-dyna --surface part.stl --max-surface-distance 0.5 --json -
///   --junit check.xml

#include "hexspline/check_baseline.h"
#include "hexspline/check_report.h"
#include "hexspline/command.h"
#include "hexspline/inputs.h"
#include "hexspline/spline_file.h"

#include <hex/base/error.h>
#include <hex/io/hex_file.h>
#include <hex/io/mesh_file.h>
#include <hex/io/output_file.h>
#include <spline/io/bext.h>
#include <spline/jacobian.h>

#include <fmt/format.h>

#include <array>
#include <iostream>
#include <string>

namespace cli {
namespace {

using hex::HexMetric;
using Strings = std::vector<std::string>;

void describe(CommandLine& line) {
    line.add_input("hexahedral mesh, or a spline as .bext");
    line.add("min-scaled-jacobian", value<double>("X"), "the same as --metric scaled_jacobian:X");
    line.add(
        "metric", value<Strings>("NAME[:MIN[:MAX]]")->composing(),
        "report a metric, and fail when an element is outside of the limits (repeatable; all = report all)");
    line.add("percentile", value<Strings>("NAME:PCT:MIN[:MAX]")->composing(),
             "fail when this percentile of a metric is outside of the limits (repeatable)");
    line.add("bad-share", value<double>("S"), "share of elements, 0..1, that may be outside of a --metric");
    line.add("profile", value<std::string>("NAME"), "start from the limits of " + profile_names());
    line.add("config", value<std::string>("FILE"), "start from the limits of a configuration file (JSON)");
    line.add("forbid", value<Strings>("KIND,KIND")->composing(),
             "fail for duplicate-nodes, unused-nodes, open-boundary, pinched-nodes, several-components");
    line.add("duplicate-tolerance", value<double>("T")->default_value(1e-9, "1e-9"),
             "nodes nearer than T times the diagonal are at the same place");
    line.add("surface", value<std::string>("FILE"), "measure the distance of the boundary from this surface");
    line.add("max-surface-distance", value<double>("PCT"),
             "fail when that distance is more than PCT percent of the surface's diagonal");
    line.add("baseline", value<std::string>("FILE"),
             "fail when something is worse than in this earlier --json");
    line.add("baseline-tolerance", value<double>("T")->default_value(1e-9, "1e-9"),
             "relative change that is not worse yet");
    line.add("worst", value<int>("N")->default_value(5), "list the N worst elements of each metric");
    line.add_output_file("junit", "write the demands as JUnit XML, - for stdout");
    line.add_output_file("sarif", "write what failed as SARIF 2.1.0, - for stdout");
    line.add_output_file("markdown", "write a summary as Markdown, - for stdout");
    line.add_output_file("vtu", "write the mesh with its metrics as cell data");
}

/// Profile or configuration file first, then the options.
Demands demands_of(const CommandLine& line) {
    if (line.given("profile") && line.given("config"))
        throw hex::Error(hex::ErrorKind::usage, "--profile and --config exclude each other", {},
                         "name the profile in the configuration file");
    Demands demands;
    if (line.given("profile")) demands = profile(line.get<std::string>("profile"));
    if (line.given("config")) demands = read_demands(line.get<std::string>("config"));
    // Several options for one metric hold together; together they replace what there is about it.
    Demands options;
    if (line.given("min-scaled-jacobian")) {
        const double least = line.get<double>("min-scaled-jacobian");
        line.require_range("min-scaled-jacobian", least, -1.0, 1.0);
        options.merge({HexMetric::scaled_jacobian, least, {}, {}, {}});
    }
    for (const std::string& text : line.get_or<Strings>("metric", {}))
        for (const MetricLimit& limit : parse_metric(text)) options.merge(limit);
    for (const std::string& text : line.get_or<Strings>("percentile", {}))
        options.merge(parse_percentile(text));
    demands.replace(options.limits);
    if (line.given("bad-share")) {
        demands.bad_share = line.get<double>("bad-share");
        line.require_range("bad-share", demands.bad_share, 0.0, 1.0);
    }
    for (const std::string& text : line.get_or<Strings>("forbid", {}))
        demands.forbidden.merge(parse_defects(text));
    if (line.given("surface")) demands.surface = line.get<std::string>("surface");
    if (line.given("baseline")) demands.baseline = line.get<std::string>("baseline");
    if (line.given("max-surface-distance")) {
        demands.max_surface_distance = line.get<double>("max-surface-distance");
        line.require_range("max-surface-distance", *demands.max_surface_distance, 0.0, 1e30);
    }
    if (demands.max_surface_distance && !demands.surface)
        throw hex::Error(hex::ErrorKind::usage, "a largest distance is asked for, but there is no --surface");
    return demands;
}

/// What is measured: what the demands need, and a few that everybody wants to see.
std::set<HexMetric> metrics_of(const Demands& demands) {
    std::set<HexMetric> metrics = {HexMetric::scaled_jacobian, HexMetric::shape, HexMetric::skew,
                                   HexMetric::aspect_ratio, HexMetric::volume};
    for (const MetricLimit& limit : demands.limits) metrics.insert(limit.metric);
    return metrics;
}

/// `corners_only`: the mesh is that of the corners of Bezier elements, without shared vertices.
Findings examine(const CommandLine& line, const hex::HexMesh& mesh, const Demands& demands, std::size_t worst,
                 bool corners_only) {
    const hex::Context& context = line.context();
    Findings findings;
    for (const HexMetric metric : metrics_of(demands)) {
        context.check_cancelled();
        Measured& measured = findings.metrics[metric];
        measured.values = hex::evaluate(metric, mesh, context);
        measured.statistics = hex::statistics(measured.values, context);
        measured.worst = hex::worst_cells(measured.values, hex::info(metric).better, worst);
    }
    const auto& scaled = findings.metrics.at(HexMetric::scaled_jacobian).values;
    findings.summary = hex::summarize(mesh, scaled, context);
    for (const hex::CellId c : mesh.cells())
        if (scaled[c.index()] <= 0.0) findings.inverted.push_back(c);
    if (corners_only) return findings;
    findings.defects = hex::find_defects(mesh, line.get<double>("duplicate-tolerance"), context);
    if (demands.surface && !mesh.empty())
        findings.distance = hex::surface_distance(mesh, load_triangles(line, *demands.surface), context);
    return findings;
}

/// The corners of the Bezier elements as hexahedra, each with vertices of its own.
hex::HexMesh corner_mesh(const spline::BezierSpline& spline) {
    const auto bezier = spline::bezier_points(spline);
    std::vector<hex::Vec3> points;
    std::vector<hex::HexCell> cells(spline.element_count());
    for (std::size_t e = 0; e < cells.size(); ++e) {
        for (std::size_t c = 0; c < 8; ++c) {
            cells[e][c] = hex::VertexId(points.size());
            const auto local = static_cast<std::size_t>(hex::hexahedron::bezier_corner[c]);
            points.emplace_back(bezier[spline.elements[e][local]].head<3>());
        }
    }
    return {std::move(points), std::move(cells)};
}

void write_vtu(const std::filesystem::path& file, const Outcome& outcome) {
    hex::io::Fields fields;
    for (const auto& [metric, measured] : outcome.findings.metrics)
        fields.cell.push_back({std::string(hex::info(metric).name), measured.values});
    hex::io::write_hex_mesh(file, outcome.mesh, fields);
}

constexpr std::array<const char*, 4> reports = {"json", "junit", "sarif", "markdown"};

/// The report that goes to stdout, or nullptr. Throws Error{usage} when there are several.
const char* report_to_stdout(const CommandLine& line) {
    const char* found = nullptr;
    for (const char* name : reports) {
        if (line.get_or<std::string>(name, "") != "-") continue;
        if (found != nullptr)
            throw hex::Error(hex::ErrorKind::usage, std::string("--").append(found) + " and --" + name +
                                                        " cannot both go to stdout");
        found = name;
    }
    return found;
}

/// No report may be written over what the configuration file names; options that name the same file are
/// refused before.
void require_nothing_read_is_written(const CommandLine& line, const Demands& demands) {
    for (const char* name : {"json", "junit", "sarif", "markdown", "vtu"}) {
        const auto target = line.get_or<std::string>(name, "-");
        for (const auto& read : {demands.surface, demands.baseline}) {
            std::error_code missing;
            if (target != "-" && read && std::filesystem::equivalent(target, *read, missing))
                throw hex::Error(
                    hex::ErrorKind::usage,
                    std::string("--").append(name) + " and a file to read are the same file " + target);
        }
    }
}

int run(CommandLine& line) {
    const char* to_stdout = report_to_stdout(line);
    line.require_range("worst", line.get<int>("worst"), 0, 1e6);
    line.require_range("duplicate-tolerance", line.get<double>("duplicate-tolerance"), 0.0, 1.0);
    line.require_range("baseline-tolerance", line.get<double>("baseline-tolerance"), 0.0, 1e30);
    const auto worst = static_cast<std::size_t>(line.get<int>("worst"));
    Demands demands = demands_of(line);
    require_nothing_read_is_written(line, demands);
    std::optional<Baseline> baseline;
    if (demands.baseline) {
        baseline.emplace(*demands.baseline);
        for (const HexMetric metric : baseline->metrics()) demands.add({metric, {}, {}, {}, {}});
    }
    hex::HexMesh mesh;
    std::optional<spline::JacobianReport> bezier;
    if (is_bext(line.input())) {
        const spline::BezierSpline spline = spline::io::read_bext(line.input());
        bezier = spline::certify(spline, {}, line.context());
        mesh = corner_mesh(spline);
    } else {
        mesh = load_hexahedra(line, line.input());
    }
    Outcome outcome{line.input().string(), mesh, examine(line, mesh, demands, worst, bezier.has_value()), {}};
    outcome.findings.bezier = std::move(bezier);
    outcome.gates = evaluate_gates(demands, outcome.findings, worst);
    if (baseline) {
        for (Gate& gate : baseline->compare(outcome.findings, line.get<double>("baseline-tolerance"), worst))
            outcome.gates.push_back(std::move(gate));
        if (const std::string left = baseline->not_compared(outcome.findings); !left.empty())
            line.warn("of the baseline " + demands.baseline->string() + " is not compared: " + left);
    }

    if (to_stdout == nullptr) std::cout << table_text(outcome);
    line.write_report(report_json(outcome));
    const auto write = [&](const char* name, std::string (*text)(const Outcome&)) {
        if (!line.given(name)) return;
        const auto target = line.get<std::string>(name);
        if (target == "-")
            std::cout << text(outcome) << std::flush;
        else
            hex::io::write_file(target, text(outcome));
    };
    write("junit", junit_text);
    write("sarif", sarif_text);
    write("markdown", markdown_text);
    if (line.given("vtu")) write_vtu(line.get<std::string>("vtu"), outcome);
    if (outcome.passed()) return 0;

    const auto failed = std::find_if(outcome.gates.begin(), outcome.gates.end(),
                                     [](const Gate& gate) { return !gate.passed; });
    std::string what = failed->name + ": asked for is " + failed->demand + ", found " + failed->found;
    if (!failed->cells.empty()) {
        std::vector<std::int64_t> list;
        for (const hex::CellId c : failed->cells) list.push_back(c.value());
        what += ", worst hexahedra " + hex::list_ids(list, 5);
    }
    if (const std::size_t more = outcome.failed_gates() - 1; more > 0)
        what += fmt::format(" (and {} more demand{})", more, more == 1 ? "" : "s");
    throw hex::Error(hex::ErrorKind::quality, what, outcome.input);
}

const RegisterCommand registered(
    {.name = "check",
     .order = 60,
     .summary = "measure a hexahedral mesh and fail when it is not good enough",
     .description = "Without a minimum for the scaled Jacobian, an inverted element fails.\n"
                    "Of a spline, the Jacobian of every Bezier element has to be proved positive.\n"
                    "Exit code 0: good; 1: not as good as asked for.",
     .sample_runs =
         {"hexspline check part.vtk",
          "hexspline check part.vtk --metric scaled_jacobian:0.2 --metric aspect_ratio::10 --bad-share 0.01",
          "hexspline check part.vtk --profile ls-dyna --surface part.stl --max-surface-distance 0.5 "
          "--json - --junit check.xml"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
