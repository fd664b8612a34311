/// \file jacobian.h
/// Whether elements fold: certified bounds of the Jacobian determinant, not samples.
///
/// The determinant of a tensor-product element is a polynomial; in Bernstein form its coefficients enclose it
/// and those at the corners are values. Where coefficients of both signs leave the question open the element
/// is halved in the three directions, adaptively. 27 coefficients for a hexahedron (degree 2 in each
/// parameter), 9 x 9 x 9 for a tricubic element (degree 8), 12 x 12 x 12 for a rational one (the numerator,
/// degree 11). All verdicts take the rounding errors of the computation into account.
/// Sources: Garloff: The Bernstein algorithm, 1993; Johnen, Remacle, Geuzaine: Geometrical validity of
/// curvilinear finite elements, JCP 233, 2013.
#pragma once

#include <hex/base/context.h>
#include <hex/volume/hex_mesh.h>
#include <spline/bezier.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace spline {

/// What is proved of the sign of the Jacobian determinant of an element.
enum class JacobianVerdict : std::uint8_t {
    positive,  ///< proved: positive in the whole element, or zero only on edges and corners named as singular
    negative,  ///< proved: negative at a point
    undecided,  ///< neither, after the subdivisions allowed or where a value is zero within rounding
};

/// How hard to try before an element is left undecided.
struct JacobianOptions {
    int most_subdivisions = 7;      ///< depth of halving, >= 0
    std::size_t most_parts = 2000;  ///< parts of one element that are looked at, at most
};

/// What is known of the Jacobian determinant of one element, for parameters in [0,1]^3.
struct ElementJacobian {
    JacobianVerdict verdict = JacobianVerdict::undecided;  ///< sign of the determinant
    double lower = 0.0;                                    ///< the determinant is nowhere below this
    double smallest = 0.0;                                 ///< the smallest value met: at `at`
    hex::Vec3 at = hex::Vec3::Zero();                      ///< (u, v, w) of `smallest`, in [0,1]^3
    /// Edges (bit e of hexahedron::edge_corners) and corners (bit 12 + c) on which the determinant is zero
    /// within rounding. A smooth boundary edge with one element is so by construction.
    std::uint32_t singular = 0;
};

/// Of a hexahedron, with the corners of hexahedron.h (trilinear map).
ElementJacobian bound_jacobian(const std::array<hex::Vec3, 8>& corners, const JacobianOptions& options = {});
/// Of a tricubic element, point i + 4 j + 16 k.
ElementJacobian bound_jacobian(std::span<const hex::Vec3, 64> points, const JacobianOptions& options = {});
/// Of a rational tricubic element: positions and weights > 0. `lower` and `smallest` are of the determinant
/// times the fourth power of the weight function.
ElementJacobian bound_jacobian(std::span<const BezierPoint, 64> points, const JacobianOptions& options = {});

/// Verdicts of all elements.
struct JacobianReport {
    std::vector<ElementJacobian> elements;  ///< one an element, in their order
    std::size_t positive = 0;               ///< proved positive
    std::size_t singular = 0;               ///< of them, zero on an edge or at a corner
    std::vector<std::int64_t> negative,     ///< elements proved negative somewhere, ascending
        undecided;                          ///< elements of which neither is proved, ascending
    double lower = 0.0;                     ///< least of the lower bounds
    std::int64_t worst = -1;                ///< element that has it

    /// Every element is proved positive.
    bool proved() const { return negative.empty() && undecided.empty(); }
    /// Fills the counts and lists from `elements`.
    void count();
};

/// Bounds the determinant of every element of a spline, as `bound_jacobian` does. The same report for any
/// number of threads. Throws Error{cancelled}.
JacobianReport certify(const BezierSpline& spline, const JacobianOptions& options = {},
                       const hex::Context& context = {});
/// Likewise of every cell of a mesh, as a trilinear hexahedron.
JacobianReport certify(const hex::HexMesh& mesh, const JacobianOptions& options = {},
                       const hex::Context& context = {});

/// "element 7 at (0.5, 0, 1): -0.25" for the first elements proved negative; for messages.
std::string describe_negative(const JacobianReport& report, std::size_t most = 5);

}  // namespace spline
