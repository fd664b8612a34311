#include "polycube/voxel_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace hex::voxels {
namespace {

/// Whether the cells of a 2 x 2 x 2 pattern (bit x + 2 y + 4 z) hang together through faces.
bool connected(unsigned cells) {
    if (cells == 0) return true;
    unsigned reached = cells & (~cells + 1);
    for (unsigned before = 0; before != reached;) {
        before = reached;
        for (unsigned c = 0; c < 8; ++c) {
            if (!(reached >> c & 1U)) continue;
            for (const unsigned step : {1U, 2U, 4U}) reached |= cells & (1U << (c ^ step));
        }
    }
    return reached == cells;
}

/// The boundary at the middle node is one disk exactly if both the taken cells and the others hang together;
/// a direction sees all its faces unless two of them face opposite ways.
const auto make_good = [] {
    std::array<bool, 256> good{};
    for (unsigned p = 0; p < 256; ++p) {
        good[p] = connected(p) && connected(~p & 255U);
        for (const unsigned step : {1U, 2U, 4U}) {
            bool up = false;
            bool down = false;
            for (unsigned c = 0; c < 8; ++c) {
                if (!(p >> c & 1U) || (p >> (c ^ step) & 1U)) continue;
                ((c & step) != 0 ? down : up) = true;
            }
            if (up && down) good[p] = false;
        }
    }
    return good;
};
const std::array<bool, 256> good_pattern = make_good();

/// Steps of repair for each bad node at the start, before it is given up.
constexpr std::size_t steps_per_node = 30;

}  // namespace

CellSet::CellSet(const Grid& grid, std::vector<char> taken)
    : grid_(&grid),
      taken_(std::move(taken)),
      stride_{1, grid.count(0), static_cast<std::ptrdiff_t>(grid.count(0)) * grid.count(1)} {
    for (std::size_t i = 0; i < taken_.size(); ++i)
        if (taken_[i] && !changeable(grid.cell(i))) taken_[i] = 0;
}

std::size_t CellSet::size() const {
    return static_cast<std::size_t>(std::count(taken_.begin(), taken_.end(), char{1}));
}

bool CellSet::changeable(const Cell& c) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (c[axis] < 1 || c[axis] > grid_->count(axis) - 2) return false;
    return true;
}

unsigned CellSet::pattern(const Cell& node) const {
    unsigned p = 0;
    for (int k = 0; k < 8; ++k) {
        const Cell c = {node[0] - 1 + (k & 1), node[1] - 1 + (k >> 1 & 1), node[2] - 1 + (k >> 2)};
        if (taken_[grid_->index(c)]) p |= 1U << k;
    }
    return p;
}

bool CellSet::good_node(const Cell& node) const {
    return good_pattern[pattern(node)];
}

int CellSet::bad_nodes(const Cell& c) const {
    int bad = 0;
    for (int k = 0; k < 8; ++k) bad += !good_node({c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2)});
    return bad;
}

bool CellSet::simple_here(const Cell& c) const {
    // Among the 18 neighbours: pieces, through faces, of one kind that touch the cell through a face.
    std::array<char, 27> kind{};
    for (int k = 0; k < 27; ++k)
        kind[static_cast<std::size_t>(k)] =
            taken_[grid_->index({c[0] - 1 + k % 3, c[1] - 1 + k / 3 % 3, c[2] - 1 + k / 9})];
    const auto off_axes = [](int k) {
        return std::abs(k % 3 - 1) + std::abs(k / 3 % 3 - 1) + std::abs(k / 9 - 1);
    };
    std::array<char, 27> seen{};
    std::array<int, 2> pieces = {0, 0};
    for (int start = 0; start < 27; ++start) {
        if (off_axes(start) != 1 || seen[static_cast<std::size_t>(start)]) continue;
        const char own = kind[static_cast<std::size_t>(start)];
        ++pieces[static_cast<std::size_t>(own)];
        std::array<int, 18> stack{};
        std::size_t depth = 0;
        stack[depth++] = start;
        seen[static_cast<std::size_t>(start)] = 1;
        while (depth > 0) {
            const int k = stack[--depth];
            for (const auto& [step, coordinate] : {std::pair(1, k % 3), {3, k / 3 % 3}, {9, k / 9}}) {
                for (const int sign : {-1, 1}) {
                    if (coordinate + sign < 0 || coordinate + sign > 2) continue;
                    const int next = k + sign * step;
                    const int off = off_axes(next);
                    const auto n = static_cast<std::size_t>(next);
                    if (off < 1 || off > 2 || seen[n] || kind[n] != own) continue;
                    seen[n] = 1;
                    stack[depth++] = next;
                }
            }
        }
    }
    return pieces[0] == 1 && pieces[1] == 1;
}

