#include <hex/base/integer_program.h>
#include <hex/map/divisions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace hex {
namespace {

/// More pieces than any mesh that ids can name.
constexpr double most_pieces = 100000.0;
/// Crossing pairs up to which the integer program is solved.
constexpr std::size_t most_pairs = 300;

double square(double x) {
    return x * x;
}

/// Whole numbers around the real one that is best for a sheet alone.
std::vector<int> candidates_around(double best) {
    const double clamped = std::clamp(best, 1.0, most_pieces);
    const int below = static_cast<int>(clamped);
    // Where one piece more or less is a small change, the neighbours suffice.
    const int margin = clamped < 8.0 ? 1 : 0;
    std::vector<int> result;
    for (int n = std::max(1, below - margin); n <= below + 1 + margin; ++n) result.push_back(n);
    return result;
}

}  // namespace

/// The costs for one edge length, as tables over the candidates.
struct SheetDivider::Model {
    using Pair = std::pair<std::size_t, std::size_t>;

    std::vector<std::vector<int>> candidates;
    std::vector<std::vector<double>> single;            ///< of each sheet and candidate
    std::map<Pair, std::vector<double>> crossing;       ///< of two sheets, candidates of the second fastest
    std::vector<std::vector<const Pair*>> crossing_of;  ///< of each sheet

    double crossing_cost(const Pair& pair, std::size_t first, std::size_t second) const {
        return crossing.at(pair)[first * candidates[pair.second].size() + second];
    }

    /// Index of the candidate of each sheet, changed one at a time until none is better.
    std::vector<std::size_t> descend() const {
        std::vector<std::size_t> choice(candidates.size());
        for (std::size_t s = 0; s < choice.size(); ++s)
            choice[s] = static_cast<std::size_t>(std::min_element(single[s].begin(), single[s].end()) -
                                                 single[s].begin());
        const auto cost = [&](std::size_t s, std::size_t k) {
            double sum = single[s][k];
            for (const Pair* pair : crossing_of[s])
                sum += pair->first == s ? crossing_cost(*pair, k, choice[pair->second])
                                        : crossing_cost(*pair, choice[pair->first], k);
            return sum;
        };
        // Each change lowers the sum, so this ends; the bound is for rounding.
        bool changed = true;
        for (int sweep = 0; changed && sweep < 100; ++sweep) {
            changed = false;
            for (std::size_t s = 0; s < choice.size(); ++s) {
                std::size_t best = choice[s];
                for (std::size_t k = 0; k < candidates[s].size(); ++k)
                    if (cost(s, k) < cost(s, best) - 1e-9) best = k;
                changed = changed || best != choice[s];
                choice[s] = best;
            }
        }
        return choice;
    }

    /// The best choice, or `start` when the program finds none within its limit of nodes.
    std::vector<std::size_t> optimise(std::vector<std::size_t> start) const {
        IntegerProgram program;
        std::vector<std::vector<int>> chosen(candidates.size());
        for (std::size_t s = 0; s < candidates.size(); ++s) {
            std::vector<IntegerProgram::Term> one;
            for (const double cost : single[s]) {
                chosen[s].push_back(
                    program.add_variable({.lower = 0, .upper = 1, .cost = cost, .integer = true}));
                one.emplace_back(chosen[s].back(), 1.0);
            }
            program.add_row(one, 1, 1);
        }
        for (const auto& [pair, costs] : crossing) {
            const auto& first = chosen[pair.first];
            const auto& second = chosen[pair.second];
            std::vector<std::vector<IntegerProgram::Term>> columns(second.size());
            for (std::size_t k = 0; k < first.size(); ++k) {
                std::vector<IntegerProgram::Term> row;
                for (std::size_t l = 0; l < second.size(); ++l) {
                    const int both =
                        program.add_variable({.lower = 0, .upper = 1, .cost = crossing_cost(pair, k, l)});
                    row.emplace_back(both, 1.0);
                    columns[l].emplace_back(both, 1.0);
                }
                row.emplace_back(first[k], -1.0);
                program.add_row(row, 0, 0);
            }
            for (std::size_t l = 0; l < second.size(); ++l) {
                columns[l].emplace_back(second[l], -1.0);
                program.add_row(columns[l], 0, 0);
            }
        }
        const IntegerProgram::Result result = program.minimise({.nodes = 2000});
        if (!result.solved()) return start;
        for (std::size_t s = 0; s < candidates.size(); ++s)
            for (std::size_t k = 0; k < candidates[s].size(); ++k)
                if (result.integer(chosen[s][k]) == 1) start[s] = k;
        return start;
    }

