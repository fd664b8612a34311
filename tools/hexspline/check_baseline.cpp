#include "hexspline/check_baseline.h"

#include <hex/base/error.h>
#include <hex/io/text_file.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cli {
namespace {

using hex::BetterWhen;
using hex::HexMetric;

/// How much a metric may differ when the corners of the same elements come in another order.
double round_off(HexMetric metric, const hex::MetricStatistics& now) {
    double scale = 1.0;  // all but these are ratios
    if (metric == HexMetric::jacobian) scale = std::max(std::abs(now.min), std::abs(now.max));
    if (metric == HexMetric::min_angle || metric == HexMetric::max_angle || metric == HexMetric::warpage)
        scale = 180.0;
    return 16 * std::numeric_limits<double>::epsilon() * scale;
}

Gate gate_against(const std::string& name, double before, double now, BetterWhen better, double slack) {
    const bool larger = better == BetterWhen::larger;
    Gate gate;
    gate.name = "baseline-" + name;
    gate.demand = (larger ? "at least " : "at most ") + exact_number(before);
    gate.found = number_beside(now, before);
    gate.passed = larger ? now >= before - slack : now <= before + slack;
    gate.bad = gate.passed ? 0 : 1;
    return gate;
}

}  // namespace

Baseline::Baseline(std::filesystem::path file) : file_(std::move(file)) {
    const std::string text = hex::io::read_text_file(file_);
    try {
        report_ = Json::parse(text);
    } catch (const Json::exception& problem) {
        fail(std::string("is not JSON: ") + problem.what());
    }
    const std::string no_report = "is not a report of hexspline check";
    if (!report_.is_object()) fail(no_report);
    const auto command = report_.find("command");
    if (command == report_.end() || !command->is_string()) fail(no_report + ": it has no 'command'");
    if (*command != "check") fail(no_report + ", but of '" + command->get<std::string>() + "'");
    if (!number({"min_scaled_jacobian"})) fail(no_report + ": it has no 'min_scaled_jacobian'");
    const auto metrics = report_.find("metrics");
    if (metrics == report_.end() || !metrics->is_object()) fail(no_report + ": it has no 'metrics'");
    for (const auto& [name, numbers] : metrics->items()) {
        const auto metric = hex::find_hex_metric(name);
        if (!metric || hex::info(*metric).name != name)
            unknown_metrics_.push_back(name);
        else if (hex::info(*metric).better != BetterWhen::neither)
            metrics_.push_back(*metric);
    }
}

std::string Baseline::not_compared(const Findings& findings) const {
    std::string text;
    const auto add = [&](const std::string& what) { text.append(text.empty() ? "" : ", ").append(what); };
    if (!findings.distance && number({"surface_distance", "max_percent"}))
        add("the distance to a surface (there is no --surface)");
    if (findings.bezier && report_.contains("nodes")) add("nodes and boundary (not looked at in a spline)");
    for (const std::string& name : unknown_metrics_) add("'" + name + "' (there is no such metric)");
    return text;
}

std::vector<Gate> Baseline::compare(const Findings& findings, double tolerance, std::size_t worst) const {
    std::vector<Gate> gates;
    const auto compare = [&](const std::string& name, std::optional<double> before, double now,
                             BetterWhen better, double rounding) {
        if (!before) return;
        gates.push_back(gate_against(name, *before, now, better, tolerance * std::abs(*before) + rounding));
    };
    for (const HexMetric metric : metrics_) {
        const auto found = findings.metrics.find(metric);
        if (found == findings.metrics.end()) continue;
        const Measured& measured = found->second;
        const auto& info = hex::info(metric);
        const std::string name(info.name);
        const bool larger = info.better == BetterWhen::larger;
        const double rounding = round_off(metric, measured.statistics);
        const std::size_t first = gates.size();
        compare(name + (larger ? "-min" : "-max"), number({"metrics", name.c_str(), larger ? "min" : "max"}),
                larger ? measured.statistics.min : measured.statistics.max, info.better, rounding);
        if (gates.size() > first && !gates.back().passed)
            gates.back().cells.assign(
                measured.worst.begin(),
                measured.worst.begin() + static_cast<std::ptrdiff_t>(std::min(worst, measured.worst.size())));
        compare(name + "-mean", number({"metrics", name.c_str(), "mean"}), measured.statistics.mean,
                info.better, rounding);
    }
    if (!number({"metrics", "scaled_jacobian", "min"}))
        compare("scaled_jacobian-min", number({"min_scaled_jacobian"}), findings.summary.min,
                BetterWhen::larger, round_off(HexMetric::scaled_jacobian, {}));
    const auto count = [&](const char* name, std::optional<double> before, std::size_t now) {
        compare(name, before, static_cast<double>(now), BetterWhen::smaller, 0.0);
    };
    count("inverted", number({"inverted"}), findings.inverted.size());
    if (!findings.bezier) {
        count("duplicate-nodes", number({"nodes", "duplicate"}), findings.defects.duplicates.size());
        count("unused-nodes", number({"nodes", "unused"}), findings.defects.unused.size());
        count("pinched-nodes", number({"nodes", "pinched"}), findings.defects.pinched.size());
        count("open-boundary", number({"boundary", "open_edges"}), findings.defects.open_edges.size());
        count("cracks", number({"boundary", "cracks"}), findings.defects.cracks.size());
    }
    if (findings.distance)
        compare("surface-distance", number({"surface_distance", "max_percent"}),
                findings.distance->percent(findings.distance->max()), BetterWhen::smaller,
                16 * std::numeric_limits<double>::epsilon() * 100.0);
    return gates;
}

void Baseline::fail(const std::string& what) const {
    throw hex::Error(hex::ErrorKind::bad_input, what, file_.string());
}

std::optional<double> Baseline::number(std::initializer_list<const char*> keys) const {
    const Json* value = &report_;
    std::string place;
    for (const char* key : keys) {
        if (!value->is_object()) fail("is not a report of hexspline check: '" + place + "' is no object");
        const auto found = value->find(key);
        if (found == value->end()) return std::nullopt;
        value = &*found;
        place.append(place.empty() ? "" : ".").append(key);
    }
    if (value->is_null()) return std::nullopt;
    if (!value->is_number()) fail("is not a report of hexspline check: '" + place + "' is no number");
    return value->get<double>();
}

}  // namespace cli
