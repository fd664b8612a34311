/// \file improve.h
/// Stage `improve`: better hexahedral meshes.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/base/registry.h>
#include <hex/feature/feature_set.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <array>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace hex {

/// The method, how much it may do, and what of the boundary it has to keep.
struct ImproveOptions {
    /// Name of the method in the registry: `laplace`, `pillow`, `smooth`, `optimize` (paper, section on
    /// quality), `untangle`, `auto`, `snap`, or a plug-in's.
    std::string method = "auto";
    /// Layers (pillow) or sweeps (laplace, smooth, optimize), >= 0. -1: the method's own default, 1 layer or
    /// 50 sweeps. snap: 0 for no layer, anything else for one. untangle and auto have no use for it.
    int count = -1;
    /// In (0, 1]. laplace, smooth: share of the computed move that is made. optimize: first step of the line
    /// search, as a share of the mean length of the edges at the vertex. 0: the method's own default, 1 for
    /// laplace, 0.01 (paper) for optimize and smooth. The other methods have no use for it.
    double step = 0.0;
    /// smooth, optimize: which edges of the boundary are sharp. Vertices with two sharp edges move along
    /// these only, those with one, three or more not at all.
    FeatureSource features = FeatureSource::none;
    /// For FeatureSource::angle: cosine below which an edge between two boundary quads is sharp, in [-1, 1].
    double feature_cosine = 0.8;
    /// For FeatureSource::list: 0-based vertices of the input mesh.
    std::vector<std::int64_t> feature_vertices;
    /// smooth, optimize: boundary vertices are brought and kept onto this surface, each on the smooth region,
    /// sharp curve (dihedral angle by `feature_cosine`) or corner of it that it belongs to; none: they move
    /// tangentially only, and so drift a little.
    /// untangle, auto: the same; none: they move on the boundary of the input, whose sharp curves are found
    /// by `feature_cosine`, or given by FeatureSource::list (FeatureSource::none and angle make no
    /// difference).
    /// snap: what the boundary is pulled onto; Error{usage} without one.
    const TriangleMesh* surface = nullptr;
    /// untangle, auto: how far boundary vertices may leave the surface, in percent of its diagonal, >= 0. It
    /// is used only where it helps, and no more than 0.1 of it at vertices that are not on a sharp curve
    /// (smooth curves through the corners of the input's polylines may be farther off). Negative: the
    /// default, 0.01 with `surface`, else 1.
    double max_deviation = -1.0;
    /// untangle, auto: they stop when the smallest scaled Jacobian has reached this, in (0, 1].
    double target = 1.0;
    /// untangle, auto: the sharp edges, as pairs of 0-based vertices of `surface` (of the input without one),
    /// instead of those found by angle. Empty: found by angle.
    std::vector<std::array<std::int64_t, 2>> feature_edges;
    /// untangle, auto: they end as soon as they can after so many seconds and give the best found until then;
    /// 0: no limit. With a limit results may differ from run to run.
    double time_limit = 0.0;
    /// untangle, auto: the same after so many evaluations of an element, >= 0, but with the same result on
    /// any machine; 0: no limit. `auto` may do twice as many when it tries a layer.
    double work_limit = 0.0;
    /// untangle, auto: when a stop is asked for here, they end as after `time_limit`. (Context::stop gives
    /// nothing at all.)
    std::stop_token finish;
    /// pillow: the layer goes only around cells that have two boundary faces on one smooth part of the
    /// boundary (a cosine of at least `feature_cosine` at the edge between them), and as many of their
    /// neighbours as it takes for these to have no edge and no vertex in common without a face. No such
    /// cells: no layer.
    bool local_layer = false;
};

