/// \file sweep.h
/// What the methods that move vertices share: the mesh with everything derived from it, Gauss-Seidel sweeps
/// by colour classes, and the record of each sweep.
#pragma once

#include "improve/boundary_motion.h"
#include "improve/coloring.h"
#include "improve/star.h"

#include <hex/improve/improve.h>

#include <functional>
#include <memory>
#include <optional>

namespace hex::improving {

/// Memory that one thread reuses from vertex to vertex.
struct Workspace {
    Star star;
};

class Sweeper {
  public:
    /// Moves every vertex but fixed ones. Boundary vertices are first brought onto `options.surface`.
    Sweeper(const HexMesh& mesh, const ImproveOptions& options, const Context& context);
    /// Moves those of the interior vertices that are flagged; the boundary stays.
    Sweeper(const HexMesh& mesh, const std::vector<char>& interior_flags, const Context& context);

    const HexMesh& mesh() const { return mesh_; }
    const EdgeTable& edges() const { return edges_; }
    bool on_boundary(VertexId v) const { return boundary_.contains(v); }
    BoundaryMotion& motion() { return *motion_; }

    /// Scaled Jacobian of every cell, kept up to date.
    std::span<const double> values() const { return values_; }
    /// The smallest of the cells around a vertex.
    double star_minimum(VertexId v) const;
    /// Mean length of the edges at v.
    double mean_edge_length(VertexId v) const;

    /// The star of v with the positions of now.
    Star& gather(VertexId v, Workspace& workspace) const;
    /// Moves v; `star` must be its star.
    void move(VertexId v, const Vec3& p, const Star& star);

    /// Visits every movable vertex, class by class and within a class in parallel; `visit(v, workspace)`
    /// tells whether it moved v. Returns how many did.
    using Visit = std::function<bool(VertexId, Workspace&)>;
    std::size_t sweep(const Visit& visit);

    /// Up to `count` sweeps, fewer when one moves nothing; reports progress under `step` and records each.
    /// `prepare` is called before each sweep.
    void run(int count, const std::string& step, const Visit& visit,
             const std::function<void()>& prepare = {});

    /// The mesh and what was recorded. The sweeper is used up.
    ImproveResult finish();

  private:
    Sweeper(const HexMesh& mesh, const ImproveOptions& options, const TriangleMesh* surface,
            const Context& context);
    void attach_to_surface();
    void report_distance();

    HexMesh mesh_;
    const Context& context_;
    EdgeTable edges_;
    BoundaryQuads boundary_;
    FeatureSet features_;
    std::unique_ptr<BoundaryGuide> guide_;  ///< null: no surface
    std::optional<BoundaryMotion> motion_;
    CompressedRows<StarCell> stars_;
    std::vector<std::vector<VertexId>> classes_;
    std::vector<double> values_;
    ImproveReport report_;
};

/// Smallest, mean and number of values <= 0, the same for any number of threads.
ImproveRecord record_of(std::span<const double> values);

/// The feature set that the options ask for.
FeatureSet make_features(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                         const ImproveOptions& options);

}  // namespace hex::improving
