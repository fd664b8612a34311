#include "map/harmonic_interior.h"

#include <hex/base/parallel.h>
#include <hex/map/block_sheets.h>
#include <hex/quality/scaled_jacobian.h>

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace hex {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Triplets = std::vector<Eigen::Triplet<double, int>>;

double square(double x) {
    return x * x;
}

/// Row of each node in the system; -1 on the boundary.
std::vector<int> number_inner_nodes(const HexMesh& blocks, const BlockNumbering& numbering, int& count) {
    std::vector<int> row(numbering.node_count(), 0);
    for (std::size_t f = 0; f < numbering.faces().size(); ++f)
        if (!blocks.twin(numbering.faces()[f].half_face).valid())
            for (const VertexId node : numbering.face_nodes(f)) row[node.index()] = -1;
    count = 0;
    for (int& r : row)
        if (r == 0) r = count++;
    return row;
}

/// Visits the edges of the fine grid of a block once for each of its cells around it, as
/// `visit(node, node, weight)`.
template <class Visit>
void for_each_link(const EdgeTable& edges, const BlockNumbering& numbering,
                   const std::vector<double>& lengths, CellId block, const Visit& visit) {
    const std::array<int, 3> n = numbering.segments(block);
    std::array<double, 3> spacing{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::size_t e : edges_of_axis[axis])
            spacing[axis] += lengths[edges.cell_edges[block.index()][e].index()];
        spacing[axis] /= 4.0 * n[axis];
    }
    const std::vector<VertexId> nodes = numbering.block_nodes(block);
    const std::array<int, 3> stride = {1, n[0] + 1, (n[0] + 1) * (n[1] + 1)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t p = (axis + 1) % 3;
        const std::size_t q = (axis + 2) % 3;
        const double quarter = 0.25 * spacing[p] * spacing[q] / spacing[axis];
        const auto around = [&](int at, std::size_t across) { return at == 0 || at == n[across] ? 1 : 2; };
        std::array<int, 3> at{};
        for (at[2] = 0; at[2] <= n[2]; ++at[2])
            for (at[1] = 0; at[1] <= n[1]; ++at[1])
                for (at[0] = 0; at[0] <= n[0]; ++at[0]) {
                    if (at[axis] == n[axis]) continue;
                    const int here = at[0] * stride[0] + at[1] * stride[1] + at[2] * stride[2];
                    visit(nodes[static_cast<std::size_t>(here)].index(),
                          nodes[static_cast<std::size_t>(here + stride[axis])].index(),
                          quarter * around(at[p], p) * around(at[q], q));
                }
    }
}

using Points = std::vector<Vec3>;

double dot(const Points& a, const Points& b) {
    return parallel_reduce(
        a.size(), 0.0, [&](double sum, std::size_t i) { return sum + a[i].dot(b[i]); }, std::plus<>());
}

/// Solves A x = right for the three coordinates at once by conjugate gradients with the diagonal as
/// preconditioner, from a given start; returns the iterations. One step length serves all coordinates, so
/// that the iterates turn with the model. Stops at a residual of 1e-10 of the first one, or at `rounding`.
int solve(const Matrix& a, const Points& right, double rounding, Points& x) {
    const auto count = x.size();
    const auto row = [&](const Points& values, std::size_t i) {
        Vec3 sum = Vec3::Zero();
        for (int k = a.outerIndexPtr()[i]; k < a.outerIndexPtr()[i + 1]; ++k)
            sum += a.valuePtr()[k] * values[static_cast<std::size_t>(a.innerIndexPtr()[k])];
        return sum;
    };
    const Eigen::VectorXd diagonal = a.diagonal();
    Points residual(count), scaled(count), direction(count), image(count);
    const auto precondition = [&](std::size_t i) {
        scaled[i] = residual[i] / diagonal[static_cast<Eigen::Index>(i)];
    };
    parallel_for(count, [&](std::size_t i) {
        residual[i] = right[i] - row(x, i);
        precondition(i);
        direction[i] = scaled[i];
    });
    double now = dot(residual, scaled);
    const double enough = std::max(square(rounding), square(1e-10) * now);
    int iterations = 0;
    const int most = 10 * static_cast<int>(std::sqrt(static_cast<double>(count))) + 1000;
    for (; now > enough && iterations < most; ++iterations) {
        parallel_for(count, [&](std::size_t i) { image[i] = row(direction, i); });
        const double step = now / dot(direction, image);
        parallel_for(count, [&](std::size_t i) {
            x[i] += step * direction[i];
            residual[i] -= step * image[i];
            precondition(i);
        });
        const double next = dot(residual, scaled);
        const double keep = next / now;
        now = next;
        parallel_for(count, [&](std::size_t i) { direction[i] = scaled[i] + keep * direction[i]; });
    }
    return iterations;
}

