/// \file scaled_jacobian_kernel.h
/// The arithmetic of the scaled Jacobian, written once for one element (`Real` = double) and for several side
/// by side (`Real` = a fixed-size Eigen array, or the processor's wide numbers), with the same operations in
/// the same order and so the same bits. Everything is inlined, so that a caller compiled for a newer
/// processor gets all of it compiled for that processor.
#pragma once

#include "quality/vector.h"

#include <hex/volume/hexahedron.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hex::quality {

inline constexpr int lane_count = 4;
/// One number of each of `lane_count` elements.
using Lanes = Eigen::Array<double, lane_count, 1>;

template <class Real>
[[gnu::always_inline]] inline Vector<Real> difference(const Vector<Real>& a, const Vector<Real>& b) {
    return a - b;
}

[[gnu::always_inline]] inline double smaller(double a, double b) {
    return std::min(a, b);
}
[[gnu::always_inline]] inline Lanes smaller(const Lanes& a, const Lanes& b) {
    return a.min(b);
}

/// The largest square of three lengths that is a number: beyond it the elements are too large to be measured.
inline constexpr double largest_square = std::numeric_limits<double>::max();

/// numerator / sqrt(square), and 0 where the square is not positive or overflows.
[[gnu::always_inline]] inline double over_root(double numerator, double square) {
    return square > 0.0 && square <= largest_square ? numerator / std::sqrt(square) : 0.0;
}
[[gnu::always_inline]] inline Lanes over_root(const Lanes& numerator, const Lanes& square) {
    return (square > 0.0 && square <= largest_square).select(numerator / square.sqrt(), Lanes::Zero());
}

/// The three edges at a corner in right-handed order, and whether an even number of them points away from it.
struct CornerEdges {
    std::array<int, 3> edge;
    bool positive;
};

constexpr std::array<CornerEdges, 8> make_corner_edges() {
    std::array<CornerEdges, 8> table{};
    for (int c = 0; c < 8; ++c) {
        bool positive = true;
        for (int i = 0; i < 3; ++i) {
            const int e = hexahedron::edge_between(c, hexahedron::corner_neighbours[c][i]);
            table[c].edge[i] = e;
            if (hexahedron::edge_corners[e][0] != c) positive = !positive;
        }
        table[c].positive = positive;
    }
    return table;
}
inline constexpr std::array<CornerEdges, 8> corner_edges = make_corner_edges();

/// det(a,b,c) / (|a||b||c|), 0 when one of them has no length.
template <class Real>
[[gnu::always_inline]] inline Real scaled_determinant(const Vector<Real>& a, const Vector<Real>& b,
                                                      const Vector<Real>& c) {
    const Real square = squared_length(a) * squared_length(b) * squared_length(c);
    return over_root(Real(determinant(a, b, c)), square);
}

/// The corners a less the corners b, one after the other as Verdict adds them.
template <class Real>
[[gnu::always_inline]] inline Vector<Real> principal_axis(const std::array<Vector<Real>, 8>& p,
                                                          const std::array<std::size_t, 4>& a,
                                                          const std::array<std::size_t, 4>& b) {
    return p[a[0]] + p[a[1]] + p[a[2]] + p[a[3]] - p[b[0]] - p[b[1]] - p[b[2]] - p[b[3]];
}

/// Of the principal axes: four times the derivatives of the trilinear map at the centre.
template <class Real>
[[gnu::always_inline]] inline Real centre_scaled_jacobian(const std::array<Vector<Real>, 8>& p) {
    return scaled_determinant<Real>(principal_axis<Real>(p, {1, 2, 5, 6}, {0, 3, 4, 7}),
                                    principal_axis<Real>(p, {2, 3, 6, 7}, {0, 1, 4, 5}),
                                    principal_axis<Real>(p, {4, 5, 6, 7}, {0, 1, 2, 3}));
}

/// Smallest of the eight corners' scaled Jacobians and the centre's.
template <class Real>
[[gnu::always_inline]] inline Real scaled_jacobian(const std::array<Vector<Real>, 8>& p) {
    std::array<Vector<Real>, 12> edge;
    std::array<Real, 12> square;
    for (std::size_t e = 0; e < 12; ++e) {
        const auto& ends = hexahedron::edge_corners[e];
        edge[e] = p[static_cast<std::size_t>(ends[1])] - p[static_cast<std::size_t>(ends[0])];
        square[e] = squared_length(edge[e]);
    }
    Real smallest = centre_scaled_jacobian(p);
    for (const CornerEdges& corner : corner_edges) {
        const auto a = static_cast<std::size_t>(corner.edge[0]);
        const auto b = static_cast<std::size_t>(corner.edge[1]);
        const auto c = static_cast<std::size_t>(corner.edge[2]);
        const Real det = determinant(edge[a], edge[b], edge[c]);
        const Real signed_det = corner.positive ? Real(det) : Real(-det);
        smallest = smaller(smallest, over_root(signed_det, Real(square[a] * square[b] * square[c])));
    }
    return smallest;
}

}  // namespace hex::quality
