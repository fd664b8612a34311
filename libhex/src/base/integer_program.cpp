#include <hex/base/error.h>
#include <hex/base/integer_program.h>

#include <Cbc_C_Interface.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

namespace hex {
namespace {

/// CBC keeps some of its state in globals: one solve at a time.
std::mutex& solver_mutex() {
    static std::mutex mutex;
    return mutex;
}

struct DeleteModel {
    void operator()(Cbc_Model* model) const { Cbc_deleteModel(model); }
};

void require_range(double lower, double upper) {
    // Written so that NaN is refused, too.
    if (!(lower <= upper))
        throw Error(ErrorKind::usage, "integer program: a lower bound above its upper bound");
}

double bounded(double value) {
    return std::clamp(value, -1e30, 1e30);
}

IntegerProgram::Outcome outcome_of(Cbc_Model* model, bool has_solution) {
    using Outcome = IntegerProgram::Outcome;
    if (Cbc_isProvenInfeasible(model) != 0 || Cbc_isInitialSolveProvenPrimalInfeasible(model) != 0)
        return Outcome::infeasible;
    if (!has_solution) return Outcome::unknown;
    return Cbc_isProvenOptimal(model) != 0 ? Outcome::optimal : Outcome::feasible;
}

}  // namespace

int IntegerProgram::add_variable(const Variable& variable) {
    require_range(variable.lower, variable.upper);
    if (!std::isfinite(variable.cost)) throw Error(ErrorKind::usage, "integer program: a cost is not finite");
    variables_.push_back(variable);
    return variables() - 1;
}

void IntegerProgram::add_row(std::span<const Term> terms, double lower, double upper) {
    require_range(lower, upper);
    std::map<int, double> sums;
    for (const auto& [variable, factor] : terms) {
        if (variable < 0 || variable >= variables() || !std::isfinite(factor))
            throw Error(ErrorKind::usage,
                        "integer program: a row with an unknown variable or a factor that is not finite");
        sums[variable] += factor;
    }
    rows_.push_back({{sums.begin(), sums.end()}, lower, upper});
}

void IntegerProgram::add_row(std::initializer_list<Term> terms, double lower, double upper) {
    add_row(std::span(terms.begin(), terms.size()), lower, upper);
}

int IntegerProgram::add_distance(std::span<const Term> terms, double target, double cost) {
    if (!(cost >= 0)) throw Error(ErrorKind::usage, "integer program: a negative cost of a distance");
    const int distance = add_variable({.lower = 0, .cost = cost});
    std::vector<Term> row(terms.begin(), terms.end());
    row.emplace_back(distance, 1.0);
    add_row(row, target, infinity);  // distance >= target - sum
    row.back().second = -1.0;
    add_row(row, -infinity, target);  // distance >= sum - target
    return distance;
}

int IntegerProgram::add_distance(std::initializer_list<Term> terms, double target, double cost) {
    return add_distance(std::span(terms.begin(), terms.size()), target, cost);
}

IntegerProgram::Result IntegerProgram::minimise(const Limits& limits) const {
    Result result;
    if (variables_.empty()) {
        const bool possible = std::all_of(rows_.begin(), rows_.end(),
                                          [](const Row& row) { return row.lower <= 0 && row.upper >= 0; });
        result.outcome = possible ? Outcome::optimal : Outcome::infeasible;
        return result;
    }

    const std::lock_guard lock(solver_mutex());
    const std::unique_ptr<Cbc_Model, DeleteModel> model(Cbc_newModel());
    Cbc_setLogLevel(model.get(), 0);

    // By columns, as CBC stores them.
    std::vector<std::vector<std::pair<int, double>>> columns(variables_.size());
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        for (const auto& [variable, factor] : rows_[r].terms)
            columns[static_cast<std::size_t>(variable)].emplace_back(static_cast<int>(r), factor);
    }
    std::vector<CoinBigIndex> starts = {0};
    std::vector<int> row_indices;
    std::vector<double> factors, column_lower, column_upper, costs, row_lower, row_upper;
    for (std::size_t v = 0; v < variables_.size(); ++v) {
        for (const auto& [row, factor] : columns[v]) {
            row_indices.push_back(row);
            factors.push_back(factor);
        }
        starts.push_back(static_cast<CoinBigIndex>(row_indices.size()));
        column_lower.push_back(bounded(variables_[v].lower));
        column_upper.push_back(bounded(variables_[v].upper));
        costs.push_back(variables_[v].cost);
    }
    for (const Row& row : rows_) {
        row_lower.push_back(bounded(row.lower));
        row_upper.push_back(bounded(row.upper));
    }
    Cbc_loadProblem(model.get(), variables(), rows(), starts.data(), row_indices.data(), factors.data(),
                    column_lower.data(), column_upper.data(), costs.data(), row_lower.data(),
                    row_upper.data());
    for (int v = 0; v < variables(); ++v) {
        if (variables_[static_cast<std::size_t>(v)].integer) Cbc_setInteger(model.get(), v);
    }
    Cbc_setObjSense(model.get(), 1);
    Cbc_setMaximumNodes(model.get(), limits.nodes);
    Cbc_setMaximumSeconds(model.get(), limits.seconds);
    Cbc_setAllowableFractionGap(model.get(), limits.relative_gap);
    Cbc_solve(model.get());

    const double* solution = Cbc_bestSolution(model.get());
    result.outcome = outcome_of(model.get(), solution != nullptr);
    if (!result.solved()) return result;
    result.values.assign(solution, solution + variables_.size());
    for (std::size_t v = 0; v < variables_.size(); ++v) {
        if (variables_[v].integer) result.values[v] = std::round(result.values[v]);
        result.objective += variables_[v].cost * result.values[v];
    }
    return result;
}

}  // namespace hex
