#include "improve/ascent.h"

namespace hex::improving {
namespace {

/// Rises of the scaled Jacobian above the star's minimum. Everything within `ranges` of it has to rise along
/// the steepest direction; over `softness` the weight in the weighted direction falls off. From almost only
/// the worst to more and more regard for the others, because following the worst alone zigzags where several
/// are equally bad.
constexpr std::array<double, 2> ranges = {0.005, 0.05};
constexpr std::array<double, 3> softness = {0.02, 0.1, 0.5};
constexpr int most_halvings = 8;
/// The vertex goes no farther than this share of the mean edge length in one visit.
constexpr double farthest = 1.0;

}  // namespace

bool raise_star_minimum(Sweeper& sweeper, VertexId v, double step, Workspace& workspace) {
    const Vec3 here = sweeper.mesh().position(v);
    Star& star = sweeper.gather(v, workspace);
    const bool boundary = sweeper.on_boundary(v);
    const double length = sweeper.mean_edge_length(v);
    const StarQuality now = star.quality(here);
    StarQuality best = now;
    Vec3 best_place = here;

    const auto allowed = [&](const Vec3& gradient) {
        return boundary ? sweeper.motion().tangential(v, gradient) : gradient;
    };
    const auto search_along = [&](Vec3 direction) {
        const double norm = direction.norm();
        if (!(norm > 0.0)) return;
        direction *= length / norm;
        const auto improves = [&](double share) {
            const Vec3 wanted = here + share * direction;
            const Vec3 place = boundary ? sweeper.motion().constrained(v, wanted) : wanted;
            const StarQuality quality = star.quality(place);
            if (!quality.better_than(best)) return false;
            best = quality;
            best_place = place;
            return true;
        };
        double share = step;
        if (improves(share)) {
            while (share < farthest && improves(share = std::min(2.0 * share, farthest))) {
            }
        } else {
            for (int i = 0; i < most_halvings && !improves(share /= 2.0); ++i) {
            }
        }
    };
    star.compute_terms(here);
    for (const double range : ranges) search_along(star.steepest_ascent(range, allowed));
    for (const double range : softness) search_along(allowed(star.weighted_ascent(range)));
    if (!best.better_than(now)) return false;
    sweeper.move(v, best_place, star);
    return true;
}

}  // namespace hex::improving
