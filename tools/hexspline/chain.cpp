#include "hexspline/chain.h"

#include "hexspline/chain_report.h"
#include "hexspline/element_size.h"
#include "hexspline/inputs.h"
#include "hexspline/surface_input.h"

#include <hex/base/error.h>
#include <hex/io/hex_file.h>
#include <hex/io/list_file.h>
#include <hex/io/output_file.h>
#include <hex/io/surface_file.h>
#include <hex/polycube/polycube.h>
#include <hex/surface/polygon_soup.h>
#include <spline/io/bext.h>
#include <spline/io/bezier_vtu.h>
#include <spline/jacobian.h>
#include <spline/repair.h>
#include <spline/spline.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <vector>

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

}  // namespace

Chain::Chain(const CommandLine& line) : line_(line), folder_(line.output()) {
    options_.map = element_size(line);
    options_.choose_size = !line.given("level") && !line.given("edge-length") && !line.given("target-hexes");
    if (line.given("weight")) options_.boundary_weight = line.get<double>("weight");
    if (line.given("improve")) options_.improve = split_list(line.get<std::string>("improve"));
    options_.feature_cosine = line.get<double>("sharp-cosine");
    options_.on_made = [this](hex::HexStage stage, const hex::HexModel& model) { write(stage, model); };
}

int Chain::run() {
    const auto first = static_cast<Stage>(stage_index("from", line_.get<std::string>("from")));
    const auto last = static_cast<Stage>(stage_index("to", line_.get<std::string>("to")));
    if (first > last) throw hex::Error(hex::ErrorKind::usage, "--from comes after --to");
    earlier_ = EarlierRun(folder_);
    choose_route(first);
    require_inputs_stay(first);
    require_blocks(first, last);
    if (first > segment_stage) {
        require_results_before(first);
        earlier_.require_input(line_.input());
        input_file_ = earlier_.input_file();
    }
    if (first < spline_stage) run_hex_stages(first, std::min(last, improve_stage));
    if (last == spline_stage) {
        const auto start = std::chrono::steady_clock::now();
        spline();
        count_time(spline_stage, start);
    }
    const Json made = report();
    hex::io::write_file(folder_ / "report.json", made.dump(2) + "\n");
    line_.write_report(made);
    return 0;
}

void Chain::make_folder() const {
    std::error_code problem;
    std::filesystem::create_directories(folder_, problem);
    if (problem || !std::filesystem::is_directory(folder_))
        throw hex::Error(hex::ErrorKind::output, "the output folder cannot be made", folder_.string());
}

bool Chain::is_given(const char* option, const std::filesystem::path& file) const {
    std::error_code ignored;
    return line_.given(option) && std::filesystem::equivalent(line_.get<std::string>(option), file, ignored);
}

void Chain::require_inputs_stay(Stage first) const {
    if (first > segment_stage) return;
    // Its part ids would be others afterwards.
    for (const char* name : {"1-segment.k", "2-polycube.k", "2-patches.k"})
        if (is_given("input", folder_ / name))
            throw hex::Error(hex::ErrorKind::usage, "the input would be overwritten", line_.input().string(),
                             "go on with --from polycube, or give another output folder");
}

void Chain::require_blocks(Stage first, Stage last) const {
    if (model_.route == hex::Route::given && first <= polycube_stage && last >= map_stage &&
        !line_.given("blocks") && !is_there(folder_ / "2-blocks.k"))
        throw hex::Error(hex::ErrorKind::usage, "there are no blocks to map", {}, "give them with --blocks");
}

void Chain::require_results_before(Stage first) const {
    const auto require = [&](const char* name, const char* option) {
        if ((option != nullptr && line_.given(option)) || is_there(folder_ / name)) return;
        std::string advice = "run the stages before it first";
        if (option != nullptr) advice.append(", or give --").append(option);
        if (name == std::string_view("2-patches.k") && is_there(folder_ / "2-blocks.k"))
            advice += ", or --route voxel where the blocks are made of voxels";
        throw hex::Error(hex::ErrorKind::bad_input,
                         std::string("is missing, and --from ") + stage_names[first] + " goes on with it",
                         (folder_ / name).string(), advice);
    };
    if (first == spline_stage) return require("4-improve.vtk", nullptr);
    if (first == improve_stage) require("3-map.vtk", nullptr);
    if (first == map_stage) require("2-blocks.k", "blocks");
    if (first == polycube_stage || model_.route == hex::Route::voxel)
        require("1-segment.k", model_.route == hex::Route::voxel ? nullptr : "segmentation");
    else
        require("2-patches.k", "segmentation");
}

