/// \file diagnostics.h
/// Findings that a reader or a stage reports without stopping.
#pragma once

#include <hex/base/context.h>

#include <cstdint>
#include <string>
#include <vector>

namespace hex {

/// How bad a finding is, ascending.
enum class Severity {
    note,     ///< worth knowing, nothing to mend
    warning,  ///< may spoil the result
    error,    ///< keeps the next stage from working
};

/// One finding: what was found, how bad it is, and where.
struct Diagnostic {
    Severity severity = Severity::warning;  ///< how bad it is
    std::string code;     ///< stable machine-readable name, in kebab-case: "zero-area-triangles"
    std::string message;  ///< one line for people; it may name the first ids only
    /// What `ids` number: "triangle", "vertex", "edge", "patch", "chart", "cell", "line", ...; may be empty
    /// when there are no ids.
    std::string entity;
    /// The entities meant, counted from 0; lines of a file and faces of a CAD file count from 1.
    std::vector<std::int64_t> ids;
};

/// Findings in the order in which they were made.
using Diagnostics = std::vector<Diagnostic>;

/// Number of findings at least as severe as `severity`.
std::size_t count_at_least(const Diagnostics& diagnostics, Severity severity);

/// Gives each finding to `context.on_log`: notes as info, the others as warnings. `place` (a file name) is
/// put in front when given.
void log_findings(const Context& context, const Diagnostics& diagnostics, const std::string& place = {});

/// "3, 17, 22, ... (41 in all)": at most `most` ids, for messages.
std::string list_ids(const std::vector<std::int64_t>& ids, std::size_t most = 8);

}  // namespace hex
