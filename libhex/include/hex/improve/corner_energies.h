/// \file corner_energies.h
/// The energies that `untangle` and `auto` minimise, for one hexahedron.
///
/// A corner tetrahedron is spanned by the three edges a, b, c at a corner in right-handed order, divided by
/// the three lengths of a reference box; it is right-angled and of the wished size when (a b c) is a
/// rotation.
#pragma once

#include <hex/base/linear_algebra.h>

#include <array>

namespace hex {

/// Positions of the corners of a hexahedron, or a vector for each of them, in the order of hexahedron.h.
using HexCorners = std::array<Vec3, 8>;

/// Foldover-free energy (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov: Foldover-free maps in 50
/// lines of code, ACM TOG 40(4), 2021, eq. 4 and 5): with J = (a b c), D = det J and chi(D) = (D +
/// sqrt(epsilon^2 + D^2)) / 2, the sum over the corners of
///     tr(J^T J) / chi^(2/3) + size_weight (D^2 + 1) / chi.
/// Finite for any D while epsilon > 0; with epsilon = 0 it is infinite (returned as infinity) unless D > 0 at
/// every corner. Its minimum, 3 + 2 size_weight a corner, is the reference box.
struct FoldoverEnergy {
    double epsilon = 0.0;      ///< regularisation, >= 0
    double size_weight = 1.0;  ///< of the term that keeps the size, >= 0
    /// Value; the gradient for each corner's position is added to `gradient` unless that is null.
    /// \param reference lengths of the reference box along u, v, w, > 0
    double evaluate(const HexCorners& corners, const Vec3& reference, HexCorners* gradient) const;
    /// Smallest D of the eight corners.
    static double smallest_determinant(const HexCorners& corners, const Vec3& reference);
};

/// Logarithmic barrier of Verdict's scaled Jacobian: the sum of -log(q - floor) over the nine numbers q
/// (eight corners and the centre) whose minimum is the scaled Jacobian. Minimising it while `floor` follows
/// the worst q from below raises the minimum (method of centres; Huard 1967); infinite unless all q > floor.
struct QualityBarrier {
    double floor = -1.0;  ///< < 1
    /// Value; the gradient for each corner's position is added to `gradient` unless that is null or the value
    /// is infinite.
    double evaluate(const HexCorners& corners, HexCorners* gradient) const;
};

/// How far a hexahedron's scaled Jacobian is from 1, in a form that can be derived: the sixth root of the sum
/// of (1 - q)^6 over the same nine numbers q, and barrier_weight times the barrier, which keeps all of them
/// above `floor`. Minimising the sum over a mesh raises the mean.
struct QualityMean {
    double floor = -1.0;           ///< < 1
    double barrier_weight = 0.01;  ///< >= 0
    /// Value, infinite unless all q > floor; the gradient for each corner's position is added to `gradient`
    /// unless that is null or the value is infinite.
    double evaluate(const HexCorners& corners, HexCorners* gradient) const;
};

/// Keeps edges from vanishing, which a scaled Jacobian, free of scale, does not mind: the sum over the twelve
/// edges of weight max(0, log(share L / l))^2, l the length of the edge, L that of the reference box along
/// it. Nothing for edges longer than `share` of the reference, infinite for those without length.
struct ShortEdgeEnergy {
    double share = 0.2;   ///< > 0
    double weight = 1.0;  ///< >= 0
    /// Value; the gradient for each corner's position is added to `gradient` unless that is null.
    /// \param reference lengths of the reference box along u, v, w, > 0
    double evaluate(const HexCorners& corners, const Vec3& reference, HexCorners* gradient) const;
};

}  // namespace hex
