/// \file integer_program.h
/// Small mixed integer linear programs: minimise a sum of costs under linear rows. A thin face of COIN-OR
/// CBC.
#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace hex {

/// Built variable by variable and row by row, then solved once or more. Deterministic: one thread, and a
/// limit on branch-and-bound nodes rather than on time.
///
///     IntegerProgram program;
///     const int x = program.add_variable({.lower = 1, .integer = true});
///     const int distance = program.add_distance({{x, 1.0}}, 2.6, 1.0);   // minimise |x - 2.6|
///     const IntegerProgramResult result = program.minimise();            // result.value(x) == 3
class IntegerProgram {
  public:
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    /// A variable with its number and its factor in a linear expression. A variable may be named more than
    /// once in one expression; its factors add up.
    using Term = std::pair<int, double>;

    struct Variable {
        double lower = -infinity;
        double upper = infinity;
        double cost = 0;  ///< factor in the sum that is minimised
        bool integer = false;
    };

    enum class Outcome {
        optimal,     ///< proven, up to the gap
        feasible,    ///< the node limit was reached with a solution at hand
        infeasible,  ///< proven: no values satisfy all rows
        unknown,     ///< the node limit was reached before a solution was found, or the minimum is unbounded
    };

    struct Result {
        Outcome outcome = Outcome::unknown;
        double objective = 0;
        std::vector<double>
            values;  ///< one a variable, integer ones rounded; empty unless optimal or feasible

        bool solved() const { return outcome == Outcome::optimal || outcome == Outcome::feasible; }
        double value(int variable) const { return values.at(static_cast<std::size_t>(variable)); }
        /// Value of an integer variable.
        int integer(int variable) const { return static_cast<int>(value(variable)); }
    };

    struct Limits {
        int nodes = 20000;        ///< branch-and-bound nodes
        double relative_gap = 0;  ///< stop when the solution is proven this close to the best, as a share
        double seconds = 3600;    ///< safety net only: reaching it makes the result depend on the machine
    };

    /// Adds a variable; returns its number, counted from 0. Throws Error{usage} when lower > upper or a
    /// number is NaN.
    int add_variable(const Variable& variable);

    /// Adds lower <= sum of terms <= upper. Throws Error{usage} for unknown variables, NaN, or lower > upper.
    void add_row(std::span<const Term> terms, double lower, double upper);
    void add_row(std::initializer_list<Term> terms, double lower, double upper);

    /// Adds cost * |sum of terms - target| to what is minimised, by a variable of its own, which is returned.
    /// `cost` is at least 0.
    int add_distance(std::span<const Term> terms, double target, double cost);
    int add_distance(std::initializer_list<Term> terms, double target, double cost);

    int variables() const { return static_cast<int>(variables_.size()); }
    int rows() const { return static_cast<int>(rows_.size()); }

    /// Solves. The result satisfies all rows within 1e-6.
    Result minimise(const Limits& limits) const;
    Result minimise() const { return minimise(Limits()); }

  private:
    struct Row {
        std::vector<Term> terms;
        double lower;
        double upper;
    };

    std::vector<Variable> variables_;
    std::vector<Row> rows_;
};

using IntegerProgramResult = IntegerProgram::Result;

}  // namespace hex