    std::vector<int> pieces(const std::vector<std::size_t>& choice) const {
        std::vector<int> result(choice.size());
        for (std::size_t s = 0; s < choice.size(); ++s) result[s] = candidates[s][choice[s]];
        return result;
    }
};

SheetDivider::SheetDivider(const HexMesh& blocks, const EdgeTable& edges, const BlockSheets& sheets,
                           const std::vector<double>& lengths)
    : sheet_count_(sheets.count),
      blocks_(blocks.cell_count()),
      sheet_lengths_(sheets.count),
      sheet_blocks_(sheets.count) {
    for (const CellId b : blocks.cells()) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t sheet = sheets.of_axis(edges, b, axis);
            double sum = 0.0;
            for (const std::size_t e : edges_of_axis[axis]) {
                const double length = lengths[edges.cell_edges[b.index()][e].index()];
                sum += length;
                sheet_lengths_[sheet].push_back(length);
            }
            blocks_[b.index()][axis] = {sheet, sum / 4.0};
            // A sheet that crosses itself in a block has it once.
            if (sheet_blocks_[sheet].empty() || sheet_blocks_[sheet].back() != b.index())
                sheet_blocks_[sheet].push_back(b.index());
        }
    }
    for (const std::vector<double>& lengths_of_sheet : sheet_lengths_) {
        const double sum = std::accumulate(lengths_of_sheet.begin(), lengths_of_sheet.end(), 0.0);
        sheet_mean_.push_back(lengths_of_sheet.empty() ? 0.0
                                                       : sum / static_cast<double>(lengths_of_sheet.size()));
    }
}

double SheetDivider::weight_in(std::size_t sheet, double length) const {
    return sheet_mean_[sheet] > 0.0 ? length / sheet_mean_[sheet] : 1.0;
}

SheetDivider::Model SheetDivider::model(double edge_length) const {
    const auto log_ratio = [&](double length) { return std::max(0.0, std::log(length / edge_length)); };
    Model model;
    model.candidates.resize(sheet_count_);
    model.single.resize(sheet_count_);
    model.crossing_of.resize(sheet_count_);
    for (std::size_t s = 0; s < sheet_count_; ++s) {
        double sum = 0.0;
        for (const double length : sheet_lengths_[s]) sum += weight_in(s, length) * log_ratio(length);
        model.candidates[s] =
            candidates_around(std::exp(sum / static_cast<double>(sheet_lengths_[s].size())));
        // Far below what matters, far above rounding: of equally good choices always the same one.
        const double tie = 1e-6 * std::fmod(0.6180339887498949 * static_cast<double>(s + 1), 1.0);
        for (std::size_t k = 0; k < model.candidates[s].size(); ++k) {
            const double log_pieces = std::log(model.candidates[s][k]);
            double cost = tie * static_cast<double>(k);
            for (const double length : sheet_lengths_[s])
                cost += 0.25 * weight_in(s, length) * square(log_ratio(length) - log_pieces);
            model.single[s].push_back(cost);
        }
    }
    for (const auto& block : blocks_)
        for (std::size_t a = 0; a < 3; ++a) {
            const Axis* first = &block[a];
            const Axis* second = &block[(a + 1) % 3];
            if (first->sheet == second->sheet) continue;  // the same pieces, whatever is chosen
            if (first->sheet > second->sheet) std::swap(first, second);
            const auto& rows = model.candidates[first->sheet];
            const auto& columns = model.candidates[second->sheet];
            std::vector<double>& costs = model.crossing[{first->sheet, second->sheet}];
            costs.resize(rows.size() * columns.size());
            const double difference = log_ratio(first->mean_length) - log_ratio(second->mean_length);
            for (std::size_t k = 0; k < rows.size(); ++k)
                for (std::size_t l = 0; l < columns.size(); ++l)
                    costs[k * columns.size() + l] +=
                        square(difference - std::log(rows[k]) + std::log(columns[l]));
        }
    for (const auto& [pair, costs] : model.crossing) {
        model.crossing_of[pair.first].push_back(&pair);
        model.crossing_of[pair.second].push_back(&pair);
    }
    return model;
}

