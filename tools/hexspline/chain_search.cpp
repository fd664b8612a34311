/// What Chain tries on the route `labelling`, and when it leaves it.

#include "hexspline/chain.h"
#include "hexspline/element_size.h"

#include <hex/base/error.h>
#include <hex/io/hex_file.h>
#include <hex/map/map.h>
#include <hex/polycube/polycube.h>

#include <algorithm>
#include <limits>

namespace cli {
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

std::size_t Chain::go_on_after(const std::string& reason) {
    line_.info("these labels: " + reason);
    if (take_other_labels()) return segment_stage;
    if (take_postponed()) return polycube_stage;
    const auto wish = line_.get<std::string>("route");
    const auto& best = choice_.best();
    if (best && best->valid() && (best->acceptable() || !size_is_chosen() || wish == "labelling")) {
        keep_best();
        return improve_stage;
    }
    if (wish == "labelling")
        throw hex::Error(hex::ErrorKind::no_result, "the route by labelling ends: " + reason,
                         line_.input().string(),
                         "allow --route auto, or give a segmentation and blocks by hand");
    line_.info("the route by labelling ends; taking the route by voxels");
    take_voxel_route();
    report_["route_reason"] = reason;
    return segment_stage;
}

bool Chain::may_take_other_labels() const {
    // Only where this run made labels by the method that has others to offer.
    return !tried_labels_.empty() && !line_.given("weight") && attempt_ < last_attempt &&
           choice_.may_label(surface_->n_faces()) &&
           choice_.may_improve(static_cast<std::size_t>(first_target));
}

bool Chain::take_other_labels() {
    const std::size_t tried = tried_labels_.size();
    while (may_take_other_labels()) {
        label(++attempt_);
        if (tried_labels_.size() > tried) return true;
    }
    return false;
}

void Chain::postpone(double nearest) {
    if (postponed_ && postponed_->nearest <= nearest) return;
    postponed_ = Postponed{nearest, surface(), segmentation_, patches_, blocks(), map_memory_, report_};
}

bool Chain::take_postponed() {
    if (!postponed_) return false;
    Postponed taken = std::move(*postponed_);
    postponed_.reset();
    const auto& best = choice_.best();
    if ((best && best->acceptable()) || !choice_.may_improve(static_cast<std::size_t>(first_target)))
        return false;
    surface_ = std::move(taken.surface);
    segmentation_ = std::move(taken.segmentation);
    patches_ = std::move(taken.patches);
    blocks_ = std::move(taken.blocks);
    map_memory_ = std::move(taken.map_memory);
    report_ = std::move(taken.report);
    if (!tried_labels_.empty()) write_labels();
    write_polycube(hex::polycube(*patches_, {}, line_.context()).polycube);
    hex::io::write_hex_mesh(folder_ / "2-blocks.k", *blocks_);
    return true;
}

void Chain::take_voxel_route() {
    route_ = "voxel";
    patches_.reset();
    blocks_.reset();
    mapped_.reset();
    if (first_labels_) {
        segmentation_ = first_labels_;
        surface_ = hex::with_labels(std::move(*surface_), *segmentation_);
        write_labels();
        report_ = first_report_;
    }
    for (const char* key : {"patches", "block_structure", "improve"}) report_.erase(key);
    report_["route"] = route_;
    for (const char* name : {"2-polycube.k", "2-patches.k"}) std::filesystem::remove(folder_ / name);
}

bool Chain::is_searching() const {
    return route_ == "labelling" && blocks_made_;
}

bool Chain::wants_more() const {
    // A size that somebody asked for is not made up for.
    return size_is_chosen() ? choice_.best()->shortcoming() > 1.0 : !choice_.best()->valid();
}

Chain::Mapped Chain::mapped_to(double target) {
    hex::MapOptions options = element_size(line_);
    options.target_hexes = static_cast<std::size_t>(target);
    options.memory = &map_memory_;
    Mapped mapped;
    mapped.target = target;
    try {
        mapped.result = hex::map(patches(), blocks(), options, line_.context());
    } catch (const hex::Error& error) {
        if (error.kind() == hex::ErrorKind::cancelled || !is_searching()) throw;
        throw RouteClosed{error.what()};
    }
    mapped.apart = percent_apart(mapped.result.mesh);
    const hex::QualitySummary quality = hex::summarize(mapped.result.mesh, line_.context());
    mapped.folded = static_cast<double>(quality.inverted) / static_cast<double>(quality.cells);
    line_.info(std::to_string(mapped.result.mesh.cell_count()) + " hexahedra are within " +
               std::to_string(mapped.apart) + " % of the diagonal of the surface");
    return mapped;
}

Chain::Mapped Chain::as_fine_as_needed() {
    const auto follows = [](const Mapped& mapped) {
        return mapped.apart <= (mapped.folded > much_folded ? 1.0 : before_improvement) * wished_distance;
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

bool Chain::take_finer_mesh(bool nearer) {
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

void Chain::refine_while_wanted(const Candidate& coarse) {
    double distance = coarse.distance;
    for (int n = 0; n < most_refinements && wants_more(); ++n) {
        const bool nearer = distance > wished_distance;
        if (!nearer && n >= most_refinements_for_shape) return;
        if (!take_finer_mesh(nearer)) return;
        distance = improve_and_consider().distance;
    }
}

// Blocks have edges on smooth parts of the surface: no motion of vertices makes good corners there, where the
// surface leaves an angle of nearly 180 degrees, but with a layer each element has one face outside.
Candidate Chain::improve_with_and_without_layer(const hex::HexMesh& mapped) {
    layer_first_ = mapped_folded_ > much_folded;
    Candidate first = improve_and_consider();
    if (!wants_more() || !choice_.may_improve(mapped.cell_count())) return first;
    layer_first_ = !layer_first_;
    line_.info(std::string("the improved mesh is not good enough; once more ") +
               (layer_first_ ? "with" : "without") + " a layer around it");
    mapped_ = mapped;
    Candidate second = improve_and_consider();
    if (newest_is_best_) return second;
    layer_first_ = !layer_first_;
    return first;
}

void Chain::take_mapped(Mapped mapped) {
    line_.log(mapped.result.report.diagnostics);
    mapped_ = std::move(mapped.result.mesh);
    mapped_target_ = mapped.target;
    mapped_apart_ = mapped.apart;
    mapped_folded_ = mapped.folded;
}

Candidate Chain::improve_and_consider() {
    Candidate made;
    made.route = route_;
    made.mapped = *mapped_;
    made.improved = std::move(*mapped_);
    mapped_.reset();
    report_["improve"] = improve_mesh(made.improved);
    made.quality = hex::summarize(made.improved, line_.context());
    made.distance = percent_apart(made.improved);
    report_["surface_distance_percent"] = made.distance;
    report_quality(made.quality);
    made.report = report_;
    line_.info(made.description());
    Candidate summary;
    summary.quality = made.quality;
    summary.distance = made.distance;
    if (blocks_made_) {
        made.surface = surface();
        made.segmentation = segmentation_;
        made.patches = patches_;
        made.blocks = blocks();
    }
    newest_is_best_ = choice_.consider(std::move(made));
    return summary;
}

void Chain::keep_best() {
    const Candidate& best = *choice_.best();
    const std::string reason = report_.value("route_reason", std::string());
    report_ = best.report;
    if (blocks_made_ && !newest_is_best_) {
        route_ = best.route;
        surface_ = best.surface;
        segmentation_ = best.segmentation;
        patches_ = best.patches;
        blocks_ = best.blocks;
        if (!tried_labels_.empty()) write_labels();
        if (patches_) write_polycube(hex::polycube(*patches_, {}, line_.context()).polycube);
        hex::io::write_hex_mesh(folder_ / "2-blocks.k", *blocks_);
    }
    if (blocks_made_) hex::io::write_hex_mesh(folder_ / "3-map.vtk", best.mapped);
    hex::io::write_hex_mesh(folder_ / "4-improve.vtk", best.improved);
    improved_ = best.improved;
    if (route_ == "labelling" && !reason.empty())
        report_["route_reason"] = "the route voxel gives nothing better";
    line_.info("route " + route_ + ": " + best.description());
}

}  // namespace cli
