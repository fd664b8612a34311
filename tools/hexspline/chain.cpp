#include "hexspline/chain.h"

#include "hexspline/element_size.h"
#include "hexspline/inputs.h"
#include "hexspline/surface_input.h"

#include <hex/base/error.h>
#include <hex/improve/improve.h>
#include <hex/io/hex_file.h>
#include <hex/io/list_file.h>
#include <hex/io/output_file.h>
#include <hex/io/surface_file.h>
#include <hex/map/map.h>
#include <hex/polycube/blocks.h>
#include <hex/polycube/voxel.h>
#include <hex/quality/surface_distance.h>
#include <spline/io/bext.h>
#include <spline/io/bezier_vtu.h>
#include <spline/jacobian.h>
#include <spline/repair.h>
#include <spline/spline.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <sstream>

namespace cli {
namespace {

constexpr std::array<const char*, 5> stage_names = {"segment", "polycube", "map", "improve", "spline"};

std::size_t stage_index(const std::string& option, const std::string& name) {
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
        if (name == stage_names[i]) return i;
    }
    throw hex::Error(hex::ErrorKind::usage, "--" + option + " names no stage: '" + name + "'", {},
                     "use segment, polycube, map, improve or spline");
}

std::vector<std::string> split_list(const std::string& text) {
    std::vector<std::string> items;
    std::istringstream stream(text);
    for (std::string item; std::getline(stream, item, ',');) {
        if (!item.empty() && item != "none") items.push_back(item);
    }
    return items;
}

/// The route that an earlier run into this folder took; empty when it cannot be told.
std::string route_of_report(const std::filesystem::path& file) {
    std::ifstream stream(file);
    const Json report = Json::parse(stream, nullptr, false);
    return report.is_object() && report.contains("route") && report["route"].is_string()
               ? report["route"].get<std::string>()
               : std::string();
}

std::string first_error(const hex::Diagnostics& diagnostics) {
    for (const auto& finding : diagnostics) {
        if (finding.severity == hex::Severity::error) return finding.message;
    }
    return {};
}

}  // namespace

Chain::Chain(const CommandLine& line) : line_(line), folder_(line.output()) {}

int Chain::run() {
    const std::size_t first = stage_index("from", line_.get<std::string>("from"));
    const std::size_t last = stage_index("to", line_.get<std::string>("to"));
    if (first > last) throw hex::Error(hex::ErrorKind::usage, "--from comes after --to");
    make_folder();
    choose_route(first);
    for (std::size_t stage = first; stage <= last; ++stage) {
        try {
            run_stage(stage);
        } catch (const RouteClosed& closed) {
            // Mostly other labels.
            const auto start = std::chrono::steady_clock::now();
            stage = go_on_after(closed.reason);
            count_time(segment_stage, start);
        }
    }
    double total = 0;
    for (const auto& [stage, seconds] : seconds_.items()) total += seconds.get<double>();
    if (!choice_.tries().empty()) report_["tries"] = choice_.tries();
    seconds_["total"] = total;
    report_["seconds"] = seconds_;
    hex::io::write_file(folder_ / "report.json", report_.dump(2) + "\n");
    line_.write_report(report_);
    return 0;
}

void Chain::run_stage(std::size_t stage) {
    constexpr std::array<void (Chain::*)(), 5> stages = {&Chain::segment, &Chain::polycube, &Chain::map,
                                                         &Chain::improve, &Chain::spline};
    const auto start = std::chrono::steady_clock::now();
    line_.info(std::string(stage_names[stage]) + " ...");
    try {
        (this->*stages[stage])();
    } catch (const RouteClosed&) {
        count_time(stage, start);
        throw;
    }
    count_time(stage, start);
}

void Chain::count_time(std::size_t stage, std::chrono::steady_clock::time_point start) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const char* name = stage_names[stage];
    seconds_[name] = (seconds_.contains(name) ? seconds_[name].get<double>() : 0.0) + elapsed.count();
}

void Chain::make_folder() {
    std::error_code problem;
    std::filesystem::create_directories(folder_, problem);
    if (problem || !std::filesystem::is_directory(folder_))
        throw hex::Error(hex::ErrorKind::output, "the output folder cannot be made", folder_.string());
}