void Chain::choose_route(Stage first) {
    const auto wish = line_.get<std::string>("route");
    if (wish != "auto" && wish != "labelling" && wish != "voxel")
        throw hex::Error(hex::ErrorKind::usage, "--route is not known: '" + wish + "'", {},
                         "use auto, labelling or voxel");
    const bool is_given = line_.given("segmentation") || line_.given("blocks");
    if (is_given && wish != "auto")
        throw hex::Error(hex::ErrorKind::usage,
                         "--route and a person's --segmentation or --blocks exclude each other");
    // An earlier run's files are gone on with along its route.
    const auto earlier = first > segment_stage ? earlier_.route() : std::nullopt;
    options_.route = is_given          ? hex::Route::given
                     : wish == "voxel" ? hex::Route::voxel
                                       : earlier.value_or(hex::Route::labelling);
    options_.or_voxels = wish == "auto";
    model_.route = options_.route;
}

void Chain::run_hex_stages(Stage first, Stage last) {
    auto start = std::chrono::steady_clock::now();
    const bool is_given = model_.route == hex::Route::given;
    if (first == segment_stage) {
        SurfaceInput input = load_surface_input(line_, line_.input());
        model_.surface = std::move(input.mesh);
        repair_ = {{"repair", std::move(input.repair)}};
        input_file_ = fingerprint(line_.input());
        make_folder();
    } else if (model_.route == hex::Route::voxel || (first == polycube_stage && !is_given)) {
        model_.surface = load_triangles(line_, folder_ / "1-segment.k");
    }
    count_time(first, start);
    if (is_given && first <= polycube_stage) {
        if (first == segment_stage) hexahedralize(segment_stage, segment_stage);
        if (last < polycube_stage) return;
        start = std::chrono::steady_clock::now();
        check_given_patches();
        count_time(polycube_stage, start);
        if (last < map_stage) return;
        first = map_stage;
    }
    start = std::chrono::steady_clock::now();
    if (first == map_stage) load_blocks();
    if (first >= map_stage) load_patches();
    if (first == improve_stage) model_.mapped = load_hexahedra(line_, folder_ / "3-map.vtk");
    count_time(first, start);
    make_folder();
    hexahedralize(first, last);
    if (last == improve_stage && model_.quality->inverted > 0)
        throw hex::Error(
            hex::ErrorKind::no_result,
            std::to_string(model_.quality->inverted) + " elements of the improved mesh are still inverted",
            (folder_ / "4-improve.vtk").string(), "mend the blocks, or try other --improve methods");
}

void Chain::hexahedralize(Stage first, Stage last) {
    hex::HexahedralizeResult result;
    try {
        result = hex::hexahedralize(std::move(model_), static_cast<hex::HexStage>(first),
                                    static_cast<hex::HexStage>(last), options_, line_.context());
    } catch (const hex::Error& error) {
        if (error.kind() == hex::ErrorKind::no_result) throw error.located(line_.input().string());
        throw;
    }
    model_ = std::move(result.model);
    route_reason_ = std::move(result.route_reason);
    for (const auto& tried : result.tries) tries_.push_back(describe(tried));
    for (std::size_t stage = segment_stage; stage < hex::hex_stage_count; ++stage)
        if (result.seconds[stage] > 0.0) add_seconds(static_cast<Stage>(stage), result.seconds[stage]);
}

void Chain::check_given_patches() {
    line_.info("polycube ...");
    const bool is_given = line_.given("segmentation");
    const std::filesystem::path file =
        is_given ? line_.get<std::string>("segmentation") : (folder_ / "1-segment.k").string();
    hex::TriangleMesh mesh = !is_given && model_.segmentation ? model_.surface : load_triangles(line_, file);
    auto result = hex::polycube(mesh, {}, line_.context());
    if (result.report.invalid_patches > 0) {
        line_.log(result.report.violations, file.string());
        throw hex::Error(
            hex::ErrorKind::no_result,
            std::to_string(result.report.invalid_patches) + " patches are no four-cornered disks",
            file.string(), "give a surface cut into four-sided patches with --segmentation");
    }
    for (const auto f : mesh.faces())
        mesh.data(f).part = result.polycube.layout.patch_of_triangle[static_cast<std::size_t>(f.idx())] + 1;
    model_.patches = std::move(mesh);
    model_.polycube = std::move(result.polycube);
    if (line_.given("blocks")) load_blocks();
    make_folder();
    write(hex::HexStage::polycube, model_);
}

void Chain::load_blocks() {
    if (model_.blocks) return;
    std::filesystem::path file = folder_ / "2-blocks.k";
    if (line_.given("blocks"))
        file = line_.get<std::string>("blocks");
    else if (!is_there(file))
        throw hex::Error(hex::ErrorKind::usage, "there are no blocks to map", {}, "give them with --blocks");
    model_.blocks = load_hexahedra(line_, file);
}

