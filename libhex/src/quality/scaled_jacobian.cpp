#include "quality/scaled_jacobian_kernel.h"
#include "quality/scaled_jacobian_range.h"

#include <hex/base/parallel.h>
#include <hex/quality/scaled_jacobian.h>

namespace hex {
namespace {

quality::Vector<double> vector_of(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}

/// Without opening a task arena of its own.
std::vector<double> compute_scaled_jacobians(const HexMesh& mesh, const Context& context) {
    static const quality::RangeFunction wide = quality::scaled_jacobians_avx2();
    const quality::RangeFunction fill = wide != nullptr ? wide : quality::scaled_jacobians_portable;
    constexpr std::size_t chunk = 1024, chunks_between_looks = 1024;
    std::vector<double> values(mesh.cell_count());
    const std::size_t chunks = (values.size() + chunk - 1) / chunk;
    for (std::size_t first = 0; first < chunks; first += chunks_between_looks) {
        context.check_cancelled();
        parallel_for(
            std::min(chunks_between_looks, chunks - first),
            [&](std::size_t i) {
                const std::size_t start = (first + i) * chunk;
                fill(mesh, start, std::min(start + chunk, values.size()), values);
            },
            4);
    }
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
    return with_threads(context, [&] { return compute_scaled_jacobians(mesh, context); });
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