/// State of the mesh after a sweep, a layer or a step.
struct ImproveRecord {
    int sweep = 0;  ///< number of the sweep, layer or step, from 1
    /// untangle, auto: what kind of step it was: "attach", "untangle", "barrier", "ascent", "mean", "back".
    std::string step;
    /// Vertices that were moved; pillow: that were made; untangle, auto and the pulls of snap: 0.
    std::size_t moved = 0;
    double min = 0.0;          ///< smallest scaled Jacobian
    double mean = 0.0;         ///< of the scaled Jacobians of all elements
    std::size_t inverted = 0;  ///< elements with a scaled Jacobian <= 0
    /// untangle, auto: largest distance of a boundary vertex to its part of the surface, in percent of the
    /// diagonal.
    double distance = 0.0;
};

/// How far boundary and surface are from each other, in percent of the surface's diagonal.
struct ImproveFidelity {
    /// Largest distance, both ways: of boundary vertices and quad centres to the surface, of vertices and
    /// triangle centroids of the surface to the boundary.
    double distance = 0.0;
    /// Mean distance of points on sharp edges of the surface to the nearest edge of the boundary.
    double features = 0.0;
};

/// What a method did to a mesh.
struct ImproveReport {
    std::string method;     ///< that was run
    QualitySummary before;  ///< of the input
    QualitySummary after;   ///< of the result
    /// Edges of the mesh that counted as sharp (smooth, optimize), or stood for sharp edges of the surface
    /// (untangle, auto); 0 of other methods.
    std::size_t sharp_edges = 0;
    std::vector<ImproveRecord> history;  ///< an entry a sweep, layer or step; the input has none
    /// Of `untangle` and `auto` with a surface: the input with its boundary vertices on the surface. None
    /// where the input itself is returned.
    std::optional<ImproveFidelity> fidelity_before, fidelity_after, fidelity_limit;
    /// \var fidelity_after
    /// The same of the result.
    /// \var fidelity_limit
    /// What was allowed; the warning `fidelity-lost` tells when the result is beyond it.

    /// untangle, auto: the sharp edges that were used, as pairs of vertices of the surface (of the input
    /// without one), ascending.
    std::vector<std::array<std::int64_t, 2>> feature_edges;
    /// Evaluations of an element (untangle, auto).
    double work = 0.0;
    /// Seconds that each kind of step took, in order of their first use (untangle, auto).
    std::vector<std::pair<std::string, double>> seconds;
    /// Notes `surface-distance`, `fidelity`, `layer-added`, `input-kept`; warnings `fidelity-lost`,
    /// `off-surface` (vertices that could not be brought onto the surface), `pillow-inverted` (cells of the
    /// layer).
    Diagnostics diagnostics;
};

/// An improved mesh, and what was done to it.
struct ImproveResult {
    /// The cells of the input in their order, with their part ids; after them those of layers around it.
    HexMesh mesh;
    ImproveReport report;  ///< what was done
};

/// A method of the stage. `laplace`, `smooth` and `optimize` keep a move of a vertex only if the smallest
/// scaled Jacobian around it does not fall (`optimize`: only if the number of inverted elements around it,
/// or, that being equal, the smallest scaled Jacobian improves), so neither the number of inverted elements
/// nor the minimum of the mesh ever gets worse, but for bringing boundary vertices onto `surface`, which only
/// promises to invert nothing. `pillow` never inverts an element that was not.
/// `untangle` and `auto` return the input itself rather than a mesh with more inverted elements or, their
/// number being equal, a lower minimum.
class Improver {
  public:
    virtual ~Improver() = default;
    /// Makes the mesh better. The options are in range; `before` and `after` of the report are the stage's to
    /// fill. A mesh without hexahedra, or with a vertex that is not finite, makes the stage throw
    /// Error{no_result}.
    virtual ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                                  const Context& context) const = 0;
};

/// The methods of the stage by name, those of plug-ins included.
Registry<Improver>& improvers();

/// Runs `options.method` and fills `before` and `after`. Throws Error{usage} for options out of range or
/// an unknown method, Error{bad_input} for a mesh without hexahedra or `feature_vertices` out of range.
ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options = {}, const Context& context = {});

}  // namespace hex
