/// \file minimum_raiser.h
/// What `untangle` and `auto` share: the whole way from any mesh to one with a large smallest scaled
/// Jacobian, the connectivity staying as it is.
#pragma once

#include "improve/sliding_descent.h"

#include <hex/improve/improve.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

namespace hex::improving {

/// Time that is up after so many seconds (0: never), or when somebody asks to finish; shared by what runs one
/// after the other.
class Deadline {
  public:
    explicit Deadline(const ImproveOptions& options)
        : seconds_(options.time_limit), finish_(options.finish), start_(std::chrono::steady_clock::now()) {}
    bool passed() const { return finish_.stop_requested() || (seconds_ > 0.0 && elapsed() > seconds_); }
    double elapsed() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    double seconds_;
    std::stop_token finish_;
    std::chrono::steady_clock::time_point start_;
};

/// One mesh on its way up. `begin` does 1 to 3 and `finish` the rest:
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
                  const Deadline& deadline, const Context& context);

    void begin();
    void finish();
    void run() {
        begin();
        finish();
    }
    /// The mesh between `begin` and `finish`.
    const HexMesh& current() const { return sliding_.mesh(); }
    double work() const { return sliding_.work(); }
    const ImproveRecord& now() const { return now_; }
    /// To be as close to the surface as another raiser has to be; call before `begin`.
    void take_limits(const MinimumRaiser& other) {
        fidelity_before_ = other.fidelity_before_;
        limits_ = other.limits_;
        limits_given_ = true;
    }
    const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

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
    /// Whether the surface is one of its own, not the boundary of the input.
    bool guided_by_surface() const { return options_.surface != nullptr; }
    const BoundaryGuide& guide() const { return guide_; }
    const BoundaryQuads& boundary() const { return boundary_; }

  private:
    void untangle();
    void raise();
    /// Barrier descents with floors `gap` below the minimum, while they help.
    void lower_barrier(double gap);
    /// The star ascent, until the minimum is `target`.
    void ascend(double target);
    void raise_mean();
    /// The best candidate that is within the limits; otherwise the one that is least beyond them.
    void choose();
    /// The barrier with more weight on the shape, then steps back towards the start, until a mesh is within
    /// the limits.
    void restore_fidelity();
    /// Notes the mesh as it is now; it becomes a candidate if `eligible`.
    void record(const std::string& step, bool eligible);
    void measure_start();
    /// No time, or no work, is left for what is running.
    bool is_over() const;
    /// The minimum at which raising stops.
    double aim() const;
    bool reached_target() const;
    /// Largest distance of a boundary vertex to its part of the surface.
    double deviation() const;
    double allowed_deviation() const { return std::max(most_deviation_, 1e-12 * guide_.diagonal()); }

    const ImproveOptions& options_;
    const Deadline& deadline_;
    const Context& context_;
    EdgeTable edges_;
    BoundaryQuads boundary_;
    BoundaryGuide guide_;
    SlidingMesh sliding_;
    FidelityMeter meter_;
    std::optional<ShapeKeeper> keeper_;
    std::vector<Vec3> start_;  // the input on the exact surface
    Fidelity fidelity_before_, fidelity_after_, limits_;
    struct Candidate {
        ImproveRecord record;
        std::vector<Vec3> positions;
        std::optional<Fidelity> fidelity;
    };
    std::vector<Candidate> candidates_;  // the best first
    std::optional<Candidate> chosen_;
    HexMesh best_;
    ImproveRecord input_;
    ImproveRecord now_;
    double most_deviation_ = 0.0;
    double share_of_work_ = 1.0;
    bool exact_ = false;
    bool limits_given_ = false;
    double last_record_ = 0.0;
    std::vector<std::pair<std::string, double>> seconds_;
    std::vector<ImproveRecord> history_;
};

/// Fewer inverted cells, then a larger minimum.
bool better(const ImproveRecord& a, const ImproveRecord& b);

}  // namespace hex::improving
