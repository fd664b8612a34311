#include "hexspline/check_demands.h"

#include <hex/base/error.h>
#include <hex/io/number_text.h>
#include <hex/io/text_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>

namespace cli {
namespace {

using hex::HexMetric;
using Json = nlohmann::json;

[[noreturn]] void usage_error(const std::string& what, const std::string& advice = {}) {
    throw hex::Error(hex::ErrorKind::usage, what, {}, advice);
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

std::string known_metrics() {
    std::string names;
    for (const auto& metric : hex::hex_metrics()) names.append(names.empty() ? "" : ", ").append(metric.name);
    return names;
}

std::string no_metric(const std::string& name) {
    return name == "all" ? "'all' can be reported (--metric all), and a limit is for one metric"
                         : "there is no metric '" + name + "'";
}

HexMetric metric_named(const std::string& name) {
    const auto metric = hex::find_hex_metric(name);
    if (!metric) usage_error(no_metric(name), "known metrics: " + known_metrics());
    return *metric;
}

std::optional<double> optional_number(const std::string& text, const std::string& whole) {
    if (text.empty()) return std::nullopt;
    const auto value = hex::io::parse_double(text);
    if (!value) usage_error("'" + text + "' in '" + whole + "' is not a number");
    return value;
}

void check_order(const MetricLimit& limit, const std::string& whole) {
    if (limit.min && limit.max && *limit.min > *limit.max)
        usage_error("in '" + whole + "' the minimum is larger than the maximum");
}

struct Profile {
    std::string_view name;
    std::vector<MetricLimit> limits;
    std::set<std::string, std::less<>> forbidden;
};

MetricLimit at_least(HexMetric metric, double min) {
    return {metric, min, std::nullopt, std::nullopt, std::nullopt};
}
MetricLimit at_most(HexMetric metric, double max) {
    return {metric, std::nullopt, max, std::nullopt, std::nullopt};
}

/// The numbers are explained in docs/check.md.
const std::vector<Profile>& profiles() {
    static const std::vector<Profile> list = {
        {"ls-dyna",
         {at_least(HexMetric::scaled_jacobian, 0.2), at_most(HexMetric::aspect_ratio, 10),
          at_most(HexMetric::warpage, 40), at_least(HexMetric::min_angle, 20),
          at_most(HexMetric::max_angle, 160)},
         {"unused-nodes", "duplicate-nodes", "open-boundary"}},
        {"abaqus",
         {at_least(HexMetric::scaled_jacobian, 0.01), at_least(HexMetric::min_angle, 10),
          at_most(HexMetric::max_angle, 160), at_most(HexMetric::aspect_ratio, 10)},
         {"duplicate-nodes", "open-boundary"}},
        {"iga",
         {at_least(HexMetric::scaled_jacobian, 0.1), at_most(HexMetric::aspect_ratio, 20)},
         {"unused-nodes", "duplicate-nodes", "open-boundary", "pinched-nodes"}},
    };
    return list;
}

/// Reads a configuration file's JSON, telling what is wrong with which key.
class ConfigReader {
  public:
    explicit ConfigReader(std::filesystem::path file) : file_(std::move(file)) {}

    Demands read() {
        const Json root = parse();
        if (!root.is_object()) fail("an object {...} should be here");
        Demands demands;
        // The profile is where the other keys start from, wherever it stands.
        if (const auto found = root.find("profile"); found != root.end()) {
            try {
                demands = profile(text(*found, "profile"));
            } catch (const hex::Error& error) {
                if (error.kind() != hex::ErrorKind::usage) throw;
                fail(error.problem() + "; " + error.advice());
            }
        }
        for (const auto& [key, value] : root.items()) take(demands, key, value);
        return demands;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw hex::Error(hex::ErrorKind::bad_input, what, file_.string());
    }

    Json parse() const {
        const std::string text = hex::io::read_text_file(file_);
        // JSON leaves open which of two entries with the same key holds: none does here.
        std::vector<std::set<std::string>> open_objects;
        const auto refuse_twice = [&](int, Json::parse_event_t event, Json& key) {
            if (event == Json::parse_event_t::object_start) open_objects.emplace_back();
            if (event == Json::parse_event_t::object_end) open_objects.pop_back();
            if (event == Json::parse_event_t::key &&
                !open_objects.back().insert(key.get<std::string>()).second)
                fail("the key '" + key.get<std::string>() + "' is there twice");
            return true;
        };
        try {
            return Json::parse(text, refuse_twice);
        } catch (const Json::exception& problem) {
            fail(std::string("is not JSON: ") + problem.what());
        }
    }

    void take(Demands& demands, const std::string& key, const Json& value) const {
        if (key == "profile") return;
        if (key == "bad_share") {
            demands.bad_share = number(value, key, 0, 1);
        } else if (key == "metrics") {
            if (!value.is_object()) fail("'metrics' should be an object {...}");
            std::set<HexMetric> seen;
            for (const auto& [name, limits] : value.items()) {
                const MetricLimit read = limit(name, limits);
                if (!seen.insert(read.metric).second) fail("'" + name + "' is there twice, in two spellings");
                demands.add(read);
            }
        } else if (key == "max_surface_distance") {
            demands.max_surface_distance = number(value, key, 0, 1e30);
        } else if (key == "surface") {
            demands.surface = beside(value, key);
        } else if (key == "baseline") {
            demands.baseline = beside(value, key);
        } else if (key == "forbid") {
            if (!value.is_array()) fail("'forbid' should be a list [...]");
            for (const Json& kind : value) demands.forbidden.insert(defect(text(kind, key)));
        } else {
            fail("unknown key '" + key +
                 "'; known are profile, bad_share, metrics, max_surface_distance, surface, baseline, forbid");
        }
    }

    MetricLimit limit(const std::string& name, const Json& value) const {
        const auto metric = hex::find_hex_metric(name);
        if (!metric) fail(no_metric(name) + "; known metrics: " + known_metrics());
        if (!value.is_object()) fail("'" + name + "' should be an object {...}");
        MetricLimit result{*metric, {}, {}, {}, {}};
        for (const auto& [key, entry] : value.items()) {
            if (key == "min")
                result.min = number(entry, key, -1e300, 1e300);
            else if (key == "max")
                result.max = number(entry, key, -1e300, 1e300);
            else if (key == "bad_share")
                result.bad_share = number(entry, key, 0, 1);
            else if (key == "percentile")
                result.percentile = number(entry, key, 0, 100);
            else
                fail("unknown key '" + key + "' of '" + name +
                     "'; known are min, max, bad_share, percentile");
        }
        if (result.min && result.max && *result.min > *result.max)
            fail("the minimum of '" + name + "' is larger than its maximum");
        if (result.percentile && result.bad_share)
            fail("'" + name + "' has a percentile and a bad_share, of which only one can be meant");
        if ((result.percentile || result.bad_share) && !result.has_limits())
            fail("'" + name + "' has a " + (result.percentile ? "percentile" : "bad_share") +
                 " and no limit (min, max) for it");
        return result;
    }

    std::string defect(const std::string& name) const {
        const auto& kinds = defect_kinds();
        if (std::find(kinds.begin(), kinds.end(), name) == kinds.end())
            fail("'" + name + "' in 'forbid' is no kind of defect");
        return name;
    }

    std::string text(const Json& value, const std::string& key) const {
        if (!value.is_string()) fail("'" + key + "' should be a text");
        return value.get<std::string>();
    }
    double number(const Json& value, const std::string& key, double lower, double upper) const {
        const double result = value.is_number() ? value.get<double>() : upper + 1;
        if (!value.is_number() || !(result >= lower && result <= upper)) {
            std::string range = "'" + key + "' should be a number from ";
            hex::io::append_number(range, lower);
            range += " to ";
            hex::io::append_number(range, upper);
            fail(range);
        }
        return result;
    }
    std::filesystem::path beside(const Json& value, const std::string& key) const {
        const std::string name = text(value, key);
        if (name.empty()) fail("'" + key + "' should be the name of a file, and is empty");
        return file_.parent_path() / name;
    }

    std::filesystem::path file_;
};

}  // namespace

void Demands::add(const MetricLimit& limit) {
    for (MetricLimit& known : limits) {
        if (known.metric != limit.metric || known.percentile != limit.percentile) continue;
        if (limit.has_limits() || !known.has_limits()) known = limit;
        return;
    }
    limits.push_back(limit);
}

void Demands::replace(const std::vector<MetricLimit>& others) {
    std::erase_if(limits, [&](const MetricLimit& known) {
        bool is_named = false, is_same = false;
        for (const MetricLimit& other : others) {
            if (other.metric != known.metric || !other.has_limits()) continue;
            // A percentile is less than a demand on every element and takes none away.
            if (other.percentile && !known.percentile) continue;
            is_named = true;
            is_same |= other.percentile == known.percentile;
        }
        // What is replaced by its like keeps its place.
        return is_named && !is_same;
    });
    for (const MetricLimit& other : others) add(other);
}

void Demands::merge(const MetricLimit& limit) {
    for (MetricLimit& known : limits) {
        if (known.metric != limit.metric || known.percentile != limit.percentile) continue;
        const std::string name(hex::info(limit.metric).name);
        const auto take = [&](std::optional<double>& bound, const std::optional<double>& other,
                              const char* what) {
            if (bound && other && *bound != *other) {
                std::string values;
                hex::io::append_number(values, *bound);
                values += " and ";
                hex::io::append_number(values, *other);
                usage_error(std::string("two options give '") + name + "' different " + what + ", " + values);
            }
            if (other) bound = other;
        };
        take(known.min, limit.min, "minima");
        take(known.max, limit.max, "maxima");
        check_order(known, name);
        return;
    }
    limits.push_back(limit);
}

bool Demands::has_minimum(HexMetric metric) const {
    return std::any_of(limits.begin(), limits.end(), [&](const MetricLimit& limit) {
        return limit.metric == metric && limit.min.has_value() && !limit.percentile;
    });
}

const std::vector<std::string_view>& defect_kinds() {
    static const std::vector<std::string_view> kinds = {"duplicate-nodes", "unused-nodes", "open-boundary",
                                                        "pinched-nodes", "several-components"};
    return kinds;
}

std::vector<MetricLimit> parse_metric(const std::string& text) {
    const auto parts = split(text, ':');
    if (parts.size() > 3) usage_error("'" + text + "' is not NAME[:MIN[:MAX]]");
    std::vector<MetricLimit> limits;
    if (parts[0] == "all") {
        if (parts.size() > 1) usage_error("'all' takes no limits");
        for (const auto& metric : hex::hex_metrics()) limits.push_back({metric.metric, {}, {}, {}, {}});
        return limits;
    }
    const auto metric = hex::find_hex_metric(parts[0]);
    if (!metric)
        usage_error(no_metric(parts[0]), "known metrics: " + known_metrics() + "; all reports every one");
    MetricLimit limit{*metric, {}, {}, {}, {}};
    if (parts.size() > 1) limit.min = optional_number(parts[1], text);
    if (parts.size() > 2) limit.max = optional_number(parts[2], text);
    check_order(limit, text);
    return {limit};
}

MetricLimit parse_percentile(const std::string& text) {
    const auto parts = split(text, ':');
    if (parts.size() < 3 || parts.size() > 4) usage_error("'" + text + "' is not NAME:PERCENT:MIN[:MAX]");
    MetricLimit limit{metric_named(parts[0]), {}, {}, {}, {}};
    limit.percentile = optional_number(parts[1], text);
    if (!limit.percentile || *limit.percentile < 0 || *limit.percentile > 100)
        usage_error("the percentile in '" + text + "' must be in [0, 100]");
    limit.min = optional_number(parts[2], text);
    if (parts.size() > 3) limit.max = optional_number(parts[3], text);
    if (!limit.has_limits()) usage_error("'" + text + "' has no limit");
    check_order(limit, text);
    return limit;
}

std::set<std::string, std::less<>> parse_defects(const std::string& text) {
    std::set<std::string, std::less<>> result;
    const auto& kinds = defect_kinds();
    for (const std::string& name : split(text, ',')) {
        if (std::find(kinds.begin(), kinds.end(), name) == kinds.end()) {
            std::string known;
            for (const auto kind : kinds) known.append(known.empty() ? "" : ", ").append(kind);
            usage_error("'" + name + "' is no kind of defect", "known kinds: " + known);
        }
        result.insert(name);
    }
    return result;
}

std::string profile_names() {
    std::string names;
    for (const Profile& candidate : profiles())
        names.append(names.empty() ? "" : ", ").append(candidate.name);
    return names;
}

Demands profile(const std::string& name) {
    for (const Profile& candidate : profiles()) {
        if (candidate.name != name) continue;
        Demands demands;
        demands.limits = candidate.limits;
        demands.forbidden = candidate.forbidden;
        return demands;
    }
    usage_error("there is no profile '" + name + "'", "known profiles: " + profile_names());
}

Demands read_demands(const std::filesystem::path& file) {
    return ConfigReader(file).read();
}

}  // namespace cli
