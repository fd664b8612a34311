/// \file repair.h
/// Moves control points until no element folds: a valid hexahedral mesh is not yet a valid spline.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <spline/bezier.h>
#include <spline/jacobian.h>

#include <cstdint>
#include <vector>

namespace spline {

/// How far and how long `repair_jacobian` may move control points.
struct RepairOptions {
    /// How far a control point that shapes the boundary may move, in percent of the diagonal of all control
    /// points, >= 0. 0: only the inside moves.
    double max_deviation = 1.0;
    /// Rounds of optimisation, >= 1; each later one has more freedom than the one before.
    int most_rounds = 10;
    JacobianOptions jacobian;  ///< effort of the bounds that judge elements
};

/// What `repair_jacobian` has done. The diagonal is that of the bounding box of all control points.
struct RepairReport {
    std::size_t negative_before = 0,     ///< elements proved negative in the given spline
        undecided_before = 0;            ///< elements undecided in the given spline
    std::size_t negative_after = 0,      ///< elements proved negative in the result
        undecided_after = 0;             ///< elements undecided in the result
    std::size_t moved_inside = 0,        ///< control points that do not shape the boundary
        moved_boundary = 0;              ///< control points that shape the boundary
    double largest_inside = 0.0,         ///< longest move of the former, in percent of the diagonal
        largest_boundary = 0.0;          ///< longest move of the latter, in percent of the diagonal
    std::vector<std::int64_t> mended;    ///< elements that were not proved positive and now are, ascending
    std::vector<std::int64_t> unmended;  ///< elements that are still not proved positive
};

/// Minimises a penalty on the Bernstein coefficients of the Jacobian determinants (jacobian_penalty.h) of the
/// elements that are not proved positive, of their neighbours that would suffer, and of the moves: by L-BFGS,
/// each connected group of elements by itself, first with the control points that do not touch the boundary,
/// then with all of them. A group is left as it was unless fewer of its elements are not proved positive
/// then, or as many with a greater sum of their lower bounds.
///
/// `verdict` must be `certify` of the spline and is that of the result. Nothing at all is changed when all
/// elements are proved positive; partition of unity and continuity do not depend on control points. Rational
/// splines are left alone. The same result for any number of threads. Throws Error{usage} for options out of
/// their ranges, Error{cancelled}.
RepairReport repair_jacobian(BezierSpline& spline, JacobianReport& verdict, const RepairOptions& options = {},
                             const hex::Context& context = {});

/// One flag a control point: it moves Bezier points on the boundary (BezierSpline::boundary_patch).
std::vector<char> boundary_functions(const BezierSpline& spline);

}  // namespace spline
