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

struct ImproveOptions {
    /// Name of the method in the registry: `laplace`, `pillow`, `smooth`, `optimize` (paper, section on
    /// quality), `untangle`, `auto`, or a plug-in's.
    std::string method = "auto";
    /// Layers (pillow) or sweeps (the others), >= 0. -1: the method's own default, 1 layer or 50 sweeps.
    int count = -1;
    /// In (0, 1]. laplace, smooth: share of the computed move that is made. optimize: first step of the line
    /// search, as a share of the mean length of the edges at the vertex. 0: the method's own default, 1 for
    /// laplace, 0.01 (paper) for the others. pillow has no use for it.
    double step = 0.0;
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
    int sweep = 0;
    std::string step;
    std::size_t moved = 0;
    double min = 0.0;
    double mean = 0.0;
    std::size_t inverted = 0;
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

struct ImproveReport {
    std::string method;
    QualitySummary before;
    QualitySummary after;
    std::size_t sharp_edges = 0;
    std::vector<ImproveRecord> history;
    /// Of `untangle` and `auto` with a surface: of the input with its boundary vertices on the surface, of
    /// the result, and what was allowed.
    std::optional<ImproveFidelity> fidelity_before, fidelity_after, fidelity_limit;
    /// untangle, auto: the sharp edges that were used, as pairs of vertices of the surface (of the input
    /// without one), ascending.
    std::vector<std::array<std::int64_t, 2>> feature_edges;
    /// Evaluations of an element (untangle, auto).
    double work = 0.0;
    /// Seconds that each kind of step took, in order of their first use (untangle, auto).
    std::vector<std::pair<std::string, double>> seconds;
    Diagnostics diagnostics;
};

struct ImproveResult {
    HexMesh mesh;
    ImproveReport report;
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
    virtual ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                                  const Context& context) const = 0;
};

Registry<Improver>& improvers();

/// Runs `options.method` and fills `before` and `after`. Throws Error{usage} for options out of range.
ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options = {}, const Context& context = {});

}  // namespace hex
