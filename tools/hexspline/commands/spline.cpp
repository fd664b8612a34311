/// Sample runs:
///   hexspline spline -i rod_hex.vtk -S -s 2 -l -o rod_hex.BEXT
///   hexspline spline -i rod_hex.vtk -S -s 2 -l 2
///   hexspline spline -i rod_hex.vtk -o rod_hex -S -s 2 -g 1

#include "hexspline/command.h"
#include "hexspline/inputs.h"
#include "hexspline/spline_file.h"

#include <hex/base/error.h>
#include <hex/io/list_file.h>
#include <hex/io/mesh_file.h>
#include <hex/io/surface_file.h>
#include <spline/fit.h>
#include <spline/io/control_mesh_file.h>
#include <spline/io/deck.h>
#include <spline/jacobian.h>
#include <spline/repair.h>
#include <spline/spline.h>
#include <spline/surface_features.h>

#include <algorithm>
#include <array>
#include <optional>

namespace cli {
namespace {

/// Value of -l without a number.
constexpr int all_levels = -1;

/// --format, else the extension of the output; what is no extension of ours means BEXT.
SplineFormat output_format(const CommandLine& line) {
    if (line.given("format")) return spline_format_named(line.get<std::string>("format"));
    if (!line.given("output")) return SplineFormat::bext;
    if (const auto format = spline_format_of(line.output())) return *format;
    const std::string extension = hex::io::extension_of(line.output());
    if (hex::io::find_format(line.output()) != nullptr)
        throw hex::Error(hex::ErrorKind::usage, "a spline cannot be written as " + extension,
                         line.output().string(), "use .BEXT, .bxt, .vtu or .json, or say --format");
    return SplineFormat::bext;
}

/// The output that was named, or one beside the input: rod_hex.vtk gives rod_hex_BEXT.txt, as the paper has
/// it.
std::filesystem::path output_path(const CommandLine& line, SplineFormat format) {
    if (line.given("output")) return line.output();
    std::filesystem::path path = line.input();
    constexpr std::array endings = {"_BEXT.txt", "_BEXT2.bxt", "_spline.vtu", "_spline.json"};
    path.replace_filename(path.stem().string() + endings[static_cast<std::size_t>(format)]);
    return path;
}

/// A file named by an option, else one of that name beside the input.
std::filesystem::path beside_input(const CommandLine& line, const std::string& option, const char* name) {
    if (line.given(option)) return line.get<std::string>(option);
    std::filesystem::path path = line.input();
    return path.replace_filename(name);
}

/// The part, when --surface is given.
struct Part {
    std::optional<hex::TriangleMesh> surface;
    std::vector<spline::Segment> sharp_edges;  ///< a CAD model's own, else by -t
};

Part load_part(const CommandLine& line) {
    if (!line.given("surface")) return {};
    const std::filesystem::path path = line.get<std::string>("surface");
    const hex::io::SurfaceFile file = hex::io::read_surface(path);
    Part part;
    part.surface = triangles_of(line, file, path);
    if (file.sharp_edges.empty()) {
        part.sharp_edges = spline::sharp_segments(*part.surface, line.get<double>("tolerance"));
    } else {
        for (const auto& [a, b] : file.sharp_edges)
            part.sharp_edges.push_back({file.soup.points[a], file.soup.points[b]});
    }
    return part;
}

/// What -s asks for.
void add_features(const CommandLine& line, const hex::HexMesh& mesh, const Part& part,
                  spline::SplineOptions& options) {
    switch (line.get<int>("sharp")) {
        case 0:
            break;
        case 1:
            options.features = hex::FeatureSource::angle;
            break;
        case 3:
            options.feature_edges = part.surface ? spline::edges_between_patches(mesh, *part.surface)
                                                 : spline::edges_between_parts(mesh);
            break;
        case 4:
            options.feature_edges = spline::edges_along(mesh, part.sharp_edges);
            break;
        case 2: {
            options.features = hex::FeatureSource::list;
            const auto path = beside_input(line, "sharp-file", "sharp.txt");
            options.feature_vertices = hex::io::read_sharp_vertices(path);
            options.feature_origin = path.string();
            break;
        }
        default:
            throw hex::Error(hex::ErrorKind::usage,
                             "-s must be 0 (none), 1 (by angle), 2 (from file), 3 (patch borders) or 4 "
                             "(sharp edges of --surface)");
    }
}

/// The part's sharp edges, which --fit adds to any that -s asks for; none with -s 0. True when there are any.
bool add_features_to_fit(const CommandLine& line, const hex::HexMesh& mesh, const Part& part,
                         spline::SplineOptions& options) {
    const int sharp = line.given("sharp") ? line.get<int>("sharp") : -1;
    if (!line.is_set("fit") || sharp == 0 || sharp == 4) return false;
    const auto edges = spline::edges_along(mesh, part.sharp_edges);
    options.feature_edges.insert(options.feature_edges.end(), edges.begin(), edges.end());
    return !edges.empty();
}

spline::SplineOptions options_of(const CommandLine& line) {
    spline::SplineOptions options;
    options.method = line.get<std::string>("method");
    options.feature_cosine = line.get<double>("tolerance");
    line.require_range("tolerance", options.feature_cosine, -1.0, 1.0);
    if (line.get<int>("sharp") == 4 && !line.given("surface"))
        throw hex::Error(hex::ErrorKind::usage, "-s 4 needs --surface");
    if (line.is_set("fit") && !line.given("surface"))
        throw hex::Error(hex::ErrorKind::usage, "--fit needs --surface");
    options.global_refinements = line.get<int>("global");
    line.require_range("global", options.global_refinements, 0, 10);
    if (line.given("local")) {
        const auto path = beside_input(line, "refine-file", "lev_rfid.txt");
        options.refinement = hex::io::read_refinement(path);
        options.refinement_origin = path.string();
        const int levels = line.get<int>("local");
        if (levels != all_levels) {
            line.require_range("local", levels, 0, 20);
            options.levels = levels;
        }
    } else if (line.given("refine-file")) {
        throw hex::Error(hex::ErrorKind::usage, "--refine-file has no effect without -l");
    }
    if (line.given("refine")) {
        for (const auto& text : line.get<std::vector<std::string>>("refine"))
            options.regions.push_back(spline::parse_region(text));
    }
    options.closure = !line.is_set("no-closure");
    options.force = line.is_set("force");
    return options;
}

Json to_json(const spline::SplineReport& report) {
    Json valences = Json::object();
    for (const auto& [valence, count] : report.extraordinary_edges) valences[std::to_string(valence)] = count;
    Json levels = Json::array();
    for (const auto& level : report.levels)
        levels.push_back({{"elements", level.elements},
                          {"active_elements", level.active_elements},
                          {"active_functions", level.active_functions},
                          {"refined", level.refined},
                          {"added_by_closure", level.added_by_closure}});
    const auto& summary = report.summary;
    return {
        {"method", report.method},
        {"input_vertices", report.input_vertices},
        {"input_elements", report.input_elements},
        {"control_points", summary.control_points},
        {"elements", summary.elements},
        {"boundary_elements", report.boundary_elements},
        {"irregular_elements", report.irregular_elements},
        {"regular_elements", report.regular_elements},
        {"refinable_elements", report.refinable_elements},
        {"extraordinary_edges", valences},
        {"sharp_edges", report.sharp_edges},
        {"crease_vertices", report.crease_vertices},
        {"corner_vertices", report.corner_vertices},
        {"levels", levels},
        {"functions_per_element",
         {{"min", summary.functions_min}, {"mean", summary.functions_mean}, {"max", summary.functions_max}}},
        {"partition_of_unity_error", summary.partition_of_unity_error},
        {"smallest_coefficient", summary.smallest_coefficient},
        {"diagnostics", cli::to_json(report.diagnostics)}};
}

Json to_json(const spline::JacobianReport& report) {
    Json worst = nullptr;
    if (report.worst >= 0) worst = report.worst;
    Json negative = Json::array();
    for (const std::int64_t e : report.negative) {
        const auto& element = report.elements[static_cast<std::size_t>(e)];
        negative.push_back({{"element", e},
                            {"at", {element.at[0], element.at[1], element.at[2]}},
                            {"value", element.smallest}});
    }
    return {{"elements", report.elements.size()},
            {"proved_positive", report.positive},
            {"of_these_zero_on_an_edge", report.singular},
            {"proved_negative", report.negative.size()},
            {"undecided", report.undecided.size()},
            {"lower_bound", report.lower},
            {"worst", worst},
            {"negative_elements", std::move(negative)},
            {"undecided_elements", report.undecided}};
}

/// Mended unless --no-repair.
spline::RepairReport mend(const CommandLine& line, spline::BezierSpline& spline,
                          spline::JacobianReport& verdict) {
    spline::RepairOptions options;
    options.max_deviation = line.get<double>("max-deviation");
    line.require_range("max-deviation", options.max_deviation, 0.0, 100.0);
    return spline::repair_jacobian(spline, verdict, options, line.context());
}

/// What is known of the Jacobians, mended unless --no-repair, and what that moved.
Json settle_jacobians(const CommandLine& line, spline::SplineResult& result,
                      spline::JacobianReport& verdict) {
    Json report;
    if (!line.is_set("no-repair")) {
        const auto repair = mend(line, result.spline, verdict);
        spline::update_control_meshes(result);
        report = {{"negative_before", repair.negative_before},
                  {"undecided_before", repair.undecided_before},
                  {"mended", repair.mended.size()},
                  {"unmended", repair.unmended},
                  {"moved_inside", repair.moved_inside},
                  {"moved_boundary", repair.moved_boundary},
                  {"largest_move_inside_percent", repair.largest_inside},
                  {"largest_move_boundary_percent", repair.largest_boundary}};
        if (!repair.mended.empty())
            line.info(std::to_string(repair.mended.size()) + " folded elements mended by moving " +
                      std::to_string(repair.moved_inside) + " control points inside and " +
                      std::to_string(repair.moved_boundary) + " of the boundary");
    }
    const std::string place = line.input().string();
    if (!verdict.negative.empty())
        line.warn(place + ": " + std::to_string(verdict.negative.size()) +
                  " elements of the spline have a negative Jacobian: " + spline::describe_negative(verdict));
    if (!verdict.undecided.empty())
        line.warn(place + ": " + std::to_string(verdict.undecided.size()) +
                  " elements of the spline are neither proved positive nor negative: " +
                  hex::list_ids(verdict.undecided));
    if (verdict.singular > 0)
        line.info(place + ": the Jacobian of " + std::to_string(verdict.singular) +
                  " elements is zero on an edge or at a corner of the boundary, where it is smooth with one "
                  "element; make it sharp (-s) where that matters");
    return report;
}

Json to_json(const spline::FitDistance& distance) {
    return {{"to_surface_rms", distance.to_surface_rms},
            {"to_surface_max", distance.to_surface_max},
            {"from_surface_rms", distance.from_surface_rms},
            {"from_surface_max", distance.from_surface_max}};
}

/// With --fit the boundary is moved onto --surface; without, it is only measured.
/// `unfitted`, when given, is the distance of the spline without the features that --fit added.
Json fit_to_surface(const CommandLine& line, const Part& part,
                    const std::optional<spline::FitDistance>& unfitted, spline::SplineResult& result,
                    spline::JacobianReport& verdict) {
    if (!part.surface) return {};
    const hex::TriangleMesh& surface = *part.surface;
    if (!line.is_set("fit"))
        return {{"distance", to_json(spline::fit_distance(result.spline, surface, line.context()))}};
    auto report = spline::fit(result.spline, verdict, surface, {}, line.context());
    report.before = unfitted.value_or(report.before);
    spline::update_control_meshes(result);
    line.info("fitted: root mean square distance of the boundary from the surface " +
              std::to_string(report.before.to_surface_rms) + " -> " +
              std::to_string(report.after.to_surface_rms) + ", largest " +
              std::to_string(report.before.to_surface_max) + " -> " +
              std::to_string(report.after.to_surface_max));
    return {{"before", to_json(report.before)},
            {"after", to_json(report.after)},
            {"moved", report.moved},
            {"largest_move", report.largest_move},
            {"held_back", report.held_back}};
}

/// The deck that --deck asks for, beside the BEXT. Returns its path.
std::string write_deck(const CommandLine& line, const std::filesystem::path& bext, SplineFormat format,
                       const spline::BezierSpline& spline) {
    if (!line.given("deck")) return {};
    spline::io::DeckOptions options;
    const auto kind = line.get<std::string>("deck");
    if (kind == "static")
        options.kind = spline::io::DeckKind::linear_static;
    else if (kind != "eigen")
        throw hex::Error(hex::ErrorKind::usage, "unknown --deck '" + kind + "'", {}, "known: eigen, static");
    if (format != SplineFormat::bext && format != SplineFormat::bext2)
        throw hex::Error(hex::ErrorKind::usage, "--deck needs a BEXT file as output");
    options.bext = bext.filename().string();
    options.bext2 = format == SplineFormat::bext2;
    std::filesystem::path path = bext;
    path.replace_filename(bext.stem().string() + "_" + kind + ".k");
    line.require_no_input(path);
    spline::io::write_deck(path, spline, options);
    return path.string();
}

int run(CommandLine& line) {
    const SplineFormat format = output_format(line);
    const auto path = output_path(line, format);
    spline::SplineOptions options = options_of(line);
    const hex::HexMesh mesh = load_hexahedra(line, line.input());
    const Part part = load_part(line);
    add_features(line, mesh, part, options);
    if (part.surface)
        options.fit_errors = [&](const spline::BezierSpline& unrefined) {
            return spline::fit_errors(unrefined, *part.surface, line.context());
        };
    const spline::SplineOptions without_fit = options;
    const bool more_features = add_features_to_fit(line, mesh, part, options);
    // Judged as the spline would be without this refinement.
    if (line.is_set("fit"))
        options.fit_errors = [&](const spline::BezierSpline& unrefined) {
            spline::BezierSpline fitted = unrefined;
            spline::JacobianReport verdict = spline::certify(fitted, {}, line.context());
            if (!line.is_set("no-repair")) mend(line, fitted, verdict);
            spline::fit(fitted, verdict, *part.surface, {}, line.context());
            return spline::fit_errors(fitted, *part.surface, line.context());
        };
    spline::SplineResult result;
    std::optional<spline::FitDistance> unfitted;
    try {
        if (more_features)
            unfitted = spline::fit_distance(spline::build(mesh, without_fit, line.context()).spline,
                                            *part.surface, line.context());
        result = spline::build(mesh, options, line.context());
    } catch (const hex::Error& error) {
        throw error.located(line.input().string());
    }
    line.log(result.report.diagnostics, line.input().string());
    spline::JacobianReport verdict = spline::certify(result.spline, {}, line.context());
    const Json repair = settle_jacobians(line, result, verdict);
    const Json fit = fit_to_surface(line, part, unfitted, result, verdict);

    line.require_no_input(path);
    write_spline(path, format, result.spline, line.context());
    const std::string deck = write_deck(line, path, format, result.spline);
    line.info(path.string() + ": " + std::to_string(result.spline.function_count()) + " control points, " +
              std::to_string(result.spline.element_count()) + " elements");
    Json report = to_json(result.report);
    report["jacobian"] = to_json(verdict);
    if (!repair.is_null()) report["repair"] = repair;
    if (!fit.is_null()) report["fit"] = fit;
    report["output"] = path.string();
    if (!deck.empty()) report["deck"] = deck;
    if (line.given("control-mesh")) {
        const auto prefix = line.get<std::string>("control-mesh");
        for (std::size_t level = 0; level < result.levels.size(); ++level)
            line.require_no_input(spline::io::control_mesh_path(prefix, level));
        Json files = Json::array();
        for (const auto& file : spline::io::write_control_meshes(prefix, result.levels))
            files.push_back(file.string());
        report["control_meshes"] = std::move(files);
    }
    line.write_report(report);
    return 0;
}

void describe(CommandLine& line) {
    line.add_input("hexahedral mesh");
    line.add_output(
        "spline: .vtu, .json, .bxt (BEXT 2.0), else BEXT 1; default: INPUT_BEXT.txt beside the input", false);
    line.add_switch("spline,S", "accepted, as the paper writes it");
    line.add(
        "sharp,s", value<int>("0|1|2|3|4")->default_value(0),
        "sharp features: none, by angle, from --sharp-file, borders of the patches of --surface (without "
        "it: of the mesh's parts), sharp edges of --surface (with --fit these are the default, and join "
        "those of 1 to 3)");
    line.add("tolerance,t", value<double>("COS")->default_value(0.8, "0.8"),
             "cosine of the angle between normals below which an edge is sharp");
    line.add("sharp-file", value<std::string>(),
             "vertices of sharp features (default: sharp.txt beside the input)");
    line.add("global,g", value<int>()->default_value(0), "refine all elements so many times, before -l");
    line.add_optional_integer("local,l", all_levels,
                              "refine locally: all levels of --refine-file, or so many");
    line.add("refine-file", value<std::string>(),
             "lines 'level element' (default: lev_rfid.txt beside the input)");
    line.add(
        "refine", boost::program_options::value<std::vector<std::string>>()->composing()->value_name("WHERE"),
        "refine box:x0,y0,z0,x1,y1,z1[:level], sphere:x,y,z,radius[:level], near:FILE[:level] (points or "
        "patch numbers), worst:N%[:level] (least quality) or worst-fit:N%[:level] (farthest from --surface); "
        "may be repeated");
    line.add_switch("no-closure",
                    "refine exactly what is listed, though the spline may not be continuous then");
    line.add("format", value<std::string>("bext|bext2|vtu|json"),
             "format of the output, whatever its extension");
    line.add("deck", value<std::string>("eigen|static"),
             "also write an LS-DYNA deck beside the BEXT, with a node set for each boundary patch");
    line.add("control-mesh", value<std::string>("PREFIX"),
             "also write PREFIX_hmesh<level>_CM.vtk of every level");
    line.add("surface", value<std::string>(), "closed surface of the part; its distance is in the report");
    line.add_switch("fit", "move control points so that the spline's boundary lies on --surface");
    line.add_switch("repair-jacobian", "move control points until no element folds; this is the default");
    line.add_switch("no-repair", "leave elements that fold as they are");
    line.add("max-deviation", value<double>("PCT")->default_value(1.0, "1"),
             "how far mending may move control points of the boundary, in percent of the diagonal");
    line.add_switch("force", "go on with inverted elements, and with elements that only touch others");
    line.add("method", value<std::string>("NAME")->default_value("thspline3d"), "see hexspline plugins");
}

const RegisterCommand registered(
    {.name = "spline",
     .order = 50,
     .summary = "build a truncated hierarchical spline and its Bezier extraction",
     .sample_runs = {"hexspline spline -i rod_hex.vtk -S -s 2 -l -o rod_hex.BEXT",
                     "hexspline spline -i rod_hex.vtk -S -s 2 -l 2",
                     "hexspline spline -i rod_hex.vtk -o rod_hex -S -s 2 -g 1"},
     .describe = describe,
     .run = run});

}  // namespace
}  // namespace cli
