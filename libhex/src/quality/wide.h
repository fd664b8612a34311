/// \file wide.h
/// Four numbers side by side, for files that are compiled for several kinds of processors. Include only in
/// .cpp files compiled with -fno-math-errno (square roots side by side) and -Wno-psabi.
#pragma once

#include "quality/scaled_jacobian_kernel.h"

#include <hex/volume/hex_mesh.h>

#include <array>
#include <cmath>

namespace hex::quality {

/// One register with AVX2, two without; the same bits. A class, so that templates find the functions below by
/// their arguments.
struct Wide {
    using Numbers = double __attribute__((vector_size(32)));
    Numbers n;
};
inline constexpr std::size_t wide_count = 4;

[[gnu::always_inline]] inline Wide operator+(const Wide& a, const Wide& b) {
    return {a.n + b.n};
}
[[gnu::always_inline]] inline Wide operator-(const Wide& a, const Wide& b) {
    return {a.n - b.n};
}
[[gnu::always_inline]] inline Wide operator*(const Wide& a, const Wide& b) {
    return {a.n * b.n};
}
[[gnu::always_inline]] inline Wide operator/(const Wide& a, const Wide& b) {
    return {a.n / b.n};
}
[[gnu::always_inline]] inline Wide operator-(const Wide& a) {
    return {-a.n};
}
[[gnu::always_inline]] inline Wide smaller(const Wide& a, const Wide& b) {
    return {b.n < a.n ? b.n : a.n};
}
[[gnu::always_inline]] inline Wide larger(const Wide& a, const Wide& b) {
    return {b.n > a.n ? b.n : a.n};
}
[[gnu::always_inline]] inline Wide root(const Wide& a) {
    return {Wide::Numbers{__builtin_sqrt(a.n[0]), __builtin_sqrt(a.n[1]), __builtin_sqrt(a.n[2]),
                          __builtin_sqrt(a.n[3])}};
}

[[gnu::always_inline]] inline Wide over_root(const Wide& numerator, const Wide& square) {
    const Wide::Numbers zero = {};
    return {(square.n > zero) & (square.n <= zero + largest_square) ? numerator.n / root(square).n : zero};
}

/// Corners of the cells first .. first + count - 1, 1 <= count <= wide_count; the last is repeated.
[[gnu::always_inline]] inline std::array<Vector<Wide>, 8> gather_corners(const HexMesh& mesh,
                                                                         std::size_t first,
                                                                         std::size_t count) {
    const Vec3* const points = mesh.positions().data();
    const HexCell* const cells = mesh.cell_array().data() + first;
    const HexCell& a = cells[0];
    const HexCell& b = cells[count > 1 ? 1 : 0];
    const HexCell& c = cells[count > 2 ? 2 : count - 1];
    const HexCell& d = cells[count - 1];
    std::array<Vector<Wide>, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        const double* const pa = points[a[i].index()].data();
        const double* const pb = points[b[i].index()].data();
        const double* const pc = points[c[i].index()].data();
        const double* const pd = points[d[i].index()].data();
        corners[i] = Vector<Wide>{{Wide::Numbers{pa[0], pb[0], pc[0], pd[0]}},
                                  {Wide::Numbers{pa[1], pb[1], pc[1], pd[1]}},
                                  {Wide::Numbers{pa[2], pb[2], pc[2], pd[2]}}};
    }
    return corners;
}

/// Begins to fetch the corners of the cells first .. last - 1, so that the processor need not wait for them
/// when they are gathered.
[[gnu::always_inline]] inline void fetch_corners(const HexMesh& mesh, std::size_t first, std::size_t last) {
    const Vec3* const points = mesh.positions().data();
    const HexCell* const cells = mesh.cell_array().data();
    for (std::size_t cell = first; cell < last; ++cell)
        for (const VertexId v : cells[cell]) __builtin_prefetch(points + v.index());
}

}  // namespace hex::quality
