/// \file fit.h
/// Moves control points so that the boundary of the spline lies on the part.
///
/// The boundary of a spline built on a mesh lies inside the mesh's (docs/spline.md). Fitting is least squares
/// with a fairness term, boundary first, then inside, and no element that was proved positive folds.
#pragma once

#include <hex/base/context.h>
#include <hex/surface/mesh_types.h>
#include <spline/bezier.h>
#include <spline/jacobian.h>

namespace spline {

/// Distances between the boundary of a spline and a surface, at samples: 5 x 5 of each boundary face;
/// vertices and triangle centres of the surface (of large ones evenly many, 60,000 at most). In the unit of
/// the positions; every sample counts alike in a root mean square.
struct FitDistance {
    double to_surface_rms = 0.0,    ///< of the spline's boundary from the surface: root mean square
        to_surface_max = 0.0;       ///< of the spline's boundary from the surface: the largest
    double from_surface_rms = 0.0,  ///< of the surface from the spline's boundary: root mean square
        from_surface_max = 0.0;     ///< of the surface from the spline's boundary: the largest
};

/// How long `fit` works, how smooth its moves are, and how elements are judged.
struct FitOptions {
    int rounds = 16;         ///< closest points are looked up anew in each, >= 1
    double fairness = 1e-5;  ///< weight of differences of moves against distances, > 0
    /// Effort of the bounds that judge elements: that with which the given verdict was made.
    JacobianOptions jacobian;
};

/// What `fit` has done to a spline.
struct FitReport {
    FitDistance before,                ///< of the spline as it was given
        after;                         ///< of the fitted spline
    std::size_t moved = 0;             ///< control points
    double largest_move = 0.0;         ///< of a control point, in the unit of the positions
    std::size_t held_back = 0;         ///< control points that had to stay (partly), or an element would fold
    std::vector<std::int64_t> folded;  ///< elements proved positive before but not after: always empty
};

/// `verdict` must be `certify` of the spline, and is that of the result. Throws Error{unsupported} for
/// rational splines and for those whose boundary is not known (BezierSpline::boundary_patch). The same result
/// for any number of threads. Throws Error{usage} for options out of their ranges.
FitReport fit(BezierSpline& spline, JacobianReport& verdict, const hex::TriangleMesh& surface,
              const FitOptions& options = {}, const hex::Context& context = {});

/// How far each element is off: the largest distance of its samples from the surface, and of the surface's
/// samples that are closest to it; -1 for elements without a face on the boundary. Throws as `fit`.
std::vector<double> fit_errors(const BezierSpline& spline, const hex::TriangleMesh& surface,
                               const hex::Context& context = {});

/// Only measures. Throws as `fit`.
FitDistance fit_distance(const BezierSpline& spline, const hex::TriangleMesh& surface,
                         const hex::Context& context = {});

}  // namespace spline
