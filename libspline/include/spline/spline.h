/// \file spline.h
/// Stage `spline`: a truncated hierarchical tricubic spline (TH-spline3D) on an unstructured hexahedral mesh.
///
/// Guarantees, by construction: every active function is non-negative; the functions of an element sum to 1
/// (<= 1e-14); the spline is continuous, C2 where only regular elements meet; linear functions are
/// reproduced. With closure also the truncated functions are continuous across levels. The result is the
/// same, bit for bit, for any number of threads. docs/spline.md says what is not guaranteed.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/base/registry.h>
#include <hex/feature/feature_set.h>
#include <hex/volume/hex_mesh.h>
#include <spline/bezier.h>
#include <spline/level_mesh.h>
#include <spline/refine_region.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace spline {

struct SplineOptions {
    /// Name of the method in the registry.
    std::string method = "thspline3d";
    /// Where sharp features come from: none, the angle between boundary quads, or a list of vertices.
    hex::FeatureSource features = hex::FeatureSource::none;
    /// For FeatureSource::angle: cosine below which a boundary edge is sharp, in [-1, 1]. Paper: 0.8.
    double feature_cosine = 0.8;
    /// For FeatureSource::list: 0-based vertices of the input mesh (sharp.txt).
    std::vector<std::int64_t> feature_vertices;
    /// Boundary edges that are sharp besides, each by its two vertices of the input mesh
    /// (surface_features.h).
    std::vector<std::array<std::int64_t, 2>> feature_edges;
    /// Times that all elements are divided into eight before anything else, >= 0.
    int global_refinements = 0;
    /// Entry l: elements of level l to refine (lev_rfid.txt), 0-based in the cell order of that level's mesh.
    /// Level 0 is the mesh after global refinement.
    std::vector<std::vector<std::int64_t>> refinement;
    /// Elements to refine by what they are or where, besides those listed; applied after the lists.
    std::vector<RefineRegion> regions;
    /// For RefineRegion::Kind::worst_fit: how far each element of a spline is off the part, negative for
    /// those that cannot be. Called with the spline as it is before such regions are refined, for each level
    /// anew.
    std::function<std::vector<double>(const BezierSpline&)> fit_errors;
    /// Use only the first so many entries of `refinement`.
    std::optional<int> levels;
    /// Complete the lists so that functions are continuous across levels (hierarchy.h). Without it the lists
    /// are taken as they are, as the published program does.
    bool closure = true;
    /// Names of the files that `feature_vertices` and `refinement` come from, for messages; may be empty.
    std::string feature_origin;
    std::string refinement_origin;
    /// Go on with inverted elements, and with elements that meet others at an edge or a vertex only.
    bool force = false;
};

/// The control mesh of one level, as far as it is built.
struct ControlMesh {
    hex::HexMesh mesh;
    std::vector<char> function_active;    ///< one flag a vertex
    std::vector<char> element_active;     ///< one flag a cell
    std::vector<std::uint32_t> function;  ///< control point of an active vertex, else 0xffffffff
    std::vector<hex::CellId>
        refined;  ///< divided cells; cells 8 k .. 8 k + 7 of the next level are of the k-th
};

struct LevelReport {
    std::size_t elements = 0;  ///< in Omega(l)
    std::size_t active_elements = 0;
    std::size_t active_functions = 0;
    std::size_t refined = 0;           ///< elements that are divided further
    std::size_t added_by_closure = 0;  ///< of them, not listed by the user
};

struct SplineReport {
    std::string method;
    std::size_t input_vertices = 0, input_elements = 0;
    /// Classes of the elements of level 0 (after global refinement).
    std::size_t boundary_elements = 0, irregular_elements = 0, regular_elements = 0;
    std::map<int, std::size_t> extraordinary_edges;  ///< by valence
    std::size_t sharp_edges = 0, crease_vertices = 0, corner_vertices = 0;
    /// Elements of level 0 with eight regular vertices: refining these keeps functions and geometry exactly.
    std::size_t refinable_elements = 0;
    std::vector<LevelReport> levels;
    BezierSummary summary;
    hex::Diagnostics diagnostics;
};

struct SplineResult {
    BezierSpline spline;
    std::vector<ControlMesh> levels;
    SplineReport report;
};

class SplineBuilder {
  public:
    virtual ~SplineBuilder() = default;
    virtual SplineResult build(const hex::HexMesh& mesh, const SplineOptions& options,
                               const hex::Context& context) const = 0;
};

hex::Registry<SplineBuilder>& spline_builders();

/// Checks options and mesh and runs `options.method`. Vertices that no cell uses are dropped.
/// Throws Error{usage} for options out of range, and for a region worst_fit without `fit_errors`;
/// Error{bad_input} for an empty mesh, for inverted elements and for elements that meet others at an edge or
/// a vertex only (both named; unless `force`), for feature vertices, feature edges or elements to refine that
/// do not exist, or whose parent is not refined.
SplineResult build(const hex::HexMesh& mesh, const SplineOptions& options = {},
                   const hex::Context& context = {});

/// Gives the vertices of the control meshes the positions of their control points, after these were moved.
void update_control_meshes(SplineResult& result);

}  // namespace spline
