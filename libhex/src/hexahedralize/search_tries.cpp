/// What a Search tries on the route `labelling`, and when it leaves it.
#include "hexahedralize/search.h"

#include <hex/base/error.h>

#include <algorithm>
#include <utility>

namespace hex {
namespace {

/// Where no size is asked for, the route `labelling` starts from so many hexahedra, and takes more by this
/// factor until the mesh follows the surface.
constexpr double first_target = 1000;
constexpr double target_growth = 1.5;
constexpr double last_target = 8000;
/// What follows means: no farther apart than this share of the wished distance, for improvement brings the
/// boundary nearer.
constexpr double before_improvement = 1.25;
/// But where more than this share is folded, untangling takes what room there is: such a mesh must follow the
/// surface as it is, and gets a layer before anything else.
constexpr double much_folded = 0.05;
/// Where none does, the coarsest mesh that is no farther apart than this share of the nearest.
constexpr double nearly_as_near = 1.15;
/// Blocks that even the finest mesh does not bring nearer than this are given up: twice the wished distance.
constexpr double hopeless_distance = 2.0 * wished_distance;
/// A finer mesh is worth its price if it comes nearer by this factor.
constexpr double worth_refining = 0.95;
/// How often a finer mesh of the same blocks is tried, and how often if it is not the distance that lacks.
constexpr int most_refinements = 2;
constexpr int most_refinements_for_shape = 1;
/// SegmentOptions::attempt goes up to this.
constexpr int last_attempt = 3;

}  // namespace

HexStage Search::go_on_after(const std::string& reason) {
    info("these labels: " + reason);
    if (take_other_labels()) return HexStage::segment;
    if (take_postponed()) return HexStage::polycube;
    const auto& best = choice_.best();
    if (best && is_valid(*best) && (is_acceptable(*best) || !size_is_chosen() || !options_.or_voxels)) {
        keep_best();
        return HexStage::improve;
    }
    if (!options_.or_voxels)
        throw Error(ErrorKind::no_result, "the route by labelling ends: " + reason, {},
                    "allow --route auto, or give a segmentation and blocks by hand");
    info("the route by labelling ends; taking the route by voxels");
    take_voxel_route();
    result_.route_reason = reason;
    return HexStage::segment;
}

bool Search::may_take_other_labels() const {
    // Only where this call made labels by the method that has others to offer.
    return !tried_labels_.empty() && !options_.boundary_weight && attempt_ < last_attempt &&
           choice_.may_label(model_.surface.n_faces()) &&
           choice_.may_improve(static_cast<std::size_t>(first_target));
}

bool Search::take_other_labels() {
    while (may_take_other_labels())
        if (label(++attempt_)) return true;
    return false;
}

void Search::postpone(double nearest) {
    if (postponed_ && postponed_->nearest <= nearest) return;
    postponed_ = Postponed{nearest, model_, map_memory_};
}

bool Search::take_postponed() {
    if (!postponed_) return false;
    Postponed taken = std::move(*postponed_);
    postponed_.reset();
    const auto& best = choice_.best();
    if ((best && is_acceptable(*best)) || !choice_.may_improve(static_cast<std::size_t>(first_target)))
        return false;
    model_ = std::move(taken.model);
    map_memory_ = std::move(taken.map_memory);
    if (!tried_labels_.empty()) tell(HexStage::segment);
    tell(HexStage::polycube);
    return true;
}

void Search::take_voxel_route() {
    if (first_labels_) {
        model_ = std::move(*first_labels_);
        first_labels_.reset();
        tell(HexStage::segment);
    } else {
        HexModel bare;
        bare.surface = std::move(model_.surface);
        bare.segmentation = std::move(model_.segmentation);
        model_ = std::move(bare);
    }
    model_.route = Route::voxel;
}

bool Search::is_searching() const {
    return model_.route == Route::labelling && blocks_made_;
}

bool Search::size_is_chosen() const {
    return model_.route == Route::labelling && options_.choose_size;
}

bool Search::wants_more() const {
    // A size that somebody asked for is not made up for.
    return size_is_chosen() ? shortcoming(*choice_.best()) > 1.0 : !is_valid(*choice_.best());
}

Search::Mapped Search::mapped_to(double target) {
    MapOptions options = options_.map;
    options.edge_length = 0.0;
    options.target_hexes = static_cast<std::size_t>(target);
    options.memory = &map_memory_;
    Mapped mapped;
    mapped.target = target;
    try {
        mapped.result = map_blocks(options);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled || !is_searching()) throw;
        throw RouteClosed{error.what()};
    }
    mapped.apart = percent_apart(mapped.result.mesh);
    mapped.quality = summarize(mapped.result.mesh, context_);
    info(std::to_string(mapped.result.mesh.cell_count()) + " hexahedra are within " +
         std::to_string(mapped.apart) + " % of the diagonal of the surface");
    return mapped;
}

