#include <hex/base/diagnostics.h>

#include <algorithm>

namespace hex {

std::size_t count_at_least(const Diagnostics& diagnostics, Severity severity) {
    return static_cast<std::size_t>(std::count_if(
        diagnostics.begin(), diagnostics.end(), [=](const Diagnostic& d) { return d.severity >= severity; }));
}

void log_findings(const Context& context, const Diagnostics& diagnostics, const std::string& place) {
    for (const Diagnostic& d : diagnostics) {
        const std::string text = place.empty() ? d.message : place + ": " + d.message;
        context.log(d.severity == Severity::note ? LogLevel::info : LogLevel::warn, text);
    }
}

std::string list_ids(const std::vector<std::int64_t>& ids, std::size_t most) {
    std::string text;
    for (std::size_t i = 0; i < std::min(most, ids.size()); ++i) {
        if (i > 0) text += ", ";
        text += std::to_string(ids[i]);
    }
    if (ids.size() > most) text += ", ... (" + std::to_string(ids.size()) + " in all)";
    return text;
}

}  // namespace hex
