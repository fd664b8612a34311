/// \file sliding_descent.h
/// Minimises an energy of the whole mesh over all vertices, those of the boundary sliding on the surface.
#pragma once

#include "improve/boundary_guide.h"
#include "improve/cell_energies.h"
#include "improve/shape_keeper.h"

#include <hex/base/context.h>

#include <functional>
#include <optional>
#include <span>

namespace hex::improving {

/// The mesh as the minimiser sees it: positions that are always on the surface, and the directions that keep
/// them there to first order.
class SlidingMesh {
  public:
    /// \param guide may be null: then boundary vertices are fixed.
    SlidingMesh(const HexMesh& mesh, const EdgeTable& edges, const BoundaryGuide* guide,
                const BoundaryQuads& boundary);

    const HexMesh& mesh() const { return mesh_; }
    std::span<const Vec3> positions() const { return mesh_.positions(); }
    void set_positions(std::span<const Vec3> positions);

    /// Boundary vertices may leave their part of the surface by this distance, >= 0 (0 at first). Corners may
    /// not.
    void set_slack(double distance) { slack_ = distance; }
    double slack() const { return slack_; }
    /// Whether curves are smooth stand-ins of the surface's polylines (BoundaryGuide::nearest_smooth); no at
    /// first. Takes effect with the next `attach`.
    void use_smooth_curves(bool smooth);
    bool smooth_curves() const { return smooth_; }

    /// From now on `evaluate` adds the energy of this; null: nothing (as at first).
    void set_keeper(ShapeKeeper* keeper) { keeper_ = keeper; }
    ShapeKeeper* keeper() const { return keeper_; }

    /// Lengths that the edges of each cell should about have along u, v and w; none at first. No vertex
    /// of the star ascent makes an edge much shorter than that.
    void set_boxes(std::vector<Vec3> boxes) { boxes_ = std::move(boxes); }
    const std::vector<Vec3>& boxes() const { return boxes_; }

    /// Brings every boundary vertex to its nearest place on its part of the surface.
    void attach();
    /// Value of the energy. With `gradient`, its derivative for each vertex, made tangential at the current
    /// places. The same bits for any number of threads; infinite as soon as one cell is.
    double evaluate(const MeshEnergy& energy, std::vector<Vec3>* gradient) const;

    /// Evaluations of a cell so far: a measure of the work done that is the same on any machine.
    double work() const { return work_; }
    void add_work(double evaluations) { work_ += evaluations; }

    /// Drops the part of each vector that leaves the surface, and everything where vertices are fixed. With
    /// slack, only what leaves the slack; `sign` is -1 for gradients, whose opposite is where vertices go.
    void make_tangential(std::vector<Vec3>& vectors, double sign) const;
    /// Where a boundary vertex goes, and the nearest point of its part: the same without slack.
    struct Spot : BoundaryGuide::Place {
        Vec3 foot;
    };
    /// Where a boundary vertex that is wanted at p goes. Not for the same vertex at the same time.
    Spot place(VertexId v, const Vec3& p) const;
    /// Moves by `step` x `direction` from `origin`, boundary vertices to the nearest place of their part.
    void retract(std::span<const Vec3> origin, std::span<const Vec3> direction, double step);
    /// Moves one vertex to a place that `place` gave.
    void move(VertexId v, const Spot& spot);
    const BoundaryGuide* guide() const { return guide_; }
    bool on_boundary(VertexId v) const { return boundary_.contains(v); }
    /// Unit normal of the region, direction of the curve where a boundary vertex is.
    const Vec3& axis(VertexId v) const { return axis_[v.index()]; }
    std::optional<std::uint32_t> item(VertexId v) const { return item_[v.index()]; }
    /// 8 cell + corner of each cell at a vertex.
    std::span<const std::uint32_t> corners_at(VertexId v) const { return corners_at_[v.index()]; }
    /// Mean length of the edges at each vertex, as the mesh is now.
    std::vector<double> vertex_sizes() const;

  private:
    /// Closest point on the vertex's part, without slack.
    BoundaryGuide::Place on_part(VertexId v, const Vec3& p) const;

    ShapeKeeper* keeper_ = nullptr;
    std::vector<Vec3> boxes_;
    double slack_ = 0.0;
    bool smooth_ = false;
    HexMesh mesh_;
    const EdgeTable& edges_;
    const BoundaryGuide* guide_;
    const BoundaryQuads& boundary_;
    CompressedRows<std::uint32_t> corners_at_;  // 8 cell + corner, of each vertex
    std::vector<Vec3> axis_;                    // normal or direction of each boundary vertex's place
    std::vector<std::optional<std::uint32_t>> item_;
    std::vector<Vec3> foot_;
    mutable std::vector<TriangleSearch::Memory> memory_;  // of each boundary vertex
    mutable std::vector<std::array<Vec3, 8>> cell_gradient_;
    mutable std::vector<double> cell_value_;
    mutable double work_ = 0.0;
};

struct DescentOptions {
    int most_iterations = 100;
    /// Stops when this many iterations together lowered the energy by less than `relative_gain` of it.
    int window = 10;
    double relative_gain = 1e-4;
    /// No vertex moves farther in one iteration, in shares of the mean length of its edges.
    double largest_move = 0.3;
    /// Asked after every iteration; true ends the descent.
    std::function<bool()> satisfied;
};

struct DescentResult {
    double before = 0.0;
    double after = 0.0;
    int iterations = 0;
    int evaluations = 0;
};

/// L-BFGS (Nocedal and Wright, Numerical Optimization, algorithm 7.4) with vertices scaled by their size,
/// backtracking line search and retraction to the surface; directions of earlier iterations are carried along
/// by projection to the present tangent spaces. The energy never rises.
DescentResult descend(SlidingMesh& mesh, const MeshEnergy& energy, const DescentOptions& options,
                      const Context& context);

}  // namespace hex::improving