bool CellSet::simple(const Cell& c) const {
    if (!changeable(c) || !simple_here(c) || bad_nodes(c) > 0) return false;
    CellSet& self = const_cast<CellSet&>(*this);
    const std::size_t i = grid_->index(c);
    self.flip(i);
    const bool good = bad_nodes(c) == 0;
    self.flip(i);
    return good;
}

int CellSet::repair(const std::vector<std::uint8_t>& shares) {
    std::set<Cell> bad;
    Cell node;
    for (node[2] = 1; node[2] < grid_->count(2); ++node[2])
        for (node[1] = 1; node[1] < grid_->count(1); ++node[1])
            for (node[0] = 1; node[0] < grid_->count(0); ++node[0])
                if (!good_node(node)) bad.insert(node);
    std::map<std::size_t, int> flips;
    int changed = 0;
    for (std::size_t steps = steps_per_node * bad.size(); !bad.empty(); --steps) {
        if (steps == 0) return -1;
        node = *bad.begin();
        double best = std::numeric_limits<double>::infinity();
        Cell chosen{};
        for (int k = 0; k < 8; ++k) {
            const Cell c = {node[0] - 1 + (k & 1), node[1] - 1 + (k >> 1 & 1), node[2] - 1 + (k >> 2)};
            if (!changeable(c)) continue;
            const std::size_t i = grid_->index(c);
            const int before = bad_nodes(c);
            flip(i);
            const int after = bad_nodes(c);
            const bool helps = good_node(node);
            flip(i);
            const auto times = flips.find(i);
            const double inside = static_cast<double>(shares[i]) / samples_per_cell;
            const double price = (after - before) + 1.5 * (taken(i) ? inside : 1.0 - inside) +
                                 (times == flips.end() ? 0.0 : 0.7 * times->second) + (helps ? 0.0 : 0.5);
            if (!(price < best)) continue;
            best = price;
            chosen = c;
        }
        if (best == std::numeric_limits<double>::infinity()) return -1;
        const std::size_t i = grid_->index(chosen);
        flip(i);
        ++flips[i];
        ++changed;
        for (int k = 0; k < 8; ++k) {
            const Cell at = {chosen[0] + (k & 1), chosen[1] + (k >> 1 & 1), chosen[2] + (k >> 2)};
            if (good_node(at))
                bad.erase(at);
            else
                bad.insert(at);
        }
    }
    return changed;
}

Pieces CellSet::pieces() const {
    Pieces pieces;
    pieces.piece.assign(taken_.size(), -1);
    std::vector<std::size_t> stack;
    for (std::size_t start = 0; start < taken_.size(); ++start) {
        if (pieces.piece[start] >= 0) continue;
        pieces.piece[start] = pieces.count;
        stack.push_back(start);
        while (!stack.empty()) {
            const std::size_t i = stack.back();
            stack.pop_back();
            const Cell c = grid_->cell(i);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const int sign : {-1, 1}) {
                    if (c[axis] + sign < 0 || c[axis] + sign >= grid_->count(axis)) continue;
                    const std::size_t n = i + static_cast<std::size_t>(sign * stride_[axis]);
                    if (pieces.piece[n] >= 0 || taken_[n] != taken_[i]) continue;
                    pieces.piece[n] = pieces.count;
                    stack.push_back(n);
                }
            }
        }
        ++pieces.count;
    }

    std::map<std::pair<int, int>, BoundaryComponent> boundaries;
    const auto at = [&](std::size_t inner, std::size_t outer) -> BoundaryComponent& {
        const std::pair key(pieces.piece[inner], pieces.piece[outer]);
        const auto [place, fresh] = boundaries.try_emplace(key);
        if (fresh) place->second = {key.first, key.second, 0, 0, inner};
        return place->second;
    };
    for (std::size_t i = 0; i < taken_.size(); ++i) {
        if (!taken_[i]) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const int sign : {-1, 1}) {
                const std::size_t n = i + static_cast<std::size_t>(sign * stride_[axis]);
                if (!taken_[n]) ++at(i, n).faces;
            }
        }
    }
    Cell node;
    for (node[2] = 1; node[2] < grid_->count(2); ++node[2]) {
        for (node[1] = 1; node[1] < grid_->count(1); ++node[1]) {
            for (node[0] = 1; node[0] < grid_->count(0); ++node[0]) {
                const unsigned p = pattern(node);
                if (p == 0 || p == 255) continue;
                const auto cell = [&](int k) {
                    return grid_->index(
                        {node[0] - 1 + (k & 1), node[1] - 1 + (k >> 1 & 1), node[2] - 1 + (k >> 2)});
                };
                ++at(cell(std::countr_zero(p)), cell(std::countr_zero(~p))).nodes;
            }
        }
    }
    for (const auto& [key, boundary] : boundaries) pieces.boundaries.push_back(boundary);
    return pieces;
}

}  // namespace hex::voxels
