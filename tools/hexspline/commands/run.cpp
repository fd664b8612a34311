/// Sample runs:
///   hexspline run rod.stl --segmentation rod_patches.k --blocks rod_blocks.k -o out
///   hexspline run rod.stl --from improve -o out

#include "hexspline/command.h"
#include "hexspline/element_size.h"
#include "hexspline/inputs.h"

#include <hex/base/error.h>
#include <hex/improve/improve.h>
#include <hex/io/hex_file.h>
#include <hex/io/list_file.h>
#include <hex/io/output_file.h>
#include <hex/io/surface_file.h>
#include <hex/map/map.h>
#include <hex/polycube/polycube.h>
#include <hex/segment/segment.h>
#include <spline/io/bext.h>
#include <spline/io/bezier_vtu.h>
#include <spline/spline.h>

#include <array>
#include <chrono>
#include <optional>
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

/// The chain. What a stage makes stays in memory for the next one and is written to its numbered file; what
/// was made by an earlier run, or by a person, is read from there.
class Chain {
  public:
    explicit Chain(const CommandLine& line) : line_(line), folder_(line.output()) {}

    int run() {
        const std::size_t first = stage_index("from", line_.get<std::string>("from"));
        const std::size_t last = stage_index("to", line_.get<std::string>("to"));
        if (first > last) throw hex::Error(hex::ErrorKind::usage, "--from comes after --to");
        make_folder();
        const std::array<void (Chain::*)(), 5> stages = {&Chain::segment, &Chain::polycube, &Chain::map,
                                                         &Chain::improve, &Chain::spline};
        report_["route"] = "given";
        double total = 0;
        Json seconds;
        for (std::size_t s = first; s <= last; ++s) {
            const auto start = std::chrono::steady_clock::now();
            line_.info(std::string(stage_names[s]) + " ...");
            (this->*stages[s])();
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
            seconds[stage_names[s]] = elapsed.count();
            total += elapsed.count();
        }
        seconds["total"] = total;
        report_["seconds"] = seconds;
        hex::io::write_file(folder_ / "report.json", report_.dump(2) + "\n");
        line_.write_report(report_);
        return 0;
    }

  private:
    void make_folder() {
        std::error_code problem;
        std::filesystem::create_directories(folder_, problem);
        if (problem || !std::filesystem::is_directory(folder_))
            throw hex::Error(hex::ErrorKind::output, "the output folder cannot be made", folder_.string());
    }

    void segment() {
        const hex::TriangleMesh mesh = load_triangles(line_, line_.input());
        hex::SegmentOptions options;
        options.boundary_weight = line_.get<double>("weight");
        if (line_.given("weight")) options.method = "hbecvt";
        auto result = hex::segment(mesh, options, line_.context());
        report_["charts"] = hex::find_patches(hex::with_labels(mesh, result.segmentation)).patches.size();
        hex::io::write_labels(folder_ / "1-labels.txt", result.segmentation.labels);
        labelled_ = hex::with_labels(mesh, result.segmentation);
        hex::io::write_surface(folder_ / "1-segment.k", hex::to_soup(*labelled_));
    }

    void polycube() {
        const bool given = line_.given("segmentation");
        const std::filesystem::path file =
            given ? line_.get<std::string>("segmentation") : (folder_ / "1-segment.k").string();
        hex::TriangleMesh mesh = !given && labelled_ ? *labelled_ : load_triangles(line_, file);
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
            mesh.data(f).part =
                result.polycube.layout.patch_of_triangle[static_cast<std::size_t>(f.idx())] + 1;
        patches_ = std::move(mesh);
        hex::io::write_surface(folder_ / "2-polycube.k", hex::polycube_surface(result.polycube));
        hex::io::write_surface(folder_ / "2-patches.k", hex::to_soup(*patches_));
        if (!line_.given("blocks")) return;
        blocks_ = load_hexahedra(line_, line_.get<std::string>("blocks"));
        hex::io::write_hex_mesh(folder_ / "2-blocks.k", *blocks_);
    }

    void map() {
        if (!blocks_ && line_.given("blocks"))
            blocks_ = load_hexahedra(line_, line_.get<std::string>("blocks"));
        if (!blocks_ && !std::filesystem::exists(folder_ / "2-blocks.k"))
            throw hex::Error(hex::ErrorKind::usage, "there are no blocks to map", {},
                             "give them with --blocks");
        if (!blocks_) blocks_ = load_hexahedra(line_, folder_ / "2-blocks.k");
        const hex::MapOptions options = element_size(line_);
        auto result = hex::map(patches(), *blocks_, options, line_.context());
        line_.log(result.report.diagnostics);
        mapped_ = std::move(result.mesh);
        report_["blocks"] = blocks_->cell_count();
        report_quality(hex::summarize(*mapped_, line_.context()));
        hex::io::write_hex_mesh(folder_ / "3-map.vtk", *mapped_);
    }

