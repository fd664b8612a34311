// Compiled with -fno-math-errno, which lets square roots be taken side by side; their values are the same.
#include "quality/scaled_jacobian_range.h"

#include "quality/scaled_jacobian_kernel.h"
#include "quality/wide.h"

namespace hex::quality {
namespace {

/// How many cells before their turn the corners are fetched: far enough to hide how long memory takes where
/// the vertices are in no order. Only the time depends on it: twice as fast there, the same where neighbours
/// have neighbouring numbers.
constexpr std::size_t ahead = 16;

[[gnu::always_inline]] inline void fill_range(const HexMesh& mesh, std::size_t first, std::size_t last,
                                              std::span<double> values) {
    for (std::size_t start = first; start < last; start += wide_count) {
        fetch_corners(mesh, std::min(start + ahead, last), std::min(start + ahead + wide_count, last));
        const std::size_t count = std::min(wide_count, last - start);
        const Wide result = scaled_jacobian<Wide>(gather_corners(mesh, start, count));
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
