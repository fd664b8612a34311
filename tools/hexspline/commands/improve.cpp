/// Sample runs:
///   hexspline improve -i part.vtk --surface part_segment.k -o part_improved.vtk
///   hexspline improve -i rod_hex.vtk -Q -m 1 -n 1 -o rod_hex_pillow.vtk
///   hexspline improve -i rod_hex_pillow.vtk -Q -m 2 -p 0.001 -n 50 -s 2 -o rod_hex_pillow_smooth.vtk
///   hexspline improve -i part.vtk -m smooth -s 1 -t 0.8 --surface part_segment.k -o part_smooth.vtk

#include "hexspline/command.h"
#include "hexspline/console.h"
#include "hexspline/inputs.h"

#include <hex/base/error.h>
#include <hex/improve/improve.h>
#include <hex/io/hex_file.h>
#include <hex/io/list_file.h>
#include <hex/io/output_file.h>

#include <array>
#include <optional>
#include <utility>

namespace cli {
namespace {

void describe(CommandLine& line) {
    line.add_input("hexahedral mesh");
    line.add_output("improved mesh");
    line.add_switch("Quality,Q", "accepted and without effect, as in the paper's command lines");
    line.add("method,m", value<std::string>("NAME")->default_value("auto"),
             "laplace, pillow, smooth, optimize (or 0, 1, 2, 3 as in the paper), untangle, auto, snap, or a "
             "plug-in's");
    line.add("count,n", value<int>(), "layers of pillow (1), sweeps of the others (50)");
    line.add_switch("local",
                    "pillow: the layer only around elements that have two boundary faces on one smooth part");
    line.add("step,p", value<double>(),
             "step in (0, 1]: share of the move that is made; optimize: the first step (0.01; laplace: 1)");
    line.add("sharp,s", value<int>("0|1|2")->default_value(0),
             "sharp features: none, by angle, or from the sharp file");
    line.add(
        "tolerance,t", value<double>()->default_value(0.8, "0.8"),
        "cosine of the angle between normals below which an edge is sharp, for -s 1, --surface and --local");
    line.add("sharp-file", value<std::string>(),
             "for -s 2: its last integer of each line is a vertex (default sharp.txt beside the input)");
    line.add("surface", value<std::string>(), "closed surface on which boundary vertices are kept");
    line.add(
        "max-deviation", value<double>("PCT"),
        "untangle, auto: how far boundary vertices may leave the surface, in percent of its diagonal (0.01 "
        "with --surface, else 1)");
    line.add("target-sj", value<double>()->default_value(1.0),
             "untangle, auto: stop when the smallest scaled Jacobian has reached this");
    line.add("time-limit", value<double>("SECONDS")->default_value(0.0, "none"),
             "untangle, auto: end soon after so many seconds, with the best mesh found until then");
    line.add("features", value<std::string>("angle|patches|FILE")->default_value("angle"),
             "untangle, auto: sharp edges of the surface (of the input without --surface): by -t, between "
             "parts of "
             "--surface, or listed in a file, two vertices a line, counted from 0");
    line.add_output_file("features-out",
                         "untangle, auto: write the sharp edges that were used, for --features");
}

/// The paper's numbers of the methods, and names.
std::string method_of(const std::string& text) {
    constexpr std::array<const char*, 4> numbered = {"laplace", "pillow", "smooth", "optimize"};
    if (text.size() == 1 && text[0] >= '0' && text[0] <= '3')
        return numbered[static_cast<std::size_t>(text[0] - '0')];
    return text;
}

hex::ImproveOptions options_of(const CommandLine& line) {
    hex::ImproveOptions options;
    options.method = method_of(line.get<std::string>("method"));
    if (line.given("count")) {
        options.count = line.get<int>("count");
        line.require_range("count", options.count, 0, 1e9);
    }
    if (line.given("step")) {
        options.step = line.get<double>("step");
        line.require_range("step", options.step, 1e-12, 1.0);
    }
    options.local_layer = line.is_set("local");
    options.feature_cosine = line.get<double>("tolerance");
    line.require_range("tolerance", options.feature_cosine, -1.0, 1.0);
    const int sharp = line.get<int>("sharp");
    line.require_range("sharp", sharp, 0, 2);
    if (sharp == 1) options.features = hex::FeatureSource::angle;
    if (sharp == 2) options.features = hex::FeatureSource::list;
    if (line.given("max-deviation")) {
        options.max_deviation = line.get<double>("max-deviation");
        line.require_range("max-deviation", options.max_deviation, 0.0, 100.0);
    }
    options.target = line.get<double>("target-sj");
    line.require_range("target-sj", options.target, 1e-12, 1.0);
    options.time_limit = line.get<double>("time-limit");
    line.require_range("time-limit", options.time_limit, 0.0, 1e9);
    return options;
}

std::filesystem::path sharp_file(const CommandLine& line) {
    if (line.given("sharp-file")) return line.get<std::string>("sharp-file");
    return line.input().parent_path() / "sharp.txt";
}

using EdgeList = std::vector<std::array<std::int64_t, 2>>;

/// The edges between triangles of different parts.
EdgeList patch_borders(const hex::TriangleMesh& mesh) {
    EdgeList edges;
    for (const auto e : mesh.edges()) {
        const auto h = mesh.halfedge_handle(e, 0);
        const auto f = mesh.face_handle(h);
        const auto g = mesh.face_handle(mesh.opposite_halfedge_handle(h));
        if (!f.is_valid() || !g.is_valid() || mesh.data(f).part == mesh.data(g).part) continue;
        edges.push_back({mesh.from_vertex_handle(h).idx(), mesh.to_vertex_handle(h).idx()});
    }
    return edges;
}

/// A file that lists no edge would otherwise be taken for none at all.
EdgeList read_edges(const std::filesystem::path& file) {
    EdgeList edges = hex::io::read_edge_list(file);
    if (edges.empty()) throw hex::Error(hex::ErrorKind::bad_input, "lists no edge", file.string());
    return edges;
}

void write_edges(const std::filesystem::path& file, const EdgeList& edges) {
    std::string text;
    for (const auto& edge : edges) {
        text += std::to_string(edge[0]);
        text += ' ';
        text += std::to_string(edge[1]);
        text += '\n';
    }
    hex::io::write_file(file, text);
}

Json quality_json(const hex::QualitySummary& summary) {
    return {{"vertices", summary.vertices},
            {"hexes", summary.cells},
            {"min_scaled_jacobian", summary.min},
            {"mean_scaled_jacobian", summary.mean},
            {"inverted", summary.inverted}};
}

Json report_of(const hex::ImproveReport& report) {
    Json history = Json::array();
    for (const auto& record : report.history) {
        Json entry = {{"sweep", record.sweep},
                      {"moved", record.moved},
                      {"min_scaled_jacobian", record.min},
                      {"mean_scaled_jacobian", record.mean},
                      {"inverted", record.inverted}};
        if (!record.step.empty()) {
            entry["step"] = record.step;
            entry["surface_distance_percent"] = record.distance;
        }
        history.push_back(entry);
    }
    Json json = {{"method", report.method},
                 {"before", quality_json(report.before)},
                 {"after", quality_json(report.after)},
                 {"sharp_edges", report.sharp_edges},
                 {"history", history},
                 {"diagnostics", to_json(report.diagnostics)}};
    const auto add_fidelity = [&](const char* name, const std::optional<hex::ImproveFidelity>& fidelity) {
        if (fidelity)
            json["fidelity"][name] = {{"distance_percent", fidelity->distance},
                                      {"sharp_edges_percent", fidelity->features}};
    };
    add_fidelity("before", report.fidelity_before);
    add_fidelity("after", report.fidelity_after);
    add_fidelity("limit", report.fidelity_limit);
    for (const auto& [step, seconds] : report.seconds) json["seconds"][step] = seconds;
    return json;
}

void tell(const CommandLine& line, const hex::ImproveReport& report) {
    const auto text = [](const hex::QualitySummary& summary) {
        return std::to_string(summary.cells) + " hexes, scaled Jacobian min " + std::to_string(summary.min) +
               " mean " + std::to_string(summary.mean) + ", " + std::to_string(summary.inverted) +
               " inverted";
    };
    line.info("before: " + text(report.before));
    line.info("after " + std::to_string(report.history.size()) + " sweeps or layers of " + report.method +
              ": " + text(report.after));
    line.log(report.diagnostics);
}

int run(CommandLine& line) {
    hex::ImproveOptions options = options_of(line);
    if (!hex::improvers().contains(options.method)) (void)hex::improvers().make(options.method);  // throws
    const hex::HexMesh mesh = load_hexahedra(line, line.input());
    if (options.features == hex::FeatureSource::list)
        options.feature_vertices = hex::io::read_sharp_vertices(sharp_file(line));
    std::optional<hex::TriangleMesh> surface;
    if (line.given("surface")) {
        surface = load_triangles(line, line.get<std::string>("surface"));
        options.surface = &*surface;
    }
    const std::string features = line.get<std::string>("features");
    if (features == "patches") {
        if (!surface)
            throw hex::Error(hex::ErrorKind::usage, "--features patches without a surface", {},
                             "give the surface with its parts as --surface");
        options.feature_edges = patch_borders(*surface);
    } else if (features != "angle") {
        options.feature_edges = read_edges(features);
    }
    const hex::ImproveResult result = [&] {
        try {
            // Interrupted, these end with the best mesh found until then; the others with nothing.
            hex::Context context = line.context();
            if (options.method == "untangle" || options.method == "auto")
                options.finish = std::exchange(context.stop, std::stop_token());
            return hex::improve(mesh, options, context);
        } catch (const hex::Error& error) {
            // What is wrong with a valid mesh's input is the list of sharp vertices.
            if (error.kind() != hex::ErrorKind::bad_input) throw;
            const bool list = options.features == hex::FeatureSource::list;
            if (!options.feature_edges.empty() && features != "patches") throw error.located(features);
            throw error.located((list ? sharp_file(line) : line.input()).string());
        }
    }();
    if (options.finish.stop_possible()) take_time_after_interrupt();
    hex::io::write_hex_mesh(line.output(), result.mesh);
    if (line.given("features-out"))
        write_edges(line.get<std::string>("features-out"), result.report.feature_edges);
    tell(line, result.report);
    line.write_report(report_of(result.report));
    if (!options.finish.stop_requested()) return 0;
    line.warn("interrupted: the best mesh found until then was written");
    return hex::exit_code(hex::ErrorKind::cancelled);
}

const RegisterCommand registered(
    {.name = "improve",
     .order = 40,
     .summary = "make a hexahedral mesh better: untangle it, raise its smallest scaled Jacobian",
     .description = "The result is never worse than the input in inverted elements and smallest scaled "
                    "Jacobian, and its\n"
                    "boundary stays as close to the surface as it was.",
     .sample_runs = {"hexspline improve -i part.vtk --surface part_segment.k -o part_improved.vtk",
                     "hexspline improve -i rod_hex.vtk -Q -m 1 -n 1 -o rod_hex_pillow.vtk",
                     "hexspline improve -i rod_hex_pillow.vtk -Q -m 2 -p 0.001 -n 50 -s 2 -o "
                     "rod_hex_pillow_smooth.vtk",
                     "hexspline improve -i part.vtk -m smooth -s 1 -t 0.8 --surface part_segment.k -o "
                     "part_smooth.vtk"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
