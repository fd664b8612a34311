/// The stages of a Search.
#include "hexahedralize/search.h"

#include <hex/base/error.h>
#include <hex/quality/surface_distance.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace hex {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string first_error(const Diagnostics& diagnostics) {
    for (const auto& finding : diagnostics)
        if (finding.severity == Severity::error) return finding.message;
    return {};
}

}  // namespace

double Search::Mapped::folded_share() const {
    return static_cast<double>(quality.inverted) / static_cast<double>(quality.cells);
}

Search::Search(HexModel start, const HexahedralizeOptions& options, const Context& context)
    : options_(options), context_(context), model_(std::move(start)) {
    model_.route = options.route;
}

HexahedralizeResult Search::run(HexStage first, HexStage last) {
    for (int stage = static_cast<int>(first); stage <= static_cast<int>(last); ++stage) {
        try {
            run_stage(static_cast<HexStage>(stage));
        } catch (const RouteClosed& closed) {
            // Mostly other labels.
            const auto start = Clock::now();
            stage = static_cast<int>(go_on_after(closed.reason));
            result_.seconds[static_cast<std::size_t>(HexStage::segment)] += seconds_since(start);
        }
    }
    result_.tries = choice_.tries();
    result_.model = std::move(model_);
    return std::move(result_);
}

void Search::run_stage(HexStage stage) {
    info(std::string(name_of(stage)) + " ...");
    struct Timer {
        double& seconds;
        Clock::time_point start = Clock::now();
        ~Timer() { seconds += seconds_since(start); }
    } timer{result_.seconds[static_cast<std::size_t>(stage)]};
    switch (stage) {
        case HexStage::segment:
            return segment();
        case HexStage::polycube:
            return polycube();
        case HexStage::map:
            return map();
        case HexStage::improve:
            return improve();
    }
}

void Search::tell(HexStage stage) const {
    if (options_.on_made) options_.on_made(stage, model_);
}

void Search::segment() {
    label(0);
    first_labels_ = model_;
}

bool Search::label(int attempt) {
    SegmentOptions options;
    options.attempt = attempt;
    if (options_.boundary_weight) {
        options.method = "hbecvt";
        options.boundary_weight = *options_.boundary_weight;
    }
    SegmentResult result = attempt > 0 && next_labels_ ? std::move(*next_labels_)
                                                       : hex::segment(model_.surface, options, context_);
    next_labels_ = std::move(result.next_attempt);
    choice_.count_labelled(model_.surface.n_faces());
    if (std::find(tried_labels_.begin(), tried_labels_.end(), result.segmentation.labels) !=
        tried_labels_.end())
        return false;
    tried_labels_.push_back(result.segmentation.labels);
    HexModel labelled;
    labelled.route = model_.route;
    labelled.surface = with_labels(std::move(model_.surface), result.segmentation);
    labelled.segmentation = std::move(result.segmentation);
    labelled.segment_report = std::move(result.report);
    labelled.label_attempt = attempt;
    model_ = std::move(labelled);
    tell(HexStage::segment);
    return true;
}

void Search::polycube() {
    if (model_.route == Route::given)
        throw Error(ErrorKind::usage, "on the route 'given' patches and blocks have to be given");
    if (model_.route == Route::labelling)
        polycube_of_labels();
    else
        polycube_of_voxels();
    blocks_made_ = true;
    tell(HexStage::polycube);
}

void Search::polycube_of_labels() {
    if (!model_.segmentation) {
        Segmentation labels{labels_of_parts(model_.surface)};
        if (labels.labels.empty()) throw RouteClosed{"the part ids of the surface are no labels"};
        model_.segmentation = std::move(labels);
    }
    BlocksResult made;
    try {
        made = make_blocks(model_.surface, *model_.segmentation, {}, context_);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::no_result) throw;
        throw RouteClosed{error.what()};
    }
    const std::string wrong = first_error(made.report.violations);
    model_.blocks_report = std::move(made.report);
    if (!wrong.empty()) throw RouteClosed{wrong};
    PolycubeResult quads = hex::polycube(made.patches, {}, context_);
    if (quads.report.invalid_patches > 0)
        throw RouteClosed{std::to_string(quads.report.invalid_patches) +
                          " patches are no four-cornered disks"};
    model_.polycube = std::move(quads.polycube);
    model_.patches = std::move(made.patches);
    model_.blocks = std::move(made.blocks);
}

