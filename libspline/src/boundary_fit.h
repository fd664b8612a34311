/// \file boundary_fit.h
/// What pulls the boundary of a spline to a part, as terms of a sum of squares, and how far off it is.
#pragma once

#include "boundary_samples.h"
#include "least_squares.h"
#include "part_targets.h"

#include <spline/fit.h>

#include <span>
#include <vector>

namespace spline {

/// Rows over the control points; their residuals at the present positions; metrics with their weights.
struct SquareTerms {
    SparseRows rows;
    std::vector<hex::Vec3> residuals;
    std::vector<SquareMetric> metrics;
};

/// Differences of Bezier points at the ends of elements' edges, of all or of those on the boundary.
SparseRows edge_differences(const BezierSpline& spline, bool boundary_only);

/// Not thread-safe: remembers where the last searches ended.
class BoundaryFit {
  public:
    BoundaryFit(const BezierSpline& spline, const hex::TriangleMesh& surface);

    FitDistance measure(std::span<const hex::Vec3> control_points);
    /// The largest distance at each element, -1 without boundary.
    std::vector<double> errors_of_elements(std::span<const hex::Vec3> control_points);

    /// Samples of the boundary to their closest points of the part, samples of the part to theirs of the
    /// boundary, creases to sharp edges. The weights sum to about 1. Far samples count up to `emphasis`
    /// times more than near ones.
    SquareTerms pulls(std::span<const hex::Vec3> control_points, double emphasis);

  private:
    struct Found;
    Found search(std::span<const hex::Vec3> control_points);
    void pull_creases(std::span<const hex::Vec3> control_points, SquareTerms& terms) const;

    const BezierSpline& spline_;
    Part part_;
    std::vector<BoundaryFace> faces_;
    std::vector<BoundaryPlace> grid_;
    SparseRows grid_rows_;
    std::vector<BoundaryPlace> crease_places_;  ///< samples_a_side of each edge
    SparseRows crease_rows_;
    std::vector<std::uint32_t> hint_of_grid_, hint_of_part_;
};

}  // namespace spline
