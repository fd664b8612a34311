// Compiled with -fno-math-errno, which lets square roots be taken side by side; their values are the same.
#include "quality/scaled_jacobian_range.h"

#include "quality/scaled_jacobian_kernel.h"

namespace hex::quality {
namespace {

/// Four numbers side by side: one register with AVX2, two without. A class, so that the kernel finds the
/// functions below by its arguments.
struct Wide {
    using Numbers = double __attribute__((vector_size(32)));
    Numbers n;
};
constexpr std::size_t width = 4;

[[gnu::always_inline]] inline Wide operator+(const Wide& a, const Wide& b) {
    return {a.n + b.n};
}
[[gnu::always_inline]] inline Wide operator-(const Wide& a, const Wide& b) {
    return {a.n - b.n};
}
[[gnu::always_inline]] inline Wide operator*(const Wide& a, const Wide& b) {
    return {a.n * b.n};
}
[[gnu::always_inline]] inline Wide operator-(const Wide& a) {
    return {-a.n};
}
[[gnu::always_inline]] inline Wide smaller(const Wide& a, const Wide& b) {
    return {b.n < a.n ? b.n : a.n};
}
[[gnu::always_inline]] inline Wide over_root(const Wide& numerator, const Wide& square) {
    const Wide::Numbers root = {__builtin_sqrt(square.n[0]), __builtin_sqrt(square.n[1]),
                                __builtin_sqrt(square.n[2]), __builtin_sqrt(square.n[3])};
    const Wide::Numbers zero = {};
    return {(square.n > zero) & (square.n <= zero + largest_square) ? numerator.n / root : zero};
}

/// A short last block repeats its last cell.
[[gnu::always_inline]] inline void fill_range(const HexMesh& mesh, std::size_t first, std::size_t last,
                                              std::span<double> values) {
    const Vec3* const points = mesh.positions().data();
    const HexCell* const cells = mesh.cell_array().data();
    for (std::size_t start = first; start < last; start += width) {
        const std::size_t count = std::min(width, last - start);
        const HexCell& a = cells[start];
        const HexCell& b = cells[start + std::min<std::size_t>(1, count - 1)];
        const HexCell& c = cells[start + std::min<std::size_t>(2, count - 1)];
        const HexCell& d = cells[start + std::min<std::size_t>(3, count - 1)];
        std::array<Vector<Wide>, 8> corners{};
        for (std::size_t i = 0; i < 8; ++i) {
            const double* const pa = points[a[i].index()].data();
            const double* const pb = points[b[i].index()].data();
            const double* const pc = points[c[i].index()].data();
            const double* const pd = points[d[i].index()].data();
            corners[i] = Vector<Wide>{{Wide::Numbers{pa[0], pb[0], pc[0], pd[0]}},
                                      {Wide::Numbers{pa[1], pb[1], pc[1], pd[1]}},
                                      {Wide::Numbers{pa[2], pb[2], pc[2], pd[2]}}};
        }
        const Wide result = scaled_jacobian<Wide>(corners);
        for (std::size_t i = 0; i < count; ++i) values[start + i] = result.n[i];
    }
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void fill_avx2(const HexMesh& mesh, std::size_t first, std::size_t last,
                                       std::span<double> values) {
    fill_range(mesh, first, last, values);
}
#endif

}  // namespace

void scaled_jacobians_portable(const HexMesh& mesh, std::size_t first, std::size_t last,
                               std::span<double> values) {
    fill_range(mesh, first, last, values);
}

RangeFunction scaled_jacobians_avx2() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return fill_avx2;
#endif
    return nullptr;
}

}  // namespace hex::quality