void Search::polycube_of_voxels() {
    VoxelOptions options;
    if (options_.map.edge_length > 0.0) options.cell_size = options_.map.edge_length;
    if (options_.map.target_hexes > 0) options.target_cells = options_.map.target_hexes;
    VoxelResult made = voxel_blocks(model_.surface, options, context_);
    model_.voxel_report = std::move(made.report);
    model_.blocks = std::move(made.cells);
}

MapResult Search::map_blocks(const MapOptions& options) const {
    return hex::map(model_.mapped_surface(), *model_.blocks, options, context_);
}

void Search::map() {
    if (!model_.blocks) throw Error(ErrorKind::usage, "there are no blocks to map");
    if (model_.route == Route::voxel) {
        model_.mapped = *model_.blocks;
        model_.quality = summarize(*model_.mapped, context_);
    } else if (size_is_chosen()) {
        take_mapped(as_fine_as_needed());
    } else {
        Mapped mapped{.result = map_blocks(options_.map), .quality = {}};
        mapped.quality = summarize(mapped.result.mesh, context_);
        take_mapped(std::move(mapped));
    }
    tell(HexStage::map);
}

void Search::take_mapped(Mapped mapped) {
    log_findings(context_, mapped.result.report.diagnostics);
    mapped_target_ = mapped.target;
    mapped_apart_ = mapped.apart;
    mapped_folded_ = mapped.folded_share();
    model_.mapped = std::move(mapped.result.mesh);
    model_.quality = std::move(mapped.quality);
}

void Search::improve() {
    if (!model_.mapped) throw Error(ErrorKind::usage, "there is no mesh to improve");
    const bool may_layer = is_searching() && !options_.improve;
    const Improved made = may_layer ? improve_with_and_without_layer() : improve_mapped(false);
    if (is_searching()) {
        if (size_is_chosen()) refine_while_wanted(made);
        if (wants_more()) throw RouteClosed{"at best " + describe(*choice_.best())};
    }
    keep_best();
}

Search::Improved Search::improve_mapped(bool layer) {
    model_.improved = run_improvers(layer);
    model_.quality = summarize(*model_.improved, context_);
    model_.distance = percent_apart(*model_.improved);
    info(describe(model_));
    const Improved made{*model_.quality, model_.distance, layer};
    newest_is_best_ = choice_.consider(is_searching() ? model_ : std::move(model_));
    return made;
}

HexMesh Search::run_improvers(bool layer) {
    std::vector<std::string> methods = options_.improve.value_or(std::vector<std::string>{"auto"});
    if (layer) methods.insert(methods.begin(), "pillow");
    // The cells of a grid are brought to the surface first.
    if (model_.route == Route::voxel && !options_.improve) methods.insert(methods.begin(), "snap");
    model_.improve_steps.clear();
    HexMesh mesh = *model_.mapped;
    for (const std::string& method : methods) {
        ImproveOptions options;
        options.method = method;
        options.features = FeatureSource::angle;
        options.feature_cosine = options_.feature_cosine;
        options.surface = &model_.mapped_surface();
        options.work_limit = MeshChoice::most_work;
        ImproveResult result = hex::improve(mesh, options, context_);
        log_findings(context_, result.report.diagnostics);
        mesh = std::move(result.mesh);
        model_.improve_steps.push_back({method, std::move(result.report)});
    }
    return mesh;
}

double Search::percent_apart(const HexMesh& mesh) const {
    const SurfaceDistance apart = surface_distance(mesh, model_.mapped_surface(), context_);
    return apart.percent(apart.max());
}

}  // namespace hex
