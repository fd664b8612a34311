/// \file quality_numbers.h
/// The nine numbers whose minimum is Verdict's scaled Jacobian, with the gradient of any function of them;
/// written once for one element (`Real` = double) and for several side by side (quality::Wide).
#pragma once

#include "quality/scaled_jacobian_kernel.h"

#include <cmath>

namespace hex::improving {

[[gnu::always_inline]] inline double root(double x) {
    return std::sqrt(x);
}

/// Scaled determinants of the edges at the eight corners, and of the principal axes at the centre. Not a
/// number where an edge has no length.
template <class Real>
struct QualityNumbers {
    static constexpr std::size_t count = 9;
    using Vector = quality::Vector<Real>;

    std::array<Vector, 12> edge;
    std::array<Real, 12> square;   ///< of the length of each edge
    std::array<Real, 12> inverse;  ///< of the length of each edge
    std::array<Vector, 3> axis;
    std::array<Real, 3> axis_inverse;
    std::array<Real, count> value;
    Real zero;

    /// \param one, nothing the numbers 1 and 0
    [[gnu::always_inline]] QualityNumbers(const std::array<Vector, 8>& p, const Real& one,
                                          const Real& nothing)
        : zero(nothing) {
        for (std::size_t e = 0; e < 12; ++e) {
            const auto& ends = hexahedron::edge_corners[e];
            edge[e] = p[static_cast<std::size_t>(ends[1])] - p[static_cast<std::size_t>(ends[0])];
            square[e] = squared_length(edge[e]);
            inverse[e] = one / root(square[e]);
        }
        for (std::size_t k = 0; k < 8; ++k) {
            const auto [a, b, c] = edges_at(k);
            const Real scaled =
                determinant(edge[a], edge[b], edge[c]) * (inverse[a] * inverse[b] * inverse[c]);
            value[k] = quality::corner_edges[k].positive ? scaled : Real(-scaled);
        }
        axis = {quality::principal_axis<Real>(p, {1, 2, 5, 6}, {0, 3, 4, 7}),
                quality::principal_axis<Real>(p, {2, 3, 6, 7}, {0, 1, 4, 5}),
                quality::principal_axis<Real>(p, {4, 5, 6, 7}, {0, 1, 2, 3})};
        for (std::size_t i = 0; i < 3; ++i) axis_inverse[i] = one / root(squared_length(axis[i]));
        value[8] =
            determinant(axis[0], axis[1], axis[2]) * (axis_inverse[0] * axis_inverse[1] * axis_inverse[2]);
    }

    /// Gradient, for each corner's position, of a function whose derivatives for the numbers are `slope`.
    [[gnu::always_inline]] std::array<Vector, 8> gradient(const std::array<Real, count>& slope) const {
        // The derivative of det(a, b, c) / (|a||b||c|) for a is (b x c) / (|a||b||c|) less the number itself
        // times a / |a|^2; the second parts of all numbers are summed before they meet the vector.
        std::array<Vector, 12> along;
        std::array<Real, 12> shrink;
        along.fill({zero, zero, zero});
        shrink.fill(zero);
        for (std::size_t k = 0; k < 8; ++k) {
            const auto [a, b, c] = edges_at(k);
            const Real scaled = slope[k] * (inverse[a] * inverse[b] * inverse[c]);
            const Real factor = quality::corner_edges[k].positive ? scaled : Real(-scaled);
            along[a] = along[a] + factor * cross(edge[b], edge[c]);
            along[b] = along[b] + factor * cross(edge[c], edge[a]);
            along[c] = along[c] + factor * cross(edge[a], edge[b]);
            const Real part = slope[k] * value[k];
            shrink[a] = shrink[a] + part;
            shrink[b] = shrink[b] + part;
            shrink[c] = shrink[c] + part;
        }
        const Real factor = slope[8] * (axis_inverse[0] * axis_inverse[1] * axis_inverse[2]);
        const Real part = slope[8] * value[8];
        std::array<Vector, 3> centre;
        for (std::size_t i = 0; i < 3; ++i)
            centre[i] = factor * cross(axis[(i + 1) % 3], axis[(i + 2) % 3]) -
                        (part * (axis_inverse[i] * axis_inverse[i])) * axis[i];
        std::array<Vector, 8> result;
        for (std::size_t k = 0; k < 8; ++k) {
            const auto& uvw = hexahedron::corner_uvw[k];
            result[k] = {zero, zero, zero};
            for (std::size_t i = 0; i < 3; ++i)
                result[k] = uvw[i] == 1 ? result[k] + centre[i] : result[k] - centre[i];
        }
        for (std::size_t e = 0; e < 12; ++e) {
            const Vector own = along[e] - (shrink[e] * (inverse[e] * inverse[e])) * edge[e];
            const auto& ends = hexahedron::edge_corners[e];
            Vector& head = result[static_cast<std::size_t>(ends[1])];
            Vector& tail = result[static_cast<std::size_t>(ends[0])];
            head = head + own;
            tail = tail - own;
        }
        return result;
    }

  private:
    [[gnu::always_inline]] static std::array<std::size_t, 3> edges_at(std::size_t corner) {
        const auto& e = quality::corner_edges[corner].edge;
        return {static_cast<std::size_t>(e[0]), static_cast<std::size_t>(e[1]),
                static_cast<std::size_t>(e[2])};
    }
};

}  // namespace hex::improving
