/// \file hex_metrics.h
/// Every metric that the Verdict library has for hexahedra, with its names and definitions, and a few more
/// that finite element codes ask for.
/// Source: Knupp, Ernst, Thompson, Stimpson, Pebay: The Verdict geometric quality library, SAND2007-1751, and
/// the implementation in VTK 9.1, whose numbers these equal (docs/check.md says where it differs from the
/// report).
#pragma once

#include <hex/base/context.h>
#include <hex/volume/hex_mesh.h>

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace hex {

/// The metrics. The matrix A of a corner has the three edges that leave it as columns, right-handed for a
/// positive element, and det is its determinant; principal axes are four times the derivatives of the
/// trilinear map at the centre. "Nothing" is 1e-30 and less, as in Verdict. Up to `volume` they are those of
/// VTK 9.1.
enum class HexMetric {
    /// The same as max_aspect_frobenius.
    condition,
    /// Shortest over longest of the four diagonals, in [0, 1]; 1e30 when all of them are nothing.
    diagonal,
    /// Volume over sqrt(2) times the norm of its gradient by the coordinates of the corners: a length, for a
    /// stable time step (Pronto). 0 when there is no gradient.
    dimension,
    /// 8 times the smallest Jacobian determinant at corners and Gauss points of [-1, 1]^3, over the volume;
    /// 1e30 when that is 0.
    distortion,
    /// Longest over shortest edge, where the longest is looked for among six edges only, as VTK 9.1 does;
    /// aspect_ratio takes all. 1e30 when the square of the shortest is nothing.
    edge_ratio,
    /// Smallest of det at the corners and of the Jacobian determinant at the centre: signed, a volume.
    jacobian,
    /// Largest |A| |A^-1| / 3 of the corners, in the Frobenius norm; 1e30 / 3 when the det of one is nothing
    /// or negative.
    max_aspect_frobenius,
    /// Largest ratio of the lengths of two principal axes; 1e30 when one is nothing.
    max_edge_ratio,
    /// Mean |A| |A^-1| / 3 of the corners, in the Frobenius norm; each corner whose det is nothing or
    /// negative adds 1e30 / 24.
    med_aspect_frobenius,
    /// Largest (|A^T A|^2 - |A|^4 / 3) / det^(4/3) at corners and centre: how far the metric tensor is from a
    /// multiple of the identity. 1e30 when a det is nothing or negative.
    oddy,
    /// min(t, 1 / t)^2 for the mean det t of the corners over the average volume of the mesh, in [0, 1]; 0
    /// when either is nothing or negative.
    relative_size_squared,
    /// What hex/quality/scaled_jacobian.h computes, in [-1, 1].
    scaled_jacobian,
    /// Smallest 3 det^(2/3) / |A|^2 of the corners, in [0, 1]; 0 when a det is nothing or negative.
    shape,
    /// shape times relative_size_squared.
    shape_and_size,
    /// Smallest scaled Jacobian of the corners, without the centre, in [0, 1]; 0 when a det, or the square of
    /// an edge, is nothing or negative.
    shear,
    /// shear times relative_size_squared.
    shear_and_size,
    /// Largest absolute cosine of the angle between two principal axes, in [0, 1]; 1e30 when one is nothing.
    skew,
    /// sqrt(3) times the shortest edge over the longest diagonal; 1e30 when that is nothing.
    stretch,
    /// Largest 2 |cross derivative| at the centre over the shorter of its axes; 1e30 when that is nothing.
    taper,
    /// Jacobian determinant at the centre: the signed volume when the element is a parallelepiped.
    volume,
    /// Largest deviation of a face angle from 90 degrees, over 90 (Verdict since VTK 9.2); 1 or more when
    /// a face is not convex or an edge is nothing.
    equiangle_skew,
    /// Smallest over largest det of the corners (Verdict since VTK 9.2), at most 1; -1e30 when the largest is
    /// nothing or negative.
    nodal_jacobian_ratio,
    /// Longest over shortest of all twelve edges; 1e30 when the shortest is nothing.
    aspect_ratio,
    /// Smallest angle at a corner of a face, in degrees; 0 when an edge is nothing.
    min_angle,
    /// Largest angle at a corner of a face, in degrees; 180 or more when a face is not convex or an edge is
    /// nothing.
    max_angle,
    /// Largest angle between the two triangles of a face, over either of its diagonals, in degrees; 180,
    /// the most, when one of them has no area.
    warpage,
};

/// Which end of the numbers is the good one.
enum class BetterWhen {
    larger,   ///< large numbers are good: limits are minima
    smaller,  ///< small numbers are good: limits are maxima
    neither,  ///< sizes: only a deviation from the rest of the mesh is remarkable
};

/// What is known of a metric, for tables and reports.
struct HexMetricInfo {
    HexMetric metric;       ///< which one it is
    std::string_view name;  ///< snake_case
    BetterWhen better;      ///< which of two elements is the better one
    double ideal;           ///< of a cube with edges of length 1 in a mesh of such cubes
    /// One of the 20 that VTK 9.1's vtkMeshQuality computes; the others are Verdict's later ones and ours.
    bool in_vtk;
    std::string_view meaning;  ///< what it measures, in a few words
};

/// All metrics, in the order of the enumeration.
std::span<const HexMetricInfo> hex_metrics();
/// What is known of one metric; the reference stays valid.
const HexMetricInfo& info(HexMetric metric);

/// The metric of that name: "scaled_jacobian", or as VTK spells it, "ScaledJacobian"; none when there is no
/// such.
std::optional<HexMetric> find_hex_metric(std::string_view name);

/// Of one element. `average_volume` is what relative_size_squared and its products compare with; the other
/// metrics do not look at it. Elements for which a metric has no value get what HexMetric says, mostly
/// Verdict's 1e30. The number is always finite: it is cut to [-1e30, 1e30], and the worst of these where it
/// would be NaN (-1e30 for metrics without a better end).
double evaluate(HexMetric metric, const std::array<Vec3, 8>& corners, double average_volume = 1.0);

/// Of every cell, in cell order. The average volume is the mean of HexMetric::volume over the mesh. Throws
/// Error{cancelled}.
std::vector<double> evaluate(HexMetric metric, const HexMesh& mesh, const Context& context = {});

/// Minimum, mean, maximum and percentiles of a list of numbers. A percentile is always one of the numbers, by
/// the nearest rank as percentile() says.
struct MetricStatistics {
    double min = 0.0;            ///< the smallest
    double mean = 0.0;           ///< sum over count
    double max = 0.0;            ///< the largest
    double median = 0.0;         ///< the 50th percentile: of an even count the lower of the middle two
    double percentile_1 = 0.0;   ///< at least 1 % of the values are not above it
    double percentile_5 = 0.0;   ///< at least 5 % of the values are not above it
    double percentile_95 = 0.0;  ///< at least 95 % of the values are not above it
    double percentile_99 = 0.0;  ///< at least 99 % of the values are not above it
};

/// All zero for no values.
MetricStatistics statistics(std::span<const double> values, const Context& context = {});

/// The smallest value that at least `percent` (0..100) of the values do not exceed (nearest rank); 0 without
/// values.
double percentile(std::span<const double> values, double percent);

/// The `most` worst cells, worst first, then by id: the smallest values when larger is better, the largest
/// when smaller is, those farthest from the median otherwise.
std::vector<CellId> worst_cells(std::span<const double> values, BetterWhen better, std::size_t most);

}  // namespace hex