double SheetDivider::count(const std::vector<int>& pieces) const {
    double sum = 0.0;
    for (const auto& block : blocks_) {
        double product = 1.0;
        for (const Axis& axis : block) product *= pieces[axis.sheet];
        sum += product;
    }
    return sum;
}

SheetDivisions SheetDivider::solved(double edge_length, const Context& context) const {
    context.check_cancelled();
    const Model costs = model(edge_length);
    std::vector<std::size_t> choice = costs.descend();
    if (costs.crossing.size() <= most_pairs) choice = costs.optimise(std::move(choice));
    SheetDivisions result;
    result.pieces = costs.pieces(choice);
    result.edge_length = edge_length;
    result.hexes = static_cast<std::size_t>(count(result.pieces));
    return result;
}

SheetDivisions SheetDivider::for_length(double edge_length, const Context& context) const {
    return solved(edge_length, context);
}

SheetDivisions SheetDivider::for_count(std::size_t hexes, const Context& context) const {
    const auto target = static_cast<double>(hexes);
    double volume = 0.0;
    double longest = 0.0;
    for (const auto& block : blocks_) {
        double product = 1.0;
        for (const Axis& axis : block) {
            product *= axis.mean_length;
            longest = std::max(longest, axis.mean_length);
        }
        volume += product;
    }
    if (!(volume > 0.0)) return solved(longest > 0.0 ? longest : 1.0, context);

    // The count falls with H but for rounding: halve the interval of log H that holds the target.
    const double guess = std::cbrt(volume / target);
    double low = std::log(guess) - 4.0;
    double high = std::max(std::log(guess), std::log(longest)) + 1.0;
    SheetDivisions fine = solved(std::exp(low), context);
    SheetDivisions coarse = solved(std::exp(high), context);
    while (high - low > 2e-3 && fine.hexes > hexes && coarse.hexes < hexes) {
        const double middle = 0.5 * (low + high);
        SheetDivisions found = solved(std::exp(middle), context);
        (found.hexes > hexes ? low : high) = middle;
        (found.hexes > hexes ? fine : coarse) = std::move(found);
    }
    if (coarse.hexes >= hexes) return coarse;
    if (fine.hexes <= hexes) return fine;
    const double miss_coarse = std::log(target / static_cast<double>(coarse.hexes));
    const double miss_fine = std::log(static_cast<double>(fine.hexes) / target);
    return nudged(miss_coarse < miss_fine ? std::move(coarse) : std::move(fine), target);
}

double SheetDivider::energy_around(std::size_t sheet, const std::vector<int>& pieces,
                                   double edge_length) const {
    const auto log_ratio = [&](double length) { return std::max(0.0, std::log(length / edge_length)); };
    double sum = 0.0;
    for (const double length : sheet_lengths_[sheet])
        sum += 0.25 * weight_in(sheet, length) * square(log_ratio(length) - std::log(pieces[sheet]));
    for (const std::size_t b : sheet_blocks_[sheet])
        for (std::size_t a = 0; a < 3; ++a) {
            const Axis& p = blocks_[b][a];
            const Axis& q = blocks_[b][(a + 1) % 3];
            sum += square(log_ratio(p.mean_length) - std::log(pieces[p.sheet]) - log_ratio(q.mean_length) +
                          std::log(pieces[q.sheet]));
        }
    return sum;
}

SheetDivisions SheetDivider::nudged(SheetDivisions divisions, double target) const {
    constexpr double near_enough = 0.02;
    std::vector<int>& pieces = divisions.pieces;
    double miss = std::log(count(pieces) / target);
    while (std::abs(miss) > near_enough) {
        std::size_t cheapest = sheet_count_;
        double least = std::numeric_limits<double>::infinity();
        const int step = miss > 0.0 ? -1 : 1;
        for (std::size_t s = 0; s < sheet_count_; ++s) {
            if (pieces[s] + step < 1) continue;
            const double before = energy_around(s, pieces, divisions.edge_length);
            pieces[s] += step;
            const double more = energy_around(s, pieces, divisions.edge_length) - before;
            const bool nearer = std::abs(std::log(count(pieces) / target)) < std::abs(miss) - 1e-9;
            pieces[s] -= step;
            if (!nearer || more >= least - 1e-9) continue;
            least = more;
            cheapest = s;
        }
        if (cheapest == sheet_count_) break;
        pieces[cheapest] += step;
        miss = std::log(count(pieces) / target);
    }
    divisions.hexes = static_cast<std::size_t>(count(pieces));
    return divisions;
}

}  // namespace hex
