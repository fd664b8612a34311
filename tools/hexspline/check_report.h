/// \file check_report.h
/// The outcome of `hexspline check` in the forms that people and build servers read. Pure text: nothing here
/// writes a file.
#pragma once

#include "hexspline/check_gates.h"

#include <hex/volume/hex_mesh.h>

#include <string>

namespace cli {

/// Everything a report can tell.
struct Outcome {
    std::string input;  ///< name of the file
    const hex::HexMesh& mesh;
    Findings findings;
    std::vector<Gate> gates;

    bool passed() const;
    std::size_t failed_gates() const;
};

/// For people: figures, worst elements, gates.
std::string table_text(const Outcome& outcome);
/// The report (docs/check.schema.json).
Json report_json(const Outcome& outcome);
/// JUnit XML: one test case a gate.
std::string junit_text(const Outcome& outcome);
/// SARIF 2.1.0: one result for each element that a failed gate lists, or for the gate when it lists none.
std::string sarif_text(const Outcome& outcome);
/// Markdown for the summary of a job.
std::string markdown_text(const Outcome& outcome);

}  // namespace cli
