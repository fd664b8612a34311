/// \file check_gates.h
/// What `hexspline check` finds in a mesh, and whether that meets the demands.
#pragma once

#include "hexspline/check_demands.h"
#include "hexspline/command.h"

#include <hex/quality/mesh_defects.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/quality/surface_distance.h>
#include <spline/jacobian.h>

#include <map>

namespace cli {

/// One metric of a mesh.
struct Measured {
    std::vector<double> values;  ///< one a cell
    hex::MetricStatistics statistics;
    std::vector<hex::CellId> worst;
};

struct Findings {
    hex::QualitySummary summary;        ///< of the scaled Jacobian
    std::vector<hex::CellId> inverted;  ///< cells with a scaled Jacobian <= 0
    std::map<hex::HexMetric, Measured> metrics;
    hex::MeshDefects defects;
    std::optional<hex::SurfaceDistance> distance;
    /// Of a BEXT file: whether its elements are proved not to fold. The mesh is then that of the elements'
    /// corners, and says nothing about nodes and boundary.
    std::optional<spline::JacobianReport> bezier;
};

/// One demand and how it turned out.
struct Gate {
    std::string name;    ///< "scaled_jacobian", "inverted", "surface-distance", ...
    std::string demand;  ///< "at least 0.2"
    std::string found;   ///< "smallest 0.31"
    bool passed = true;
    std::size_t bad = 0;             ///< elements (nodes, edges, faces) that do not meet the demand
    std::vector<hex::CellId> cells;  ///< the worst of them, when they are elements
};

/// All gates, in the order of the demands. `worst` is how many elements a gate lists at most.
std::vector<Gate> evaluate_gates(const Demands& demands, const Findings& findings, std::size_t worst);

/// A number for people: six digits.
std::string short_number(double value);
/// The shortest text that reads back to the same number: a limit as it was written.
std::string exact_number(double value);
/// Six digits, or all of them when six would tell another order of `value` and `limit`.
std::string number_beside(double value, double limit);

}  // namespace cli