void Chain::choose_route(std::size_t first) {
    const auto wish = line_.get<std::string>("route");
    if (wish != "auto" && wish != "labelling" && wish != "voxel")
        throw hex::Error(hex::ErrorKind::usage, "--route is not known: '" + wish + "'", {},
                         "use auto, labelling or voxel");
    // An earlier run's files are gone on with along its route.
    const std::string earlier =
        first == segment_stage ? std::string() : route_of_report(folder_ / "report.json");
    if (line_.given("segmentation") || line_.given("blocks"))
        route_ = "given";
    else if (wish == "voxel")
        route_ = "voxel";
    else if (!earlier.empty())
        route_ = earlier;
    else
        route_ = "labelling";
    if (route_ == "given" && wish != "auto")
        throw hex::Error(hex::ErrorKind::usage,
                         "--route and a person's --segmentation or --blocks exclude each other");
    report_["route"] = route_;  // first in the file
}

void Chain::segment() {
    SurfaceInput input = load_surface_input(line_, line_.input());
    surface_ = std::move(input.mesh);
    report_["repair"] = std::move(input.repair);
    label(0);
    first_labels_ = segmentation_;
    first_report_ = report_;
}

void Chain::label(int attempt) {
    hex::SegmentOptions options;
    options.boundary_weight = line_.get<double>("weight");
    options.attempt = attempt;
    if (line_.given("weight")) options.method = "hbecvt";
    hex::SegmentResult result = attempt > 0 && next_labels_
                                    ? std::move(*next_labels_)
                                    : hex::segment(*surface_, options, line_.context());
    next_labels_ = std::move(result.next_attempt);
    choice_.count_labelled(surface_->n_faces());
    if (std::find(tried_labels_.begin(), tried_labels_.end(), result.segmentation.labels) !=
        tried_labels_.end())
        return;
    tried_labels_.push_back(result.segmentation.labels);
    attempt_ = attempt;
    report_["charts"] = result.report.charts;
    report_["corners"] = report_["label_corners"] = result.report.corners;
    report_["label_attempt"] = attempt;
    Json repairs = Json::array();
    for (const auto& repair : result.report.repairs)
        repairs.push_back({{"repair", repair.repair},
                           {"reason", repair.reason},
                           {"triangle", repair.triangle},
                           {"triangles", repair.triangles}});
    report_["repairs"] = repairs;
    surface_ = hex::with_labels(std::move(*surface_), result.segmentation);
    segmentation_ = std::move(result.segmentation);
    write_labels();
}

void Chain::write_labels() const {
    hex::io::write_labels(folder_ / "1-labels.txt", segmentation_->labels);
    hex::io::write_surface(folder_ / "1-segment.k", hex::to_soup(*surface_));
}

void Chain::polycube() {
    if (route_ == "given")
        polycube_of_patches();
    else if (route_ == "labelling")
        polycube_of_labels();
    else
        polycube_of_voxels();
}

void Chain::polycube_of_patches() {
    const bool given = line_.given("segmentation");
    const std::filesystem::path file =
        given ? line_.get<std::string>("segmentation") : (folder_ / "1-segment.k").string();
    hex::TriangleMesh mesh = !given && surface_ ? *surface_ : load_triangles(line_, file);
    const auto result = hex::polycube(mesh, {}, line_.context());
    if (result.report.invalid_patches > 0) {
        line_.log(result.report.violations, file.string());
        throw hex::Error(
            hex::ErrorKind::no_result,
            std::to_string(result.report.invalid_patches) + " patches are no four-cornered disks",
            file.string(), "give a surface cut into four-sided patches with --segmentation");
    }
    report_["patches"] = result.report.patches;
    report_["corners"] = result.report.corners;
    for (const auto f : mesh.faces())
        mesh.data(f).part = result.polycube.layout.patch_of_triangle[static_cast<std::size_t>(f.idx())] + 1;
    patches_ = std::move(mesh);
    write_polycube(result.polycube);
    if (!line_.given("blocks")) return;
    blocks_ = load_hexahedra(line_, line_.get<std::string>("blocks"));
    hex::io::write_hex_mesh(folder_ / "2-blocks.k", *blocks_);
}

