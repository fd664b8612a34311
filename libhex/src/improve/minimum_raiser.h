/// \file minimum_raiser.h
/// What `untangle` and `auto` share: the whole way from any mesh to one with a large smallest scaled
/// Jacobian, the connectivity staying as it is.
#pragma once

#include "improve/sliding_descent.h"

#include <hex/improve/improve.h>

#include <optional>
#include <string>

namespace hex::improving {

/// The surface that the options ask for, and how sharp its curves must be.
GuideSurface make_guide_surface(const HexMesh& mesh, const BoundaryQuads& boundary,
                                const ImproveOptions& options);

/// One mesh on its way up. `run` does:
/// 1. boundary vertices onto their parts of the surface (boundary_guide.h), curves smooth for now;
/// 2. while something is inverted: minimise the foldover-free energy, with the paper's rule for epsilon;
/// 3. in turns the barrier over all vertices (corner_energies.h) and the star ascent (star_ascent.h), with
///    narrower and narrower gaps between the barrier's floor and the minimum;
/// 4. the same on the exact curves, when a surface was given;
/// 5. the same with the slack that `max_deviation` allows, when the minimum is below `good_enough`.
/// The best mesh met on the exact surface is kept.
class MinimumRaiser {
  public:
    MinimumRaiser(const HexMesh& mesh, GuideSurface surface, const ImproveOptions& options,
                  const Context& context);

    void run();

    /// Whether any mesh within `max_deviation` was met.
    bool has_best() const { return has_best_; }
    const HexMesh& best() const { return best_; }
    const ImproveRecord& best_record() const { return best_record_; }
    const std::vector<ImproveRecord>& history() const { return history_; }
    std::size_t sharp_edge_count() const;
    const BoundaryGuide& guide() const { return guide_; }
    const BoundaryQuads& boundary() const { return boundary_; }

  private:
    void untangle();
    void raise();
    /// Barrier descents with floors `gap` below the minimum, while they help.
    void lower_barrier(double gap);
    void ascend();
    /// Notes the mesh as it is now; keeps it if `eligible` and better.
    void record(bool eligible);
    /// The minimum at which raising stops.
    double aim() const;
    bool reached_target() const;
    /// Largest distance of a boundary vertex to its part of the surface.
    double deviation() const;

    const ImproveOptions& options_;
    const Context& context_;
    EdgeTable edges_;
    BoundaryQuads boundary_;
    BoundaryGuide guide_;
    SlidingMesh sliding_;
    HexMesh best_;
    ImproveRecord best_record_;
    ImproveRecord now_;
    double most_deviation_ = 0.0;
    bool exact_ = false;
    bool has_best_ = false;
    std::vector<ImproveRecord> history_;
};

/// Fewer inverted cells, then a larger minimum.
bool better(const ImproveRecord& a, const ImproveRecord& b);

}  // namespace hex::improving