/// Elements below this scaled Jacobian must not be worse than at the start.
constexpr double watched_quality = 0.3;
/// Shares of the move are multiples of 1 / full_move; neighbours differ by at most one.
constexpr int full_move = 8;

/// Takes moves back until no element is worse than min(its start, watched_quality): every such element lowers
/// the shares of its nodes, and neighbours follow so that the change is gradual and does not make other
/// elements worse.
void hold_back(const std::vector<HexCell>& cells, const std::vector<Vec3>& start,
               std::vector<Vec3>& positions) {
    const auto quality = [&](const std::vector<Vec3>& at, const HexCell& cell) {
        std::array<Vec3, 8> corners;
        for (std::size_t c = 0; c < 8; ++c) corners[c] = at[cell[c].index()];
        return scaled_jacobian(corners);
    };
    std::vector<double> wanted(cells.size());
    parallel_for(cells.size(),
                 [&](std::size_t c) { wanted[c] = std::min(watched_quality, quality(start, cells[c])); });
    const std::vector<Vec3> moved = positions;
    std::vector<int> share(positions.size(), full_move);
    std::vector<char> worse(cells.size(), 0);
    // With shares of zero an element is as good as at the start: each round lowers some, or is the last.
    for (bool changed = true; changed;) {
        changed = false;
        parallel_for(cells.size(), [&](std::size_t c) {
            worse[c] = static_cast<char>(quality(positions, cells[c]) < wanted[c]);
        });
        for (std::size_t c = 0; c < cells.size(); ++c)
            if (worse[c] != 0)
                for (const VertexId v : cells[c])
                    if (share[v.index()] > 0) {
                        --share[v.index()];
                        changed = true;
                    }
        if (!changed) break;
        for (bool spread = true; spread;) {
            spread = false;
            for (const HexCell& cell : cells) {
                int least = full_move;
                for (const VertexId v : cell) least = std::min(least, share[v.index()]);
                for (const VertexId v : cell)
                    if (share[v.index()] > least + 1) {
                        share[v.index()] = least + 1;
                        spread = true;
                    }
            }
        }
        parallel_for(positions.size(), [&](std::size_t v) {
            const double part = static_cast<double>(share[v]) / full_move;
            positions[v] = share[v] == full_move ? moved[v] : Vec3(start[v] + part * (moved[v] - start[v]));
        });
    }
}

}  // namespace

HarmonicReport relax_harmonically(const HexMesh& blocks, const EdgeTable& edges,
                                  const BlockNumbering& numbering, const std::vector<double>& edge_lengths,
                                  const std::vector<HexCell>& cells, std::vector<Vec3>& positions,
                                  const Context& context) {
    HarmonicReport report;
    int count = 0;
    const std::vector<int> row = number_inner_nodes(blocks, numbering, count);
    if (count == 0) return report;

    Triplets entries;
    Points right(static_cast<std::size_t>(count), Vec3::Zero());
    const auto half = [&](std::size_t from, std::size_t to, double weight) {
        if (row[from] < 0) return;
        entries.emplace_back(row[from], row[from], weight);
        if (row[to] >= 0)
            entries.emplace_back(row[from], row[to], -weight);
        else
            right[static_cast<std::size_t>(row[from])] += weight * positions[to];
    };
    for (const CellId b : blocks.cells())
        for_each_link(edges, numbering, edge_lengths, b, [&](std::size_t a, std::size_t c, double weight) {
            half(a, c, weight);
            half(c, a, weight);
        });
    Matrix matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    context.check_cancelled();

    Points inner(right.size());
    BoundingBox box;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        box.add(positions[v]);
        if (row[v] >= 0) inner[static_cast<std::size_t>(row[v])] = positions[v];
    }
    const double rounding = 1e-14 * box.diagonal() * std::sqrt(matrix.diagonal().sum());
    report.iterations = solve(matrix, right, rounding, inner);
    context.check_cancelled();

    const Points start = positions;
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (row[v] >= 0) positions[v] = inner[static_cast<std::size_t>(row[v])];
    const Points moved = positions;
    hold_back(cells, start, positions);
    for (std::size_t v = 0; v < positions.size(); ++v)
        report.held_back_nodes += positions[v] == moved[v] ? 0 : 1;
    return report;
}

}  // namespace hex
