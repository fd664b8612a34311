#include "quality/scaled_jacobian_kernel.h"

#include <hex/base/parallel.h>
#include <hex/quality/scaled_jacobian.h>

namespace hex {
namespace {

using quality::lane_count;
using quality::Lanes;

quality::Vector<double> vector_of(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

/// Scaled Jacobians of `lane_count` cells side by side; a short block repeats its last cell.
void fill_block(const HexMesh& mesh, std::size_t first, std::size_t count, double* values) {
    std::array<quality::Vector<Lanes>, 8> corners;
    for (int lane = 0; lane < lane_count; ++lane) {
        const std::size_t cell = first + std::min(static_cast<std::size_t>(lane), count - 1);
        for (std::size_t i = 0; i < 8; ++i) {
            const Vec3& p = mesh.position(mesh.cell_array()[cell][i]);
            corners[i].x[lane] = p.x();
            corners[i].y[lane] = p.y();
            corners[i].z[lane] = p.z();
        }
    }
    const Lanes result = quality::scaled_jacobian<Lanes>(corners);
    for (std::size_t i = 0; i < count; ++i) values[i] = result[static_cast<Eigen::Index>(i)];
}

/// Without opening a task arena of its own.
std::vector<double> compute_scaled_jacobians(const HexMesh& mesh) {
    std::vector<double> values(mesh.cell_count());
    const std::size_t blocks = (values.size() + lane_count - 1) / lane_count;
    parallel_for(blocks, [&](std::size_t block) {
        const std::size_t first = block * lane_count;
        fill_block(mesh, first, std::min<std::size_t>(lane_count, values.size() - first), &values[first]);
    });
    return values;
}

std::size_t histogram_bin(double value, std::size_t bins) {
    const double position = (value + 1.0) / 2.0 * static_cast<double>(bins);
    return static_cast<std::size_t>(std::clamp(position, 0.0, static_cast<double>(bins - 1)));
}

std::size_t count_used_vertices(const HexMesh& mesh) {
    std::vector<char> used(mesh.vertex_count(), 0);
    for (const HexCell& cell : mesh.cell_array())
        for (const VertexId v : cell) used[v.index()] = 1;
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), char{1}));
}

}  // namespace

double scaled_jacobian(const std::array<Vec3, 8>& corners) {
    std::array<quality::Vector<double>, 8> p;
    for (std::size_t i = 0; i < 8; ++i) p[i] = vector_of(corners[i]);
    return quality::scaled_jacobian<double>(p);
}

double scaled_jacobian(const HexMesh& mesh, CellId cell) {
    return scaled_jacobian(mesh.corner_positions(cell));
}

double corner_scaled_jacobian(const std::array<Vec3, 8>& corners, int corner) {
    const auto& neighbours = hexahedron::corner_neighbours[static_cast<std::size_t>(corner)];
    const auto edge = [&](std::size_t i) {
        return vector_of(corners[static_cast<std::size_t>(neighbours[i])] -
                         corners[static_cast<std::size_t>(corner)]);
    };
    return quality::scaled_determinant<double>(edge(0), edge(1), edge(2));
}

std::vector<double> scaled_jacobians(const HexMesh& mesh, const Context& context) {
    return with_threads(context, [&] { return compute_scaled_jacobians(mesh); });
}

QualitySummary summarize(const HexMesh& mesh, const Context& context) {
    return summarize(mesh, scaled_jacobians(mesh, context), context);
}

QualitySummary summarize(const HexMesh& mesh, std::span<const double> values, const Context& context) {
    struct Partial {
        double sum = 0.0;
        double min = std::numeric_limits<double>::infinity();
        CellId worst;
        std::size_t inverted = 0;
        std::array<std::size_t, 20> histogram{};
    };
    const auto add_cell = [&](Partial partial, std::size_t cell) {
        const double value = values[cell];
        partial.sum += value;
        if (value < partial.min) {
            partial.min = value;
            partial.worst = CellId(cell);
        }
        if (value <= 0.0) ++partial.inverted;
        ++partial.histogram[histogram_bin(value, partial.histogram.size())];
        return partial;
    };
    const auto join = [](Partial a, const Partial& b) {
        a.sum += b.sum;
        if (b.min < a.min) {
            a.min = b.min;
            a.worst = b.worst;
        }
        a.inverted += b.inverted;
        for (std::size_t i = 0; i < a.histogram.size(); ++i) a.histogram[i] += b.histogram[i];
        return a;
    };

    QualitySummary summary;
    summary.cells = values.size();
    summary.vertices = count_used_vertices(mesh);
    if (values.empty()) return summary;
    const Partial total =
        with_threads(context, [&] { return parallel_reduce(values.size(), Partial{}, add_cell, join); });
    summary.min = total.min;
    summary.mean = total.sum / static_cast<double>(values.size());
    summary.worst = total.worst;
    summary.inverted = total.inverted;
    summary.histogram = total.histogram;
    return summary;
}

}  // namespace hex
