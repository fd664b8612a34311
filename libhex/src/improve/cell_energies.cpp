// Compiled with -fno-math-errno, which lets square roots be taken side by side; their values are the same.
#include "improve/cell_energies.h"

#include "improve/quality_numbers.h"
#include "quality/wide.h"

#include <algorithm>
#include <limits>

namespace hex::improving {
namespace {

using quality::Wide;
using quality::wide_count;
using Numbers = QualityNumbers<Wide>;

/// What the loops below need of the energy, by value.
struct Settings {
    double floor, mean_weight, barrier_weight;
    ShortEdgeEnergy short_edges;
};

[[gnu::always_inline]] inline Wide all(double x) {
    return {Wide::Numbers{x, x, x, x}};
}

/// Adds the energy of short edges where there are any.
void add_short_edges(const HexMesh& mesh, std::size_t cell, const Settings& settings, const Vec3& box,
                     double& value, HexCorners* gradient) {
    value += settings.short_edges.evaluate(mesh.corner_positions(CellId(cell)), box, gradient);
}

[[gnu::always_inline]] inline Wide pow5(const Wide& x) {
    const Wide square = x * x;
    return square * square * x;
}

[[gnu::always_inline]] inline void evaluate_range(const HexMesh& mesh, std::size_t first, std::size_t last,
                                                  const Settings& settings, const Vec3* boxes, double* values,
                                                  HexCorners* gradients) {
    constexpr std::array<std::size_t, 12> axis_of_edge = {0, 1, 0, 1, 2, 2, 2, 2, 0, 1, 0, 1};
    const Wide one = all(1.0);
    const Wide zero = all(0.0);
    for (std::size_t start = first; start < last; start += wide_count) {
        const std::size_t count = std::min(wide_count, last - start);
        const Numbers numbers(quality::gather_corners(mesh, start, count), one, zero);

        std::array<Wide, Numbers::count> gap;
        Wide smallest_gap = numbers.value[0] - all(settings.floor);
        Wide product = one;
        Wide sum = all(1e-18);  // the root below has no slope at 0
        for (std::size_t k = 0; k < Numbers::count; ++k) {
            gap[k] = numbers.value[k] - all(settings.floor);
            smallest_gap = smaller(smallest_gap, gap[k]);
            product = product * gap[k];
            const Wide defect = one - numbers.value[k];
            sum = sum + pow5(defect) * defect;
        }
        Wide norm = zero;
        Wide norm_slope = zero;
        if (settings.mean_weight > 0.0) {
            for (std::size_t i = 0; i < wide_count; ++i)
                norm.n[i] = settings.mean_weight * std::cbrt(std::sqrt(sum.n[i]));
            norm_slope = norm / sum;
        }
        std::array<double, wide_count> value;
        std::array<bool, wide_count> finite;
        for (std::size_t i = 0; i < wide_count; ++i) {
            // Comparisons with what is not a number are false.
            finite[i] = smallest_gap.n[i] > 0.0 && product.n[i] > 0.0;
            value[i] = finite[i] ? norm.n[i] - settings.barrier_weight * std::log(product.n[i])
                                 : std::numeric_limits<double>::infinity();
        }
        if (gradients != nullptr) {
            std::array<Wide, Numbers::count> slope;
            for (std::size_t k = 0; k < Numbers::count; ++k)
                slope[k] =
                    -(norm_slope * pow5(one - numbers.value[k])) - all(settings.barrier_weight) / gap[k];
            const auto gradient = numbers.gradient(slope);
            for (std::size_t i = 0; i < count; ++i) {
                HexCorners& own = gradients[start + i];
                for (std::size_t k = 0; k < 8; ++k)
                    own[k] = Vec3(gradient[k].x.n[i], gradient[k].y.n[i], gradient[k].z.n[i]);
            }
        }
        std::array<Wide, 3> box;
        for (Eigen::Index d = 0; d < 3; ++d) {
            const auto side = [&](std::size_t i) { return boxes[start + std::min(i, count - 1)][d]; };
            box[static_cast<std::size_t>(d)] = {Wide::Numbers{side(0), side(1), side(2), side(3)}};
            box[static_cast<std::size_t>(d)] =
                all(settings.short_edges.share) * box[static_cast<std::size_t>(d)];
        }
        Wide most_crushed = zero;  // wanted over present length of an edge
        for (std::size_t e = 0; e < 12; ++e)
            most_crushed = larger(most_crushed, box[axis_of_edge[e]] * numbers.inverse[e]);
        for (std::size_t i = 0; i < count; ++i) {
            if (finite[i] && most_crushed.n[i] > 1.0)
                add_short_edges(mesh, start + i, settings, boxes[start + i], value[i],
                                gradients != nullptr ? &gradients[start + i] : nullptr);
            values[start + i] = value[i];
        }
    }
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void evaluate_avx2(const HexMesh& mesh, std::size_t first, std::size_t last,
                                           const Settings& settings, const Vec3* boxes, double* values,
                                           HexCorners* gradients) {
    evaluate_range(mesh, first, last, settings, boxes, values, gradients);
}
#endif

void evaluate_portable(const HexMesh& mesh, std::size_t first, std::size_t last, const Settings& settings,
                       const Vec3* boxes, double* values, HexCorners* gradients) {
    evaluate_range(mesh, first, last, settings, boxes, values, gradients);
}

using RangeFunction = decltype(&evaluate_portable);

RangeFunction widest() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return evaluate_avx2;
#endif
    return evaluate_portable;
}

}  // namespace

void QualityMeshEnergy::evaluate(const HexMesh& mesh, std::size_t first, std::size_t last,
                                 std::span<double> values, HexCorners* gradients) const {
    static const RangeFunction range = widest();
    range(mesh, first, last, {floor, mean_weight, barrier_weight, short_edges}, boxes_.data(), values.data(),
          gradients);
}

}  // namespace hex::improving
