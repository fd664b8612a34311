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

/// What `build` is to make of a mesh.
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
    /// Name of the file that `feature_vertices` comes from, for messages; may be empty.
    std::string feature_origin;
    /// Name of the file that `refinement` comes from, likewise.
    std::string refinement_origin;
    /// Go on with inverted elements, and with elements that meet others at an edge or a vertex only.
    bool force = false;
};

/// The control mesh of one level, as far as it is built.
struct ControlMesh {
    hex::HexMesh mesh;  ///< the domain's cells (LevelReport::elements), then those around refined ones
    std::vector<char> function_active;    ///< one flag a vertex
    std::vector<char> element_active;     ///< one flag a cell
    std::vector<std::uint32_t> function;  ///< control point of an active vertex, else 0xffffffff
    std::vector<hex::CellId>
        refined;  ///< divided cells; cells 8 k .. 8 k + 7 of the next level are of the k-th
};

/// Counts of one level of the hierarchy (hierarchy.h).
struct LevelReport {
    std::size_t elements = 0;          ///< in Omega(l)
    std::size_t active_elements = 0;   ///< elements of the spline on this level: those not divided further
    std::size_t active_functions = 0;  ///< control points of the spline on this level
    std::size_t refined = 0;           ///< elements that are divided further
    std::size_t added_by_closure = 0;  ///< of them, not listed by the user
};

/// What `build` has made, in numbers. Level 0 is the mesh after global refinement.
struct SplineReport {
    std::string method;                              ///< its name in the registry
    std::size_t input_vertices = 0,                  ///< of the given mesh, used or not
        input_elements = 0;                          ///< of the given mesh
    std::size_t boundary_elements = 0,               ///< of level 0, by ElementClass
        irregular_elements = 0,                      ///< of level 0, by ElementClass
        regular_elements = 0;                        ///< of level 0, by ElementClass
    std::map<int, std::size_t> extraordinary_edges;  ///< of level 0, by valence
    std::size_t sharp_edges = 0,                     ///< of level 0
        crease_vertices = 0,                         ///< of level 0: on exactly two sharp edges
        corner_vertices = 0;                         ///< of level 0: on one sharp edge, or three and more
    /// Elements of level 0 with eight regular vertices: refining these keeps functions and geometry exactly.
    std::size_t refinable_elements = 0;
    std::vector<LevelReport> levels;  ///< coarsest first
    BezierSummary summary;            ///< of the Bezier extraction
    /// Of the mesh: `inverted-elements`, `non-manifold` (with `force`), `unused-vertices`; then of the
    /// hierarchy (build_hierarchy).
    hex::Diagnostics diagnostics;
};

/// A spline, where it came from, and what is known of it.
struct SplineResult {
    BezierSpline spline;              ///< elements by level, then cell; control points by level, then vertex
    std::vector<ControlMesh> levels;  ///< coarsest first
    SplineReport report;              ///< counts and findings
};

/// A method of stage `spline`; registered in spline_builders().
class SplineBuilder {
  public:
    virtual ~SplineBuilder() = default;
    /// Called by spline::build with options that are checked and a mesh whose vertices are all used; lists of
    /// feature vertices and edges refer to it, `refinement` is cut to `levels`, and no region is `worst_fit`.
    /// Fills `spline`, `levels` and the report but for `method`, the input's numbers and `summary`.
    /// spline::build throws Error{no_result} when indices, sizes or numbers of the result are not sound.
    virtual SplineResult build(const hex::HexMesh& mesh, const SplineOptions& options,
                               const hex::Context& context) const = 0;
};

/// The methods by name; `thspline3d` is built in.
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
