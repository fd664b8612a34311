/// \file check_baseline.h
/// An earlier report of `hexspline check`, and what has become worse since.
#pragma once

#include "hexspline/check_gates.h"

namespace cli {

class Baseline {
  public:
    /// Throws hex::Error{bad_input} when `file` is not a report of check.
    explicit Baseline(std::filesystem::path file);

    /// The metrics of the report, without those of which neither end is the good one.
    const std::vector<hex::HexMetric>& metrics() const { return metrics_; }
    /// What the report has and these findings do not, for people; empty when all of it is compared.
    std::string not_compared(const Findings& findings) const;

    /// One gate for each number of the report that `findings` have, too. Nothing may be worse than there by
    /// more than `tolerance` times the number there (and the round-off of computing it); so what is 0 stays
    /// 0.
    std::vector<Gate> compare(const Findings& findings, double tolerance, std::size_t worst) const;

  private:
    [[noreturn]] void fail(const std::string& what) const;
    /// A number of the report, by its place; none when it is not there.
    std::optional<double> number(std::initializer_list<const char*> keys) const;

    std::filesystem::path file_;
    Json report_;
    std::vector<hex::HexMetric> metrics_;
    std::vector<std::string> unknown_metrics_;
};

}  // namespace cli