void Chain::polycube_of_labels() {
    if (!segmentation_) {
        segmentation_.emplace(hex::Segmentation{hex::labels_of_parts(surface())});
        if (segmentation_->labels.empty()) throw RouteClosed{"the part ids of 1-segment.k are no labels"};
    }
    hex::BlocksResult made;
    try {
        made = hex::make_blocks(surface(), *segmentation_, {}, line_.context());
    } catch (const hex::Error& error) {
        if (error.kind() != hex::ErrorKind::no_result) throw;
        throw RouteClosed{error.what()};
    }
    Json structure = {
        {"bodies", made.report.bodies}, {"turned_shells", made.report.turned_shells},
        {"planes", made.report.planes}, {"cells", made.report.cells},
        {"unit", made.report.unit},     {"min_scaled_jacobian", made.report.min_scaled_jacobian}};
    report_["block_structure"] = structure;
    if (const std::string wrong = first_error(made.report.violations); !wrong.empty())
        throw RouteClosed{wrong};
    const auto quads = hex::polycube(made.patches, {}, line_.context());
    if (quads.report.invalid_patches > 0)
        throw RouteClosed{std::to_string(quads.report.invalid_patches) +
                          " patches are no four-cornered disks"};
    report_["patches"] = quads.report.patches;
    report_["corners"] = quads.report.corners;
    patches_ = std::move(made.patches);
    blocks_ = std::move(made.blocks);
    blocks_made_ = true;
    write_polycube(quads.polycube);
    hex::io::write_hex_mesh(folder_ / "2-blocks.k", *blocks_);
}

void Chain::write_polycube(const hex::Polycube& quads) const {
    hex::io::write_surface(folder_ / "2-polycube.k", hex::polycube_surface(quads));
    hex::io::write_surface(folder_ / "2-patches.k", hex::to_soup(*patches_));
}

void Chain::polycube_of_voxels() {
    hex::VoxelOptions options;
    if (line_.given("edge-length")) options.cell_size = element_size(line_).edge_length;
    if (line_.given("target-hexes")) options.target_cells = element_size(line_).target_hexes;
    auto result = hex::voxel_blocks(surface(), options, line_.context());
    report_["voxels"] = {{"grid", result.report.grid},
                         {"cell_size", result.report.cell_size},
                         {"tries", result.report.tries},
                         {"repairs", result.report.repairs}};
    blocks_ = std::move(result.cells);
    blocks_made_ = true;
    hex::io::write_hex_mesh(folder_ / "2-blocks.k", *blocks_);
}

bool Chain::size_is_chosen() const {
    return route_ == "labelling" && !line_.given("level") && !line_.given("edge-length") &&
           !line_.given("target-hexes");
}

void Chain::map() {
    if (route_ == "voxel") {
        mapped_ = blocks();
    } else if (size_is_chosen()) {
        take_mapped(as_fine_as_needed());
    } else {
        take_mapped({hex::map(patches(), blocks(), element_size(line_), line_.context())});
    }
    report_mapped();
}

void Chain::report_mapped() {
    report_["blocks"] = blocks().cell_count();
    report_quality(hex::summarize(*mapped_, line_.context()));
    hex::io::write_hex_mesh(folder_ / "3-map.vtk", *mapped_);
}

void Chain::improve() {
    if (!mapped_) mapped_ = load_hexahedra(line_, folder_ / "3-map.vtk");
    const bool may_layer = is_searching() && !line_.given("improve");
    const hex::HexMesh mapped = may_layer ? *mapped_ : hex::HexMesh();
    layer_first_ = false;
    const Candidate made = may_layer ? improve_with_and_without_layer(mapped) : improve_and_consider();
    if (is_searching()) {
        if (size_is_chosen()) refine_while_wanted(made);
        if (wants_more()) throw RouteClosed{"at best " + choice_.best()->description()};
    }
    keep_best();
    if (!choice_.best()->valid())
        throw hex::Error(hex::ErrorKind::no_result,
                         std::to_string(choice_.best()->quality.inverted) +
                             " elements of the improved mesh are still inverted",
                         (folder_ / "4-improve.vtk").string(),
                         "mend the blocks, or try other --improve methods");
}

