/// \file scaled_jacobian_kernel.h
/// The arithmetic of the scaled Jacobian, written once for one element (`Real` = double) and for several side
/// by side (`Real` = a fixed-size Eigen array), with the same operations in the same order and so the same
/// bits.
#pragma once

#include <hex/volume/hexahedron.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

namespace hex::quality {

inline constexpr int lane_count = 4;
/// One number of each of `lane_count` elements.
using Lanes = Eigen::Array<double, lane_count, 1>;

template <class Real>
struct Vector {
    Real x, y, z;
};

template <class Real>
Vector<Real> difference(const Vector<Real>& a, const Vector<Real>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Real>
Real squared_length(const Vector<Real>& a) {
    return a.x * a.x + a.y * a.y + a.z * a.z;
}

template <class Real>
Real determinant(const Vector<Real>& a, const Vector<Real>& b, const Vector<Real>& c) {
    return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

inline double smaller(double a, double b) {
    return std::min(a, b);
}
inline Lanes smaller(const Lanes& a, const Lanes& b) {
    return a.min(b);
}

/// numerator / sqrt(square), and 0 where the square is not positive.
inline double over_root(double numerator, double square) {
    return square > 0.0 ? numerator / std::sqrt(square) : 0.0;
}
inline Lanes over_root(const Lanes& numerator, const Lanes& square) {
    return (square > 0.0).select(numerator / square.sqrt(), Lanes::Zero());
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
Real scaled_determinant(const Vector<Real>& a, const Vector<Real>& b, const Vector<Real>& c) {
    const Real square = squared_length(a) * squared_length(b) * squared_length(c);
    return over_root(determinant(a, b, c), square);
}

/// The principal axes of the trilinear map at the centre, times four: sums of the four edges of a direction.
template <class Real>
Real centre_scaled_jacobian(const std::array<Vector<Real>, 8>& p) {
    const auto axis = [&](int a0, int a1, int a2, int a3, int b0, int b1, int b2, int b3) {
        const auto component = [&](auto member) -> Real {
            const auto at = [&](int i) -> const Real& { return p[static_cast<std::size_t>(i)].*member; };
            return (at(a0) + at(a1) + at(a2) + at(a3)) - (at(b0) + at(b1) + at(b2) + at(b3));
        };
        return Vector<Real>{component(&Vector<Real>::x), component(&Vector<Real>::y),
                            component(&Vector<Real>::z)};
    };
    return scaled_determinant<Real>(axis(1, 2, 5, 6, 0, 3, 4, 7), axis(2, 3, 6, 7, 0, 1, 4, 5),
                                    axis(4, 5, 6, 7, 0, 1, 2, 3));
}

/// Smallest of the eight corners' scaled Jacobians and the centre's.
template <class Real>
Real scaled_jacobian(const std::array<Vector<Real>, 8>& p) {
    std::array<Vector<Real>, 12> edge;
    std::array<Real, 12> square;
    for (std::size_t e = 0; e < 12; ++e) {
        const auto& ends = hexahedron::edge_corners[e];
        edge[e] = difference(p[static_cast<std::size_t>(ends[1])], p[static_cast<std::size_t>(ends[0])]);
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