Search::Mapped Search::as_fine_as_needed() {
    const auto follows = [](const Mapped& mapped) {
        return mapped.apart <=
               (mapped.folded_share() > much_folded ? 1.0 : before_improvement) * wished_distance;
    };
    std::vector<double> targets;
    for (double target = first_target; target <= last_target; target *= target_growth)
        targets.push_back(target);
    Mapped coarsest = mapped_to(targets.front());
    if (follows(coarsest)) return coarsest;
    // What the finest does not reach, those between will not.
    Mapped finest = mapped_to(targets.back());
    const double nearest = std::min(coarsest.apart, finest.apart);
    if (is_searching() && !follows(finest)) {
        const std::string reason = "no mesh of these blocks follows the surface; the nearest is " +
                                   std::to_string(nearest) + " % of the diagonal off";
        const bool hopeless = nearest > hopeless_distance;
        if (hopeless)
            for (const Mapped* mapped : {&coarsest, &finest})
                choice_.count_mapped_in_vain(mapped->result.mesh.cell_count());
        // Improvement is what takes time; labels whose blocks follow the surface come first.
        if (!hopeless && may_take_other_labels()) postpone(nearest);
        if (hopeless || may_take_other_labels()) throw RouteClosed{reason};
    }
    const double near = follows(finest) ? 0.0 : nearly_as_near * nearest;
    if (coarsest.apart <= near) return coarsest;
    for (std::size_t i = 1; i + 1 < targets.size(); ++i) {
        Mapped mapped = mapped_to(targets[i]);
        if (follows(mapped) || mapped.apart <= near) return mapped;
    }
    return finest;
}

bool Search::take_finer_mesh(bool nearer) {
    try {
        for (double target = mapped_target_ * target_growth; target <= last_target; target *= target_growth) {
            if (!choice_.may_improve(static_cast<std::size_t>(target))) return false;
            Mapped mapped = mapped_to(target);
            if (nearer && mapped.apart > worth_refining * mapped_apart_) continue;
            take_mapped(std::move(mapped));
            return true;
        }
    } catch (const RouteClosed&) {
        // What there is may still do.
    }
    return false;
}

void Search::refine_while_wanted(const Improved& coarse) {
    double distance = coarse.distance;
    for (int n = 0; n < most_refinements && wants_more(); ++n) {
        const bool nearer = distance > wished_distance;
        if (!nearer && n >= most_refinements_for_shape) return;
        if (!take_finer_mesh(nearer)) return;
        distance = improve_mapped(coarse.layer).distance;
    }
}

// Blocks have edges on smooth parts of the surface: no motion of vertices makes good corners there, where the
// surface leaves an angle of nearly 180 degrees, but with a layer each element has one face outside.
Search::Improved Search::improve_with_and_without_layer() {
    const std::size_t hexahedra = model_.mapped->cell_count();
    const bool layer = mapped_folded_ > much_folded;
    const Improved first = improve_mapped(layer);
    if (!wants_more() || !choice_.may_improve(hexahedra)) return first;
    info(std::string("the improved mesh is not good enough; once more ") + (layer ? "without" : "with") +
         " a layer around it");
    const Improved second = improve_mapped(!layer);
    return newest_is_best_ ? second : first;
}

void Search::keep_best() {
    model_ = choice_.take_best();
    if (blocks_made_ && !newest_is_best_) {
        if (!tried_labels_.empty()) tell(HexStage::segment);
        tell(HexStage::polycube);
    }
    if (blocks_made_) tell(HexStage::map);
    tell(HexStage::improve);
    if (model_.route == Route::labelling && !result_.route_reason.empty())
        result_.route_reason = "the route voxel gives nothing better";
    info(std::string("route ") + name_of(model_.route) + ": " + describe(model_));
}

}  // namespace hex