    void improve() {
        hex::HexMesh mesh = mapped_ ? std::move(*mapped_) : load_hexahedra(line_, folder_ / "3-map.vtk");
        Json steps = Json::array();
        for (const auto& method : split_list(line_.get<std::string>("improve"))) {
            hex::ImproveOptions options;
            options.method = method;
            options.features = hex::FeatureSource::angle;
            options.feature_cosine = line_.get<double>("sharp-cosine");
            options.surface = &patches();
            auto result = hex::improve(mesh, options, line_.context());
            line_.log(result.report.diagnostics);
            steps.push_back({{"method", method},
                             {"min_scaled_jacobian", {result.report.before.min, result.report.after.min}},
                             {"inverted", {result.report.before.inverted, result.report.after.inverted}}});
            mesh = std::move(result.mesh);
        }
        const auto summary = hex::summarize(mesh, line_.context());
        report_["improve"] = steps;
        report_quality(summary);
        hex::io::write_hex_mesh(folder_ / "4-improve.vtk", mesh);
        improved_ = std::move(mesh);
        if (summary.inverted > 0)
            throw hex::Error(
                hex::ErrorKind::no_result,
                std::to_string(summary.inverted) + " elements of the improved mesh are still inverted",
                (folder_ / "4-improve.vtk").string(), "mend the blocks, or try other --improve methods");
    }

    void spline() {
        if (!improved_) improved_ = load_hexahedra(line_, folder_ / "4-improve.vtk");
        ::spline::SplineOptions options;
        options.features = hex::FeatureSource::angle;
        options.feature_cosine = line_.get<double>("sharp-cosine");
        const auto result = ::spline::build(*improved_, options, line_.context());
        line_.log(result.report.diagnostics);
        report_["control_points"] = result.spline.control_points.size();
        report_["bezier_elements"] = result.report.summary.elements;
        ::spline::io::write_bext(folder_ / "5-spline.bext", result.spline);
        ::spline::io::write_bezier_vtu(folder_ / "5-spline.vtu", result.spline);
    }

    /// The surface with four-sided patches: made by this run, given, or of an earlier run.
    const hex::TriangleMesh& patches() {
        if (!patches_)
            patches_ = load_triangles(
                line_, std::filesystem::exists(folder_ / "2-patches.k") || !line_.given("segmentation")
                           ? folder_ / "2-patches.k"
                           : std::filesystem::path(line_.get<std::string>("segmentation")));
        return *patches_;
    }

    void report_quality(const hex::QualitySummary& summary) {
        report_["hexes"] = summary.cells;
        report_["min_scaled_jacobian"] = summary.min;
        report_["mean_scaled_jacobian"] = summary.mean;
        report_["inverted"] = summary.inverted;
    }

    const CommandLine& line_;
    std::filesystem::path folder_;
    std::optional<hex::TriangleMesh> labelled_;
    std::optional<hex::TriangleMesh> patches_;
    std::optional<hex::HexMesh> blocks_;
    std::optional<hex::HexMesh> mapped_;
    std::optional<hex::HexMesh> improved_;
    Json report_;
};

void describe(CommandLine& line) {
    line.add_input("triangle surface of the part");
    line.add_output("output folder", true);
    line.add("segmentation", value<std::string>(),
             "the surface cut into four-sided patches (part id = patch)");
    line.add("blocks", value<std::string>(), "hexahedral block structure that fits the patches");
    line.add("from", value<std::string>("STAGE")->default_value("segment"),
             "first stage to run; what comes before is read from the output folder");
    line.add("to", value<std::string>("STAGE")->default_value("spline"), "last stage to run");
    describe_element_size(line);
    line.add("weight,l", value<double>()->default_value(0.1, "0.1"),
             "segment: weight of the boundary-enhanced term; with it the method is hbecvt");
    line.add("improve", value<std::string>("LIST")->default_value("auto"),
             "methods of stage improve, in order, separated by commas; none to leave the mesh as it is");
    line.add("sharp-cosine,t", value<double>()->default_value(0.8, "0.8"),
             "improve, spline: cosine of the angle between normals below which a boundary edge is sharp");
}

const RegisterCommand registered(
    {.name = "run",
     .order = 5,
     .summary = "the whole chain, from the surface to the spline",
     .description = "Writes 1-segment.k, 1-labels.txt, 2-polycube.k, 2-patches.k, 2-blocks.k, 3-map.vtk, "
                    "4-improve.vtk,\n"
                    "5-spline.bext, 5-spline.vtu and report.json into the output folder. Edit any of them "
                    "and go on with\n"
                    "--from.",
     .sample_runs = {"hexspline run rod.stl --segmentation rod_patches.k --blocks rod_blocks.k -o out",
                     "hexspline run rod.stl --from improve -o out"},
     .describe = describe,
     .run = [](CommandLine& line) { return Chain(line).run(); }});

}  // namespace
}  // namespace cli
