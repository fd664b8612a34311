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
/// 5. the same with the slack that `max_deviation` allows, when the minimum is below `good_enough`;
/// 6. the mean is raised, the minimum kept;
/// 7. of the meshes met on the exact surface the best is taken that is as close to the surface as the input
///    was (fidelity_meter.h), give or take `fidelity_loss`; when none is, more weight is put on the shape of
///    the boundary (shape_keeper.h) and 3 repeated.
class MinimumRaiser {
  public:
    MinimumRaiser(const HexMesh& mesh, GuideSurface surface, const ImproveOptions& options,
                  const Context& context);

    void run();

    /// Whether any mesh within `max_deviation` was met.
    bool has_best() const { return chosen_.has_value(); }
    const HexMesh& best() const { return best_; }
    const ImproveRecord& best_record() const { return chosen_->record; }
    /// Of the input on the surface, of the best, and what was allowed.
    const Fidelity& fidelity_before() const { return fidelity_before_; }
    const Fidelity& fidelity_after() const { return fidelity_after_; }
    const Fidelity& fidelity_limits() const { return limits_; }
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
    void raise_mean();
    /// The best candidate that is within the limits; otherwise the one that is least beyond them.
    void choose();
    /// The same steps with more and more weight on the shape, until a mesh is within the limits.
    void restore_fidelity();
    /// Notes the mesh as it is now; it becomes a candidate if `eligible`.
    void record(bool eligible);
    void measure_start();
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
    FidelityMeter meter_;
    std::optional<ShapeKeeper> keeper_;
    Fidelity fidelity_before_, fidelity_after_, limits_;
    struct Candidate {
        ImproveRecord record;
        std::vector<Vec3> positions;
        std::optional<Fidelity> fidelity;
    };
    std::vector<Candidate> candidates_;  // the best first
    std::optional<Candidate> chosen_;
    HexMesh best_;
    ImproveRecord now_;
    double most_deviation_ = 0.0;
    bool exact_ = false;
    std::vector<ImproveRecord> history_;
};

/// Fewer inverted cells, then a larger minimum.
bool better(const ImproveRecord& a, const ImproveRecord& b);

}  // namespace hex::improving
