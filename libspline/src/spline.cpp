#include "fit_regions.h"
#include "spline_result.h"

#include <hex/base/error.h>
#include <hex/base/method_call.h>
#include <hex/base/parallel.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/volume/topology.h>
#include <spline/spline.h>

#include <algorithm>

namespace spline {

using hex::Error;
using hex::ErrorKind;

hex::Registry<SplineBuilder>& spline_builders() {
    static hex::Registry<SplineBuilder> registry("spline");
    return registry;
}

namespace {

void check_options(const SplineOptions& options) {
    if (options.global_refinements < 0)
        throw Error(ErrorKind::usage, "the number of global refinements must not be negative");
    if (options.levels && *options.levels < 0)
        throw Error(ErrorKind::usage, "the number of levels must not be negative");
    if (!(options.feature_cosine >= -1.0 && options.feature_cosine <= 1.0))
        throw Error(ErrorKind::usage, "the cosine that makes an edge sharp must be in [-1, 1]");
}

/// Diagnostic or error for elements with a scaled Jacobian <= 0.
void check_inverted(const hex::HexMesh& mesh, bool force, const hex::Context& context,
                    hex::Diagnostics& diagnostics) {
    const std::vector<double> quality = hex::scaled_jacobians(mesh, context);
    std::vector<std::int64_t> inverted;
    for (std::size_t c = 0; c < quality.size(); ++c) {
        if (!(quality[c] > 0.0)) inverted.push_back(static_cast<std::int64_t>(c));
    }
    if (inverted.empty()) return;
    const std::string message =
        std::to_string(inverted.size()) + " inverted elements: " + hex::list_ids(inverted);
    if (!force)
        throw Error(ErrorKind::bad_input, message, {},
                    "improve the mesh first (hexspline improve), or go on with --force");
    diagnostics.push_back({hex::Severity::warning, "inverted-elements", message, "cell", inverted});
}

/// Diagnostic or error for elements around vertices and edges where elements only touch.
void check_manifold(const hex::HexMesh& mesh, bool force, hex::Diagnostics& diagnostics) {
    std::vector<std::int64_t> touching;
    std::string places;
    std::string edge_list;
    for (const hex::Diagnostic& finding : hex::inspect(mesh)) {
        const bool vertices = finding.code == "non-manifold-vertices";
        if (!vertices && finding.code != "non-manifold-edges") continue;
        const hex::EdgeTable edges = vertices ? hex::EdgeTable() : hex::edge_table(mesh);
        const auto cells = vertices ? hex::vertex_cells(mesh) : edges.cells;
        for (const std::int64_t id : finding.ids) {
            for (const hex::CellId c : cells[static_cast<std::size_t>(id)]) touching.push_back(c.value());
            if (vertices) continue;
            // Enough to find them; the elements are all named.
            constexpr std::size_t longest = 80;
            if (edge_list.size() >= longest) continue;
            const auto& [a, b] = edges.vertices[static_cast<std::size_t>(id)];
            edge_list.append(edge_list.empty() ? "" : ", ").append(std::to_string(a.value())).append("-");
            edge_list.append(std::to_string(b.value()));
            if (edge_list.size() >= longest) edge_list.append(", ...");
        }
        if (vertices) places = "at vertices " + hex::list_ids(finding.ids);
    }
    if (!edge_list.empty()) places = "along edges " + edge_list;
    if (touching.empty()) return;
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
    std::string message = std::to_string(touching.size());
    message.append(" elements only touch others ").append(places);
    message.append(", not through faces: ").append(hex::list_ids(touching));
    if (!force)
        throw Error(
            ErrorKind::bad_input, message, {},
            "separate or join them; --force goes on, but the spline is one there that folds or hinges");
    diagnostics.push_back({hex::Severity::warning, "non-manifold", message, "cell", touching});
}

/// The mesh without the vertices that no cell uses, and where each vertex went (-1: dropped).
struct Compacted {
    hex::HexMesh mesh;
    std::vector<std::int64_t> new_vertex;
    std::vector<std::int64_t> dropped;
};

Compacted drop_unused_vertices(const hex::HexMesh& mesh) {
    Compacted compacted;
    compacted.new_vertex.assign(mesh.vertex_count(), -1);
    for (const hex::HexCell& cell : mesh.cell_array()) {
        for (const hex::VertexId v : cell) compacted.new_vertex[v.index()] = 0;
    }
    std::vector<hex::Vec3> positions;
    for (const hex::VertexId v : mesh.vertices()) {
        std::int64_t& entry = compacted.new_vertex[v.index()];
        if (entry < 0) {
            compacted.dropped.push_back(v.value());
            continue;
        }
        entry = static_cast<std::int64_t>(positions.size());
        positions.push_back(mesh.position(v));
    }
    if (compacted.dropped.empty()) return compacted;
    std::vector<hex::HexCell> cells(mesh.cell_array().begin(), mesh.cell_array().end());
    for (hex::HexCell& cell : cells) {
        for (hex::VertexId& v : cell)
            v = hex::VertexId(static_cast<std::size_t>(compacted.new_vertex[v.index()]));
    }
    compacted.mesh = {std::move(positions), std::move(cells), {mesh.parts().begin(), mesh.parts().end()}};
    return compacted;
}

/// Feature edges likewise.
std::vector<std::array<std::int64_t, 2>> map_feature_edges(const SplineOptions& options,
                                                           const std::vector<std::int64_t>& new_vertex) {
    std::vector<std::array<std::int64_t, 2>> mapped;
    for (const auto& edge : options.feature_edges) {
        std::array<std::int64_t, 2> ends = {-1, -1};
        for (std::size_t i = 0; i < 2; ++i) {
            if (edge[i] >= 0 && edge[i] < static_cast<std::int64_t>(new_vertex.size()))
                ends[i] = new_vertex[static_cast<std::size_t>(edge[i])];
            if (ends[i] < 0)
                throw Error(ErrorKind::bad_input,
                            "vertex " + std::to_string(edge[i]) + " of a sharp edge does not exist");
        }
        mapped.push_back(ends);
    }
    return mapped;
}

/// Feature vertices of the input as vertices of the compacted mesh; unused ones go, as all inner ones would.
std::vector<std::int64_t> map_feature_vertices(const SplineOptions& options,
                                               const std::vector<std::int64_t>& new_vertex) {
    std::vector<std::int64_t> mapped, wrong;
    for (const std::int64_t v : options.feature_vertices) {
        if (v < 0 || v >= static_cast<std::int64_t>(new_vertex.size()))
            wrong.push_back(v);
        else if (new_vertex[static_cast<std::size_t>(v)] >= 0)
            mapped.push_back(new_vertex[static_cast<std::size_t>(v)]);
    }
    if (!wrong.empty())
        throw Error(ErrorKind::bad_input, "sharp vertices that do not exist: " + hex::list_ids(wrong),
                    options.feature_origin,
                    "ids are 0-based; the mesh has " + std::to_string(new_vertex.size()) + " vertices");
    return mapped;
}

}  // namespace

SplineResult build(const hex::HexMesh& mesh, const SplineOptions& options, const hex::Context& context) {
    check_options(options);
    const hex::MethodCall<SplineBuilder> method(spline_builders(), options.method);
    if (mesh.empty()) throw Error(ErrorKind::bad_input, "the mesh has no hexahedra");
    return hex::with_threads(context, [&] {
        hex::Diagnostics diagnostics;
        check_inverted(mesh, options.force, context, diagnostics);
        check_manifold(mesh, options.force, diagnostics);
        const Compacted compacted = drop_unused_vertices(mesh);
        SplineOptions used = options;
        used.feature_vertices = map_feature_vertices(options, compacted.new_vertex);
        used.feature_edges = map_feature_edges(options, compacted.new_vertex);
        if (options.levels && static_cast<std::size_t>(*options.levels) < used.refinement.size())
            used.refinement.resize(static_cast<std::size_t>(*options.levels));
        if (!compacted.dropped.empty())
            diagnostics.push_back(
                {hex::Severity::note, "unused-vertices",
                 "dropped vertices that no element uses: " + hex::list_ids(compacted.dropped), "vertex",
                 compacted.dropped});

        const hex::HexMesh& control = compacted.dropped.empty() ? mesh : compacted.mesh;
        const auto build_with = [&](const SplineOptions& asked) {
            SplineResult made =
                method([&](const SplineBuilder& builder) { return builder.build(control, asked, context); });
            method.require("spline", [&] { require_spline(made); });
            return made;
        };
        list_fit_regions(build_with, used);
        SplineResult result = build_with(used);
        result.report.method = options.method;
        result.report.input_vertices = mesh.vertex_count();
        result.report.input_elements = mesh.cell_count();
        result.report.summary = summarize(result.spline);
        result.report.diagnostics.insert(result.report.diagnostics.begin(), diagnostics.begin(),
                                         diagnostics.end());
        return result;
    });
}

void update_control_meshes(SplineResult& result) {
    for (ControlMesh& level : result.levels) {
        for (std::size_t v = 0; v < level.function.size(); ++v) {
            if (level.function_active[v] != 0)
                level.mesh.set_position(hex::VertexId(v), result.spline.control_points[level.function[v]]);
        }
    }
}

}  // namespace spline
