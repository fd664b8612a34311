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
    /// No upper bound; `-infinity`: no lower one.
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    /// A variable with its number and its factor in a linear expression. A variable may be named more than
    /// once in one expression; its factors add up.
    using Term = std::pair<int, double>;

    /// What is asked of a variable.
    struct Variable {
        double lower = -infinity;  ///< smallest value
        double upper = infinity;   ///< largest value, at least `lower`
        double cost = 0;           ///< factor in the sum that is minimised, finite
        bool integer = false;      ///< only whole numbers
    };

    /// How far the solver got.
    enum class Outcome {
        optimal,     ///< proven, up to the gap
        feasible,    ///< a limit was reached with a solution at hand
        infeasible,  ///< proven: no values satisfy all rows
        unknown,     ///< a limit was reached before a solution was found, or the minimum is unbounded
    };

    /// What minimise() found.
    struct Result {
        Outcome outcome = Outcome::unknown;  ///< how far the solver got
        double objective = 0;                ///< sum of cost * value; 0 unless solved()
        std::vector<double>
            values;  ///< one a variable, integer ones rounded; empty unless optimal or feasible

        /// There are values that satisfy all rows, the best or not.
        bool solved() const { return outcome == Outcome::optimal || outcome == Outcome::feasible; }
        /// Value of a variable by its number. Throws std::out_of_range for an unknown one, or when not
        /// solved().
        double value(int variable) const { return values.at(static_cast<std::size_t>(variable)); }
        /// Value of an integer variable; throws as value() does.
        int integer(int variable) const { return static_cast<int>(value(variable)); }
    };

    /// When to stop before the best solution is proven.
    struct Limits {
        int nodes = 20000;        ///< branch-and-bound nodes
        double relative_gap = 0;  ///< stop when the solution is proven this close to the best, as a share
        double seconds = 3600;    ///< safety net only: reaching it makes the result depend on the machine
    };

    /// Adds a variable; returns its number, counted from 0. Throws Error{usage} when lower > upper, a
    /// number is NaN, or the cost is infinite.
    int add_variable(const Variable& variable);

    /// Adds lower <= sum of terms <= upper. Throws Error{usage} for unknown variables, NaN, infinite factors,
    /// or lower > upper.
    void add_row(std::span<const Term> terms, double lower, double upper);
    /// The same for terms that are written down in the call.
    void add_row(std::initializer_list<Term> terms, double lower, double upper);

    /// Adds cost * |sum of terms - target| to what is minimised, by a variable of its own, which is returned.
    /// `cost` is at least 0. Throws Error{usage} for a cost that is negative or not finite, and as add_row
    /// does.
    int add_distance(std::span<const Term> terms, double target, double cost);
    /// The same for terms that are written down in the call.
    int add_distance(std::initializer_list<Term> terms, double target, double cost);

    /// Number of variables so far, those of distances included.
    int variables() const { return static_cast<int>(variables_.size()); }
    /// Number of rows so far; a distance adds two.
    int rows() const { return static_cast<int>(rows_.size()); }

    /// Solves. The solver keeps to all rows within 1e-6; integer variables are rounded after that.
    Result minimise(const Limits& limits) const;
    /// Solves with the default limits.
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

/// Shorter name of what IntegerProgram::minimise() returns.
using IntegerProgramResult = IntegerProgram::Result;

}  // namespace hex
