/// \file diagnostics.h
/// Findings that a reader or a stage reports without stopping.
#pragma once

#include <hex/base/context.h>

#include <cstdint>
#include <string>
#include <vector>

namespace hex {

enum class Severity { note, warning, error };

/// One finding. `code` is a stable machine-readable name (kebab-case); `ids` are the entities meant, 0-based,
/// of the kind that `entity` names ("triangle", "vertex", "patch", "cell", "line").
struct Diagnostic {
    Severity severity = Severity::warning;
    std::string code;
    std::string message;
    std::string entity;
    std::vector<std::int64_t> ids;
};

using Diagnostics = std::vector<Diagnostic>;

/// Number of findings at least as severe as `severity`.
std::size_t count_at_least(const Diagnostics& diagnostics, Severity severity);

/// Gives each finding to `context.on_log`: notes as info, the others as warnings. `place` (a file name) is
/// put in front when given.
void log_findings(const Context& context, const Diagnostics& diagnostics, const std::string& place = {});

/// "3, 17, 22, ... (41 in all)": at most `most` ids, for messages.
std::string list_ids(const std::vector<std::int64_t>& ids, std::size_t most = 8);

}  // namespace hex
