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

enum class HexMetric {
    condition,
    diagonal,
    dimension,
    distortion,
    edge_ratio,
    jacobian,
    max_aspect_frobenius,
    max_edge_ratio,
    med_aspect_frobenius,
    oddy,
    relative_size_squared,
    scaled_jacobian,
    shape,
    shape_and_size,
    shear,
    shear_and_size,
    skew,
    stretch,
    taper,
    volume,
    equiangle_skew,
    nodal_jacobian_ratio,
    aspect_ratio,
    min_angle,
    max_angle,
    warpage,
};

/// Which end of the numbers is the good one.
enum class BetterWhen { larger, smaller, neither };

struct HexMetricInfo {
    HexMetric metric;
    std::string_view name;  ///< snake_case
    BetterWhen better;
    double ideal;  ///< of a cube with edges of length 1 in a mesh of such cubes
    /// One of the 20 that VTK 9.1's vtkMeshQuality computes; the others are Verdict's later ones and ours.
    bool in_vtk;
    std::string_view meaning;
};

/// All metrics, in the order of the enumeration.
std::span<const HexMetricInfo> hex_metrics();
const HexMetricInfo& info(HexMetric metric);

/// The metric of that name: "scaled_jacobian", or as VTK spells it, "ScaledJacobian"; none when there is no
/// such.
std::optional<HexMetric> find_hex_metric(std::string_view name);

/// Of one element. `average_volume` is what relative_size_squared and its products compare with; the other
/// metrics do not look at it. Elements for which a metric has no value get Verdict's 1e30 (the scaled
/// Jacobian: 0, as scaled_jacobian.h says); the number is always finite.
double evaluate(HexMetric metric, const std::array<Vec3, 8>& corners, double average_volume = 1.0);

/// Of every cell, in cell order. The average volume is that of the mesh.
std::vector<double> evaluate(HexMetric metric, const HexMesh& mesh, const Context& context = {});

/// Minimum, mean, maximum and percentiles of a list of numbers.
struct MetricStatistics {
    double min = 0.0;
    double mean = 0.0;
    double max = 0.0;
    double median = 0.0;
    double percentile_1 = 0.0;
    double percentile_5 = 0.0;
    double percentile_95 = 0.0;
    double percentile_99 = 0.0;
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
