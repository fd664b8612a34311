/// \file check_demands.h
/// What `hexspline check` asks of a mesh: limits from options, a profile or a configuration file.
#pragma once

#include <hex/quality/hex_metrics.h>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace cli {

/// A metric with the range its values have to be in. Without limits it is only reported.
struct MetricLimit {
    hex::HexMetric metric = hex::HexMetric::scaled_jacobian;
    std::optional<double> min;
    std::optional<double> max;
    /// Share of elements that may be outside, in [0, 1]; when not given, that of all limits.
    std::optional<double> bad_share;
    /// The limits are for this percentile (0..100) instead of for every element.
    std::optional<double> percentile;

    bool has_limits() const { return min.has_value() || max.has_value(); }
};

struct Demands {
    std::vector<MetricLimit> limits;
    double bad_share = 0.0;
    /// In percent of the surface's diagonal.
    std::optional<double> max_surface_distance;
    std::optional<std::filesystem::path> surface;
    std::optional<std::filesystem::path> baseline;
    /// Defects that fail the check: names of `defect_kinds()`.
    std::set<std::string, std::less<>> forbidden;

    /// A limit for the same metric (and percentile) replaces the one that is there.
    void add(const MetricLimit& limit);
    /// Limits for a metric replace what there is for it: those for every element all of it, those for a
    /// percentile what is for a percentile.
    void replace(const std::vector<MetricLimit>& others);
    /// Its bounds hold besides those that are there for the same metric (and percentile). Throws
    /// hex::Error{usage} when both have the same bound with different values.
    void merge(const MetricLimit& limit);
    /// Every element (but for a share of bad ones) has a smallest value of the metric that it must reach.
    bool has_minimum(hex::HexMetric metric) const;
};

/// "duplicate-nodes", "unused-nodes", "open-boundary", "pinched-nodes", "several-components".
const std::vector<std::string_view>& defect_kinds();

/// "NAME", "NAME:MIN", "NAME:MIN:MAX", "NAME::MAX"; "all" is every metric without limits. Throws
/// hex::Error{usage}.
std::vector<MetricLimit> parse_metric(const std::string& text);

/// "NAME:PERCENT:MIN[:MAX]". Throws hex::Error{usage}.
MetricLimit parse_percentile(const std::string& text);

/// "a,b": names of defect_kinds(). Throws hex::Error{usage}.
std::set<std::string, std::less<>> parse_defects(const std::string& text);

/// The limits of a profile (docs/check.md). Throws hex::Error{usage} for an unknown one.
Demands profile(const std::string& name);
/// Names of the profiles, separated by commas.
std::string profile_names();

/// A configuration file (docs/check.md). Paths in it are relative to it. Throws hex::Error{bad_input}.
Demands read_demands(const std::filesystem::path& file);

}  // namespace cli
