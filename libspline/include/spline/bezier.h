/// \file bezier.h
/// A spline by Bezier extraction: control points, Bezier points as combinations of them, elements as 64
/// Bezier points each. What an analysis code needs; where it came from no longer matters.
///
/// Points of an element: i + 4 j + 16 k at (i,j,k)/3 along its axes (u,v,w) (hex/volume/hexahedron.h).
#pragma once

#include <hex/base/linear_algebra.h>
#include <spline/sparse_rows.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace spline {

/// x, y, z (not multiplied by the weight) and weight of a Bezier point.
using BezierPoint = Eigen::Vector4d;

/// Tricubic Bezier elements over shared control points. A Bezier point that several elements share is stored
/// once when the spline was built here; a spline read from a file has 64 points an element.
struct BezierSpline {
    std::vector<hex::Vec3> control_points;  ///< positions, one a function
    std::vector<double> weights;            ///< > 0, one a control point; all 1 for a polynomial spline
    SparseRows rows;                        ///< of each Bezier point, over the control points (a row of M T)
    /// Bezier points of each element as rows of `rows`, point i + 4 j + 16 k.
    std::vector<std::array<std::uint32_t, 64>> elements;

    std::vector<std::uint16_t> element_level;  ///< of the hierarchy; 0 when not known
    std::vector<std::uint32_t> element_cell;   ///< cell in the mesh of that level
    /// Patch of the solid's boundary on which each local face of the element lies, -1 inside: boundary quads
    /// that hang together across smooth edges are one patch. Empty when not known.
    std::vector<std::array<std::int32_t, 6>> boundary_patch;

    /// Number of Bezier elements.
    std::size_t element_count() const { return elements.size(); }
    /// Number of spline functions: each control point has one.
    std::size_t function_count() const { return control_points.size(); }
    /// Whether any weight is other than 1 (exactly).
    bool rational() const;
};

/// Finds the control points that shape an element; holds its working memory. One object a thread.
class ElementFunctions {
  public:
    /// The control points of an element, ascending. Valid until the next call.
    std::span<const std::uint32_t> operator()(const BezierSpline& spline, std::size_t element);
    /// For every term of the element's rows, its points one after the other, the place of its control point
    /// in the answer above.
    std::span<const std::uint32_t> place_of_terms() const { return terms_; }

  private:
    struct Entry {
        std::uint32_t function, place;
    };
    std::vector<Entry> table_, found_;
    std::vector<std::uint32_t> functions_, terms_, rank_;
};

/// The extraction of one element: rows of M^T.
struct ElementExtraction {
    std::vector<std::uint32_t> functions;              ///< ascending; each has a coefficient that is not zero
    std::vector<std::array<double, 64>> coefficients;  ///< Bernstein coefficients of each function
};

/// Gathers the extraction of elements one after the other; holds its working memory. One object a thread.
class ExtractionGatherer {
  public:
    /// Keeps a reference: `spline` must outlive the object.
    explicit ExtractionGatherer(const BezierSpline& spline) : spline_(spline) {}
    /// Valid until the next call.
    const ElementExtraction& operator()(std::size_t element);

  private:
    const BezierSpline& spline_;
    ElementExtraction extraction_;
    ElementFunctions functions_of_;
};

/// Position (x, y, z) and weight of every Bezier point.
std::vector<BezierPoint> bezier_points(const BezierSpline& spline);

/// Point of an element at (u, v, w) in [0,1]^3, and its first derivatives.
struct ElementPoint {
    hex::Vec3 point;           ///< its position
    Eigen::Matrix3d jacobian;  ///< column a is the derivative by the a-th parameter
};

/// `points` as made by `bezier_points`.
ElementPoint evaluate(const BezierSpline& spline, const std::vector<BezierPoint>& points, std::size_t element,
                      const hex::Vec3& uvw);

/// The four cubic Bernstein polynomials at t in [0,1]; they sum to 1.
std::array<double, 4> bernstein(double t);
/// First derivatives of the four at t; they sum to 0.
std::array<double, 4> bernstein_derivative(double t);

/// Figures that tell whether a spline is sound.
struct BezierSummary {
    std::size_t control_points = 0;         ///< of the spline, used by an element or not
    std::size_t elements = 0;               ///< of the spline, all levels together
    std::size_t functions_min = 0,          ///< fewest functions of an element
        functions_max = 0;                  ///< most functions of an element
    double functions_mean = 0.0;            ///< mean number of functions of an element
    double partition_of_unity_error = 0.0;  ///< largest |sum of coefficients - 1| of a Bezier point
    double smallest_coefficient = 0.0;      ///< of any row; > 0 for a spline built here
};
/// Looks at every element and every row. Of a spline without elements all but `control_points` is 0.
BezierSummary summarize(const BezierSpline& spline);

}  // namespace spline