void Chain::load_patches() {
    if (model_.patches || model_.route == hex::Route::voxel) return;
    std::filesystem::path file = folder_ / "2-patches.k";
    if (!is_there(file) && line_.given("segmentation")) file = line_.get<std::string>("segmentation");
    model_.patches = load_triangles(line_, file);
}

void Chain::remove(const char* name) const {
    std::error_code problem;
    std::filesystem::remove(folder_ / name, problem);
    if (problem)
        throw hex::Error(hex::ErrorKind::output, "cannot be removed (" + problem.message() + ")",
                         (folder_ / name).string());
}

void Chain::remove_results_after(Stage stage) const {
    remove("report.json");
    if (stage < map_stage) remove("3-map.vtk");
    if (stage < improve_stage) remove("4-improve.vtk");
    for (const char* name : {"5-spline.bext", "5-spline.vtu"}) remove(name);
}

void Chain::remove_blocks_of_another_part() const {
    if (earlier_.input_file().is_null() || earlier_.input_file() == input_file_) return;
    for (const char* name : {"2-polycube.k", "2-patches.k"})
        if (!is_given("segmentation", folder_ / name)) remove(name);
    if (!is_given("blocks", folder_ / "2-blocks.k")) remove("2-blocks.k");
}

void Chain::write(hex::HexStage stage, const hex::HexModel& model) const {
    remove_results_after(static_cast<Stage>(stage));
    switch (stage) {
        case hex::HexStage::segment:
            remove_blocks_of_another_part();
            hex::io::write_labels(folder_ / "1-labels.txt", model.segmentation->labels);
            hex::io::write_surface(folder_ / "1-segment.k", hex::to_soup(model.surface));
            return;
        case hex::HexStage::polycube:
            if (model.polycube) {
                hex::io::write_surface(folder_ / "2-polycube.k", hex::polycube_surface(*model.polycube));
                if (!is_given("segmentation", folder_ / "2-patches.k"))
                    hex::io::write_surface(folder_ / "2-patches.k", hex::to_soup(*model.patches));
            } else {
                for (const char* name : {"2-polycube.k", "2-patches.k"}) remove(name);
            }
            if (model.blocks && !is_given("blocks", folder_ / "2-blocks.k"))
                hex::io::write_hex_mesh(folder_ / "2-blocks.k", *model.blocks);
            return;
        case hex::HexStage::map:
            return hex::io::write_hex_mesh(folder_ / "3-map.vtk", *model.mapped);
        case hex::HexStage::improve:
            return hex::io::write_hex_mesh(folder_ / "4-improve.vtk", *model.improved);
    }
}

void Chain::spline() {
    line_.info("spline ...");
    if (!model_.improved) model_.improved = load_hexahedra(line_, folder_ / "4-improve.vtk");
    ::spline::SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.feature_cosine = options_.feature_cosine;
    auto result = ::spline::build(*model_.improved, options, line_.context());
    line_.log(result.report.diagnostics);
    ::spline::JacobianReport jacobians = ::spline::certify(result.spline, {}, line_.context());
    const auto repair = ::spline::repair_jacobian(result.spline, jacobians, {}, line_.context());
    spline_report_["spline_jacobians"] = {{"negative_before_repair", repair.negative_before},
                                          {"negative", jacobians.negative.size()},
                                          {"undecided", jacobians.undecided.size()}};
    if (!jacobians.negative.empty())
        line_.warn(
            std::to_string(jacobians.negative.size()) +
            " elements of the spline have a negative Jacobian: " + ::spline::describe_negative(jacobians));
    spline_report_["control_points"] = result.spline.control_points.size();
    spline_report_["bezier_elements"] = result.report.summary.elements;
    ::spline::io::write_bext(folder_ / "5-spline.bext", result.spline);
    ::spline::io::write_bezier_vtu(folder_ / "5-spline.vtu", result.spline);
}

void Chain::count_time(Stage stage, std::chrono::steady_clock::time_point start) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    add_seconds(stage, elapsed.count());
}

void Chain::add_seconds(Stage stage, double seconds) {
    if (!seconds_[stage]) seconds_[stage] = 0.0;
    *seconds_[stage] += seconds;
}

Json Chain::report() const {
    Json report = {{"route", hex::name_of(model_.route)}};
    if (!input_file_.is_null()) report["input_file"] = input_file_;
    report.update(repair_);
    report.update(describe(model_));
    report.update(spline_report_);
    if (!route_reason_.empty()) report["route_reason"] = route_reason_;
    if (!tries_.empty()) report["tries"] = tries_;
    Json seconds = Json::object();
    double total = 0.0;
    for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
        if (!seconds_[stage]) continue;
        seconds[stage_names[stage]] = *seconds_[stage];
        total += *seconds_[stage];
    }
    seconds["total"] = total;
    report["seconds"] = seconds;
    return report;
}

}  // namespace cli
