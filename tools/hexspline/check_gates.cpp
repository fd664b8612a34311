#include "hexspline/check_gates.h"

#include <hex/base/error.h>
#include <hex/io/text_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cli {
namespace {

using hex::BetterWhen;
using hex::CellId;
using hex::HexMetric;

std::string range_text(const MetricLimit& limit) {
    if (limit.min && limit.max) return "from " + short_number(*limit.min) + " to " + short_number(*limit.max);
    return limit.min ? "at least " + short_number(*limit.min) : "at most " + short_number(*limit.max);
}

bool in_range(const MetricLimit& limit, double value) {
    // A value that is not a number is in no range.
    return !(std::isnan(value) || (limit.min && value < *limit.min) || (limit.max && value > *limit.max));
}

Gate percentile_gate(const MetricLimit& limit, const Measured& measured) {
    const double value = hex::percentile(measured.values, *limit.percentile);
    Gate gate;
    gate.name = std::string(hex::info(limit.metric).name) + "-percentile-" + short_number(*limit.percentile);
    gate.demand = range_text(limit);
    gate.found = short_number(value);
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
    if (allowed > 0) gate.demand += fmt::format(" for all but a share of {:g}", allowed);
    gate.bad = outside.size();
    for (std::size_t i = 0; i < listed; ++i) gate.cells.emplace_back(outside[i].second);
    // The quotient is rounded like the decimal that was typed: exactly at the share asked for they are equal,
    // which a product of share and count is not (0.29 * 100 < 29).
    const double count = static_cast<double>(measured.values.size());
    gate.passed = gate.bad == 0 || static_cast<double>(gate.bad) / count <= allowed;
    const auto& statistics = measured.statistics;
    gate.found = "smallest " + short_number(statistics.min) + ", largest " + short_number(statistics.max);
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

/// The part of an earlier report that is compared.
class Baseline {
  public:
    Baseline(std::filesystem::path file, double tolerance) : file_(std::move(file)), tolerance_(tolerance) {
        const std::string text = hex::io::read_text_file(file_);
        try {
            report_ = Json::parse(text);
        } catch (const Json::exception& problem) {
            fail(std::string("is not JSON: ") + problem.what());
        }
        if (!report_.is_object() || !report_.contains("min_scaled_jacobian"))
            fail("is not a report of hexspline check");
    }

    /// A number of the report, by its place; none when it is not there.
    std::optional<double> number(std::initializer_list<const char*> keys) const {
        const Json* value = &report_;
        for (const char* key : keys) {
            if (!value->is_object()) fail("is not a report of hexspline check");
            const auto found = value->find(key);
            if (found == value->end()) return std::nullopt;
            value = &*found;
        }
        if (value->is_null()) return std::nullopt;
        if (!value->is_number()) fail("is not a report of hexspline check");
        return value->get<double>();
    }

    void compare(std::vector<Gate>& gates, const std::string& name, std::optional<double> before, double now,
                 BetterWhen better, const std::vector<CellId>& cells = {}) const {
        if (!before) return;
        const double slack = tolerance_ * std::max(1.0, std::abs(*before));
        const bool worse = better == BetterWhen::larger ? now < *before - slack : now > *before + slack;
        Gate gate;
        gate.name = "baseline-" + name;
        gate.demand = (better == BetterWhen::larger ? "at least " : "at most ") + short_number(*before);
        gate.found = short_number(now);
        gate.passed = !worse;
        gate.bad = worse ? 1 : 0;
        if (worse) gate.cells = cells;
        gates.push_back(std::move(gate));
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw hex::Error(hex::ErrorKind::bad_input, what, file_.string());
    }

    std::filesystem::path file_;
    double tolerance_;
    Json report_;
};

}  // namespace

std::string short_number(double value) {
    return fmt::format("{:.6g}", value);
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
        gate.demand = "at most " + short_number(*demands.max_surface_distance) + " % of the diagonal";
        gate.found = short_number(percent) + " %";
        gate.passed = percent <= *demands.max_surface_distance;
        gate.bad = gate.passed ? 0 : 1;
        gates.push_back(std::move(gate));
    }
    if (findings.bezier) return gates;
    for (const std::string& kind : demands.forbidden)
        gates.push_back(counting_gate(kind, "none", count_defects(findings.defects, kind)));
    return gates;
}

std::vector<Gate> compare_with_baseline(const std::filesystem::path& file, double tolerance,
                                        const Findings& findings, std::size_t worst) {
    const Baseline baseline(file, tolerance);
    std::vector<Gate> gates;
    for (const auto& [metric, measured] : findings.metrics) {
        const auto& info = hex::info(metric);
        if (info.better == BetterWhen::neither) continue;
        const std::string name(info.name);
        const bool larger = info.better == BetterWhen::larger;
        auto cells = measured.worst;
        cells.resize(std::min(worst, cells.size()));
        baseline.compare(gates, name + (larger ? "-min" : "-max"),
                         baseline.number({"metrics", name.c_str(), larger ? "min" : "max"}),
                         larger ? measured.statistics.min : measured.statistics.max, info.better, cells);
        baseline.compare(gates, name + "-mean", baseline.number({"metrics", name.c_str(), "mean"}),
                         measured.statistics.mean, info.better);
    }
    const auto count = [&](const char* name, std::optional<double> before, std::size_t now) {
        baseline.compare(gates, name, before, static_cast<double>(now), BetterWhen::smaller);
    };
    if (!baseline.number({"metrics", "scaled_jacobian", "min"}))
        baseline.compare(gates, "scaled_jacobian-min", baseline.number({"min_scaled_jacobian"}),
                         findings.summary.min, BetterWhen::larger);
    count("inverted", baseline.number({"inverted"}), findings.inverted.size());
    count("duplicate-nodes", baseline.number({"nodes", "duplicate"}), findings.defects.duplicates.size());
    count("unused-nodes", baseline.number({"nodes", "unused"}), findings.defects.unused.size());
    count("open-boundary", baseline.number({"boundary", "open_edges"}), findings.defects.open_edges.size());
    if (findings.distance)
        baseline.compare(gates, "surface-distance", baseline.number({"surface_distance", "max_percent"}),
                         findings.distance->percent(findings.distance->max()), BetterWhen::smaller);
    return gates;
}

}  // namespace cli
