#include "hexspline/check_gates.h"

#include <hex/io/number_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cli {
namespace {

using hex::CellId;
using hex::HexMetric;

std::string range_text(const MetricLimit& limit) {
    if (limit.min && limit.max) return "from " + exact_number(*limit.min) + " to " + exact_number(*limit.max);
    return limit.min ? "at least " + exact_number(*limit.min) : "at most " + exact_number(*limit.max);
}

/// Six digits when they say on which side of the limits a value is.
std::string found_text(const MetricLimit& limit, double value) {
    const std::string text = limit.min ? number_beside(value, *limit.min) : short_number(value);
    return limit.max && text == short_number(value) ? number_beside(value, *limit.max) : text;
}

bool in_range(const MetricLimit& limit, double value) {
    // A value that is not a number is in no range.
    return !(std::isnan(value) || (limit.min && value < *limit.min) || (limit.max && value > *limit.max));
}

Gate percentile_gate(const MetricLimit& limit, const Measured& measured) {
    const double value = hex::percentile(measured.values, *limit.percentile);
    Gate gate;
    gate.name = std::string(hex::info(limit.metric).name) + "-percentile-" + exact_number(*limit.percentile);
    gate.demand = range_text(limit);
    gate.found = found_text(limit, value);
    gate.passed = measured.values.empty() || in_range(limit, value);
    return gate;
}

Gate element_gate(const MetricLimit& limit, double bad_share, const Measured& measured, std::size_t worst) {
    const auto& info = hex::info(limit.metric);
    // How far a value is outside: the worst first, then in the order of the elements.
    std::vector<std::pair<double, std::size_t>> outside;
    for (std::size_t c = 0; c < measured.values.size(); ++c) {
        const double value = measured.values[c];
        if (in_range(limit, value)) continue;
        const double below = limit.min ? *limit.min - value : 0.0;
        const double above = limit.max ? value - *limit.max : 0.0;
        outside.emplace_back(-std::max(below, above), c);
    }
    const std::size_t listed = std::min(worst, outside.size());
    std::partial_sort(outside.begin(), outside.begin() + static_cast<std::ptrdiff_t>(listed), outside.end());
    Gate gate;
    gate.name = info.name;
    gate.demand = range_text(limit);
    const double allowed = limit.bad_share.value_or(bad_share);
    if (allowed > 0) gate.demand += " for all but a share of " + exact_number(allowed);
    gate.bad = outside.size();
    for (std::size_t i = 0; i < listed; ++i) gate.cells.emplace_back(outside[i].second);
    // The quotient is rounded like the decimal that was typed: exactly at the share asked for they are equal,
    // which a product of share and count is not (0.29 * 100 < 29).
    const double count = static_cast<double>(measured.values.size());
    gate.passed = gate.bad == 0 || static_cast<double>(gate.bad) / count <= allowed;
    const auto& statistics = measured.statistics;
    gate.found =
        "smallest " + found_text(limit, statistics.min) + ", largest " + found_text(limit, statistics.max);
    if (gate.bad > 0)
        gate.found += fmt::format(", {} of {} elements outside", gate.bad, measured.values.size());
    return gate;
}

Gate counting_gate(std::string name, std::string demand, std::size_t count) {
    return {std::move(name), std::move(demand), std::to_string(count), count == 0, count, {}};
}

Gate bezier_gate(const spline::JacobianReport& report, std::size_t worst) {
    Gate gate;
    gate.name = "bezier-validity";
    gate.demand = "the Jacobian of every element is proved positive";
    gate.found = fmt::format("{} proved positive, {} negative, {} undecided", report.positive,
                             report.negative.size(), report.undecided.size());
    if (report.singular > 0)
        gate.found +=
            fmt::format(" ({} of the positive are 0 at a corner or along an edge)", report.singular);
    gate.passed = report.proved();
    gate.bad = report.negative.size() + report.undecided.size();
    for (const auto* list : {&report.negative, &report.undecided})
        for (const std::int64_t element : *list)
            if (gate.cells.size() < worst) gate.cells.emplace_back(static_cast<std::size_t>(element));
    return gate;
}

std::size_t count_defects(const hex::MeshDefects& defects, std::string_view kind) {
    if (kind == "duplicate-nodes") return defects.duplicates.size();
    if (kind == "unused-nodes") return defects.unused.size();
    if (kind == "open-boundary") return defects.open_edges.size() + defects.cracks.size();
    if (kind == "pinched-nodes") return defects.pinched.size();
    return defects.several_components ? 1 : 0;
}

}  // namespace

std::string short_number(double value) {
    return fmt::format("{:.6g}", value);
}

std::string exact_number(double value) {
    std::string text;
    hex::io::append_number(text, value);
    return text;
}

std::string number_beside(double value, double limit) {
    const std::string text = short_number(value);
    const auto side = [&](double x) { return x < limit ? -1 : x > limit ? 1 : 0; };
    const auto told = hex::io::parse_double(text);
    return told && side(*told) == side(value) ? text : exact_number(value);
}

std::vector<Gate> evaluate_gates(const Demands& demands, const Findings& findings, std::size_t worst) {
    std::vector<Gate> gates;
    if (findings.bezier) {
        gates.push_back(bezier_gate(*findings.bezier, worst));
    } else if (!demands.has_minimum(HexMetric::scaled_jacobian)) {
        Gate gate = counting_gate("inverted", "no inverted element", findings.inverted.size());
        const auto listed = std::min(worst, findings.inverted.size());
        gate.cells.assign(findings.inverted.begin(),
                          findings.inverted.begin() + static_cast<std::ptrdiff_t>(listed));
        gates.push_back(std::move(gate));
    }
    for (const MetricLimit& limit : demands.limits) {
        if (!limit.has_limits()) continue;
        const Measured& measured = findings.metrics.at(limit.metric);
        gates.push_back(limit.percentile ? percentile_gate(limit, measured)
                                         : element_gate(limit, demands.bad_share, measured, worst));
    }
    if (demands.max_surface_distance && findings.distance) {
        const double percent = findings.distance->percent(findings.distance->max());
        Gate gate;
        gate.name = "surface-distance";
        gate.demand = "at most " + exact_number(*demands.max_surface_distance) + " % of the diagonal";
        gate.found = number_beside(percent, *demands.max_surface_distance) + " %";
        gate.passed = percent <= *demands.max_surface_distance;
        gate.bad = gate.passed ? 0 : 1;
        gates.push_back(std::move(gate));
    }
    if (findings.bezier) return gates;
    for (const std::string& kind : demands.forbidden)
        gates.push_back(counting_gate(kind, "none", count_defects(findings.defects, kind)));
    return gates;
}

}  // namespace cli