Json Chain::improve_mesh(hex::HexMesh& mesh) {
    Json steps = Json::array();
    // The cells of a grid are brought to the surface first.
    const bool from_voxels = route_ == "voxel" && !line_.given("improve");
    const std::string first = from_voxels ? "snap," : layer_first_ ? "pillow," : "";
    for (const auto& method : split_list(first + line_.get<std::string>("improve"))) {
        hex::ImproveOptions options;
        options.method = method;
        options.features = hex::FeatureSource::angle;
        options.feature_cosine = line_.get<double>("sharp-cosine");
        options.surface = &patches();
        options.work_limit = MeshChoice::most_work;
        auto result = hex::improve(mesh, options, line_.context());
        line_.log(result.report.diagnostics);
        steps.push_back({{"method", method},
                         {"min_scaled_jacobian", {result.report.before.min, result.report.after.min}},
                         {"inverted", {result.report.before.inverted, result.report.after.inverted}},
                         {"work", result.report.work}});
        mesh = std::move(result.mesh);
    }
    return steps;
}

double Chain::percent_apart(const hex::HexMesh& mesh) {
    const auto apart = hex::surface_distance(mesh, patches(), line_.context());
    return apart.percent(apart.max());
}

void Chain::spline() {
    if (!improved_) improved_ = load_hexahedra(line_, folder_ / "4-improve.vtk");
    ::spline::SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.feature_cosine = line_.get<double>("sharp-cosine");
    auto result = ::spline::build(*improved_, options, line_.context());
    line_.log(result.report.diagnostics);
    ::spline::JacobianReport jacobians = ::spline::certify(result.spline, {}, line_.context());
    const auto repair = ::spline::repair_jacobian(result.spline, jacobians, {}, line_.context());
    report_["spline_jacobians"] = {{"negative_before_repair", repair.negative_before},
                                   {"negative", jacobians.negative.size()},
                                   {"undecided", jacobians.undecided.size()}};
    if (!jacobians.negative.empty())
        line_.warn(
            std::to_string(jacobians.negative.size()) +
            " elements of the spline have a negative Jacobian: " + ::spline::describe_negative(jacobians));
    report_["control_points"] = result.spline.control_points.size();
    report_["bezier_elements"] = result.report.summary.elements;
    ::spline::io::write_bext(folder_ / "5-spline.bext", result.spline);
    ::spline::io::write_bezier_vtu(folder_ / "5-spline.vtu", result.spline);
}

const hex::TriangleMesh& Chain::surface() {
    if (!surface_) surface_ = load_triangles(line_, folder_ / "1-segment.k");
    return *surface_;
}

const hex::TriangleMesh& Chain::patches() {
    if (route_ == "voxel") return surface();
    if (!patches_)
        patches_ = load_triangles(
            line_, std::filesystem::exists(folder_ / "2-patches.k") || !line_.given("segmentation")
                       ? folder_ / "2-patches.k"
                       : std::filesystem::path(line_.get<std::string>("segmentation")));
    return *patches_;
}

const hex::HexMesh& Chain::blocks() {
    if (blocks_) return *blocks_;
    if (line_.given("blocks")) {
        blocks_ = load_hexahedra(line_, line_.get<std::string>("blocks"));
    } else {
        if (!std::filesystem::exists(folder_ / "2-blocks.k"))
            throw hex::Error(hex::ErrorKind::usage, "there are no blocks to map", {},
                             "give them with --blocks");
        blocks_ = load_hexahedra(line_, folder_ / "2-blocks.k");
    }
    return *blocks_;
}

void Chain::report_quality(const hex::QualitySummary& summary) {
    report_["hexes"] = summary.cells;
    report_["min_scaled_jacobian"] = summary.min;
    report_["mean_scaled_jacobian"] = summary.mean;
    report_["inverted"] = summary.inverted;
}

}  // namespace cli
