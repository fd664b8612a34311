#include "hexspline/check_report.h"

#include "hexspline/report_text.h"

#include <hex/base/version.h>

#include <fmt/format.h>

#include <algorithm>

namespace cli {
namespace {

using hex::CellId;

constexpr std::size_t most_ids = 1000;  // in a list of a report

hex::Vec3 centre_of(const hex::HexMesh& mesh, CellId cell) {
    hex::Vec3 sum = hex::Vec3::Zero();
    for (const hex::Vec3& corner : mesh.corner_positions(cell)) sum += corner;
    return sum / 8.0;
}

Json point(const hex::Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

template <class Id>
Json ids(const std::vector<Id>& list) {
    Json result = Json::array();
    for (std::size_t i = 0; i < std::min(most_ids, list.size()); ++i) result.push_back(list[i].value());
    return result;
}

template <class Id>
Json pairs(const std::vector<std::array<Id, 2>>& list) {
    Json result = Json::array();
    for (std::size_t i = 0; i < std::min(most_ids, list.size()); ++i)
        result.push_back({list[i][0].value(), list[i][1].value()});
    return result;
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

std::string metrics_text(const Findings& findings) {
    std::string text = fmt::format("{:<24}{:>12} {:>12} {:>12} {:>12}  {}\n", "metric", "min", "mean",
                                   "median", "max", "worst hexahedra");
    for (const auto& [metric, measured] : findings.metrics) {
        const auto& s = measured.statistics;
        std::string worst;
        for (std::size_t i = 0; i < std::min<std::size_t>(5, measured.worst.size()); ++i)
            worst.append(i == 0 ? "" : ", ").append(std::to_string(measured.worst[i].value()));
        text += fmt::format("  {:<22}{:>12.6g} {:>12.6g} {:>12.6g} {:>12.6g}  {}\n", hex::info(metric).name,
                            s.min, s.mean, s.median, s.max, worst);
    }
    return text;
}

std::string defects_text(const hex::MeshDefects& defects) {
    std::string text = std::string("boundary              ") +
                       (defects.watertight() ? "watertight\n"
                                             : fmt::format("not watertight: {} open edges, {} cracks\n",
                                                           defects.open_edges.size(), defects.cracks.size()));
    text += fmt::format("duplicate nodes       {}", defects.duplicates.size());
    std::vector<std::int64_t> list;
    for (const auto& pair : defects.duplicates) list.push_back(pair[0].value());
    if (!list.empty()) text += "  (" + hex::list_ids(list) + ")";
    text += fmt::format("\nunused nodes          {}", defects.unused.size());
    list.clear();
    for (const auto v : defects.unused) list.push_back(v.value());
    if (!list.empty()) text += "  (" + hex::list_ids(list) + ")";
    text += '\n';
    for (const auto& finding : defects.topology) text += "note: " + finding.message + "\n";
    return text;
}

std::string gate_line(const Gate& gate) {
    return gate.name + ": " + gate.demand + "; found: " + gate.found;
}

/// Build servers demand a region; the elements of a mesh are told by the logical location.
Json location(const Outcome& outcome) {
    return {{"physicalLocation",
             {{"artifactLocation", {{"uri", uri_of(outcome.input)}}}, {"region", {{"startLine", 1}}}}}};
}

}  // namespace

bool Outcome::passed() const {
    return failed_gates() == 0;
}

std::size_t Outcome::failed_gates() const {
    return static_cast<std::size_t>(
        std::count_if(gates.begin(), gates.end(), [](const Gate& gate) { return !gate.passed; }));
}

std::string table_text(const Outcome& outcome) {
    const Findings& findings = outcome.findings;
    const hex::QualitySummary& summary = findings.summary;
    std::string text;
    text += fmt::format("vertices              {}\n", summary.vertices);
    text += fmt::format("hexahedra             {}\n", summary.cells);
    if (summary.cells > 0) {
        text += fmt::format("min scaled Jacobian   {:.6g}  (hexahedron {})\n", summary.min,
                            summary.worst.value());
        text += fmt::format("mean scaled Jacobian  {:.6g}\n", summary.mean);
    }
    text += fmt::format("inverted              {}\n", summary.inverted);
    for (std::size_t i = 0; i < std::min<std::size_t>(8, findings.inverted.size()); ++i) {
        const hex::Vec3 centre = centre_of(outcome.mesh, findings.inverted[i]);
        text += fmt::format("  hexahedron {} at ({:.6g}, {:.6g}, {:.6g})\n", findings.inverted[i].value(),
                            centre.x(), centre.y(), centre.z());
    }
    if (findings.inverted.size() > 8) text += fmt::format("  ... ({} in all)\n", findings.inverted.size());
    if (const auto& b = findings.bezier) {
        text += fmt::format(
            "Bezier elements       {}: Jacobian proved positive for {}, negative in {}, undecided for {}\n",
            b->elements.size(), b->positive, b->negative.size(), b->undecided.size());
        if (!b->negative.empty()) text += "  " + spline::describe_negative(*b) + "\n";
    } else {
        text += defects_text(findings.defects);
    }
    if (const auto& d = findings.distance) {
        text += fmt::format("distance to surface   largest {:.4g} %, mean {:.4g} % of its diagonal\n",
                            d->percent(d->to_surface_max), d->percent(d->to_surface_mean));
        text += fmt::format("distance from surface largest {:.4g} %, mean {:.4g} %\n",
                            d->percent(d->from_surface_max), d->percent(d->from_surface_mean));
    }
    text += metrics_text(findings);
    text += "histogram of the scaled Jacobian\n" + histogram_text(summary);
    for (const Gate& gate : outcome.gates)
        text += std::string(gate.passed ? "passed  " : "FAILED  ") + gate_line(gate) + "\n";
    return text;
}

Json report_json(const Outcome& outcome) {
    const Findings& findings = outcome.findings;
    const hex::QualitySummary& summary = findings.summary;
    Json worst = nullptr;
    if (summary.worst.valid()) worst = summary.worst.value();
    Json report = {{"vertices", summary.vertices},
                   {"hexes", summary.cells},
                   {"min_scaled_jacobian", summary.min},
                   {"mean_scaled_jacobian", summary.mean},
                   {"worst", worst},
                   {"inverted", summary.inverted},
                   {"inverted_ids", ids(findings.inverted)},
                   {"histogram", summary.histogram}};
    Json inverted = Json::array();
    for (std::size_t i = 0; i < std::min(most_ids, findings.inverted.size()); ++i)
        inverted.push_back({{"id", findings.inverted[i].value()},
                            {"centre", point(centre_of(outcome.mesh, findings.inverted[i]))}});
    report["inverted_elements"] = inverted;
    Json metrics = Json::object();
    for (const auto& [metric, measured] : findings.metrics) {
        const auto& s = measured.statistics;
        Json elements = Json::array();
        for (const CellId c : measured.worst)
            elements.push_back({{"id", c.value()},
                                {"value", measured.values[c.index()]},
                                {"centre", point(centre_of(outcome.mesh, c))}});
        metrics[std::string(hex::info(metric).name)] = {{"min", s.min},
                                                        {"mean", s.mean},
                                                        {"max", s.max},
                                                        {"median", s.median},
                                                        {"percentile_1", s.percentile_1},
                                                        {"percentile_5", s.percentile_5},
                                                        {"percentile_95", s.percentile_95},
                                                        {"percentile_99", s.percentile_99},
                                                        {"worst", elements}};
    }
    report["metrics"] = metrics;
    const hex::MeshDefects& defects = findings.defects;
    Json cracks = Json::array();
    for (std::size_t i = 0; i < std::min(most_ids, defects.cracks.size()); ++i)
        cracks.push_back({hex::HexMesh::cell_of(defects.cracks[i][0]).value(),
                          hex::HexMesh::cell_of(defects.cracks[i][1]).value()});
    report["boundary"] = {{"watertight", defects.watertight()},
                          {"open_edges", defects.open_edges.size()},
                          {"open_edge_vertices", pairs(defects.open_edges)},
                          {"cracks", defects.cracks.size()},
                          {"crack_elements", cracks}};
    report["nodes"] = {{"duplicate", defects.duplicates.size()}, {"duplicate_ids", pairs(defects.duplicates)},
                       {"unused", defects.unused.size()},        {"unused_ids", ids(defects.unused)},
                       {"pinched", defects.pinched.size()},      {"pinched_ids", ids(defects.pinched)}};
    if (const auto& d = findings.distance)
        report["surface_distance"] = {{"max_percent", d->percent(d->max())},
                                      {"vertex_max_percent", d->percent(d->vertex_max)},
                                      {"vertex_mean_percent", d->percent(d->vertex_mean)},
                                      {"farthest_vertex", d->farthest_vertex.value()},
                                      {"to_surface_max_percent", d->percent(d->to_surface_max)},
                                      {"to_surface_mean_percent", d->percent(d->to_surface_mean)},
                                      {"from_surface_max_percent", d->percent(d->from_surface_max)},
                                      {"from_surface_mean_percent", d->percent(d->from_surface_mean)},
                                      {"diagonal", d->diagonal}};
    if (const auto& b = findings.bezier) {
        const auto first = [](const std::vector<std::int64_t>& list) {
            return std::vector(list.begin(),
                               list.begin() + static_cast<std::ptrdiff_t>(std::min(most_ids, list.size())));
        };
        report["bezier"] = {{"elements", b->elements.size()},
                            {"proved_positive", b->positive},
                            {"singular", b->singular},
                            {"negative", b->negative.size()},
                            {"negative_ids", first(b->negative)},
                            {"undecided", b->undecided.size()},
                            {"undecided_ids", first(b->undecided)},
                            {"lower_bound", b->lower}};
    }
    Json gates = Json::array();
    for (const Gate& gate : outcome.gates)
        gates.push_back({{"name", gate.name},
                         {"demand", gate.demand},
                         {"found", gate.found},
                         {"passed", gate.passed},
                         {"bad", gate.bad},
                         {"elements", ids(gate.cells)}});
    report["gates"] = gates;
    report["diagnostics"] = to_json(defects.topology);
    report["passed"] = outcome.passed();
    return report;
}

std::string junit_text(const Outcome& outcome) {
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    const auto counts = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\"", outcome.gates.size(),
                                    outcome.failed_gates());
    text += "<testsuites " + counts + ">\n  <testsuite name=\"hexspline check\" " + counts + ">\n";
    for (const Gate& gate : outcome.gates) {
        text += "    <testcase classname=\"" + xml_text(outcome.input) + "\" name=\"" + xml_text(gate.name) +
                "\"";
        if (gate.passed) {
            text += "/>\n";
            continue;
        }
        text += ">\n      <failure message=\"" + xml_text(gate_line(gate)) + "\">";
        for (const CellId c : gate.cells) {
            const hex::Vec3 centre = centre_of(outcome.mesh, c);
            text += fmt::format("hexahedron {} at ({:.6g}, {:.6g}, {:.6g})\n", c.value(), centre.x(),
                                centre.y(), centre.z());
        }
        text += "</failure>\n    </testcase>\n";
    }
    return text + "  </testsuite>\n</testsuites>\n";
}

std::string sarif_text(const Outcome& outcome) {
    Json rules = Json::array(), results = Json::array();
    for (std::size_t g = 0; g < outcome.gates.size(); ++g) {
        const Gate& gate = outcome.gates[g];
        rules.push_back(
            {{"id", gate.name}, {"shortDescription", {{"text", gate.name + ": " + gate.demand}}}});
        if (gate.passed) continue;
        const auto add = [&](const std::string& message, const Json& place) {
            results.push_back({{"ruleId", gate.name},
                               {"ruleIndex", g},
                               {"level", "error"},
                               {"message", {{"text", message}}},
                               {"locations", Json::array({place})}});
        };
        if (gate.cells.empty()) add(gate_line(gate), location(outcome));
        for (const CellId c : gate.cells) {
            const hex::Vec3 centre = centre_of(outcome.mesh, c);
            Json place = location(outcome);
            place["logicalLocations"] =
                Json::array({{{"name", "hexahedron " + std::to_string(c.value())}, {"kind", "element"}}});
            add(fmt::format("{} (hexahedron {} at ({:.6g}, {:.6g}, {:.6g}))", gate_line(gate), c.value(),
                            centre.x(), centre.y(), centre.z()),
                place);
        }
    }
    const Json sarif = {
        {"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
        {"version", "2.1.0"},
        {"runs",
         Json::array(
             {{{"tool",
                {{"driver", {{"name", "hexspline check"}, {"version", hex::version}, {"rules", rules}}}}},
               // What stands before the last slash tells uploads of several files apart.
               {"automationDetails", {{"id", "hexspline-check/" + outcome.input + "/"}}},
               {"results", results}}})}};
    return sarif.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string markdown_text(const Outcome& outcome) {
    const Findings& findings = outcome.findings;
    std::string text = "## hexspline check: " + markdown_cell(outcome.input) + "\n\n";
    text += outcome.passed()
                ? "**Passed.** "
                : fmt::format("**{} of {} demands failed.** ", outcome.failed_gates(), outcome.gates.size());
    text += fmt::format("{} hexahedra, {} vertices, {} inverted, boundary {}.\n\n", findings.summary.cells,
                        findings.summary.vertices, findings.summary.inverted,
                        findings.defects.watertight() ? "watertight" : "not watertight");
    text += "| demand | | found | |\n|---|---|---|---|\n";
    for (const Gate& gate : outcome.gates) {
        std::string elements;
        for (const CellId c : gate.cells)
            elements.append(elements.empty() ? "hexahedra " : ", ").append(std::to_string(c.value()));
        text +=
            fmt::format("| {} {} | {} | {} | {} |\n", markdown_cell(gate.name), markdown_cell(gate.demand),
                        gate.passed ? "passed" : "**FAILED**", markdown_cell(gate.found), elements);
    }
    text += "\n| metric | min | mean | median | max |\n|---|---|---|---|---|\n";
    for (const auto& [metric, measured] : findings.metrics) {
        const auto& s = measured.statistics;
        text +=
            fmt::format("| {} | {:.6g} | {:.6g} | {:.6g} | {:.6g} |\n",
                        markdown_cell(std::string(hex::info(metric).name)), s.min, s.mean, s.median, s.max);
    }
    return text;
}

}  // namespace cli
