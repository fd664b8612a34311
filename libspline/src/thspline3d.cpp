#include "spline_rows.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <spline/blending.h>
#include <spline/hierarchy.h>
#include <spline/spline.h>
#include <spline/subdivision.h>

#include <algorithm>
#include <memory>
#include <unordered_set>

namespace spline {

using hex::CellId;
using hex::VertexFeature;
using hex::VertexId;

namespace {

hex::FeatureSet find_features(const hex::HexMesh& mesh, const hex::EdgeTable& edges,
                              const hex::BoundaryQuads& boundary, const SplineOptions& options) {
    switch (options.features) {
        case hex::FeatureSource::angle:
            return hex::features_by_angle(mesh, edges, boundary, options.feature_cosine);
        case hex::FeatureSource::list:
            return hex::features_from_vertices(mesh, edges, boundary, options.feature_vertices);
        case hex::FeatureSource::none:
            break;
    }
    return hex::no_features(mesh, edges, boundary);
}

/// With the edges that are sharp besides.
hex::FeatureSet with_feature_edges(hex::FeatureSet features, const hex::EdgeTable& edges,
                                   const hex::BoundaryQuads& boundary, const SplineOptions& options) {
    if (options.feature_edges.empty()) return features;
    for (const auto& [a, b] : options.feature_edges) {
        const hex::EdgeId e =
            edges.find(VertexId(static_cast<std::size_t>(a)), VertexId(static_cast<std::size_t>(b)));
        if (!e.valid() || edges.boundary[e.index()] == 0)
            throw hex::Error(hex::ErrorKind::bad_input, "no edge of the boundary joins vertices " +
                                                            std::to_string(a) + " and " + std::to_string(b));
        features.sharp_edge[e.index()] = 1;
    }
    return hex::classify(edges, boundary, std::move(features.sharp_edge));
}

LevelMesh input_level(const hex::HexMesh& mesh, const SplineOptions& options) {
    hex::EdgeTable edges = hex::edge_table(mesh);
    hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    hex::FeatureSet features =
        with_feature_edges(find_features(mesh, edges, boundary, options), edges, boundary, options);
    return coarsest_level(mesh, std::move(edges), std::move(boundary), std::move(features));
}

/// The lists, completed level by level with what the regions ask for: a level's elements must be there before
/// they can be chosen.
Hierarchy refine(LevelMesh coarsest, const SplineOptions& options, const hex::Context& context) {
    try {
        int deepest = 0;
        for (const RefineRegion& region : options.regions) {
            require_patches(region, coarsest);
            deepest = std::max(deepest, region.level);
        }
        if (deepest == 0)
            return build_hierarchy(std::move(coarsest), options.refinement, options.closure, context);
        auto lists = options.refinement;
        lists.resize(std::max(lists.size(), static_cast<std::size_t>(deepest)));
        for (std::size_t l = 0; l < static_cast<std::size_t>(deepest); ++l) {
            const std::vector<std::vector<std::int64_t>> below(
                lists.begin(), lists.begin() + static_cast<std::ptrdiff_t>(l));
            const Hierarchy so_far = build_hierarchy(coarsest, below, options.closure, context);
            if (so_far.levels.size() <= l) break;
            // Elements that closure added below may be asked for, too; their ids are those of a list that
            // names them.
            for (std::size_t k = 0; k < l; ++k) {
                lists[k].clear();
                for (const CellId c : so_far.levels[k].refined) lists[k].push_back(c.value());
            }
            std::unordered_set<std::int64_t> listed(lists[l].begin(), lists[l].end());
            for (const RefineRegion& region : options.regions) {
                if (region.level <= static_cast<int>(l)) continue;
                for (const std::int64_t e :
                     elements_in(region, so_far.levels[l].control, so_far.levels[l].domain_cells)) {
                    if (listed.insert(e).second) lists[l].push_back(e);
                }
            }
        }
        return build_hierarchy(std::move(coarsest), lists, options.closure, context);
    } catch (const hex::Error& error) {
        throw options.refinement_origin.empty() ? error : error.located(options.refinement_origin);
    }
}

void describe(const LevelMesh& level, SplineReport& report) {
    for (const ElementClass c : classify_elements(level)) {
        report.boundary_elements += c == ElementClass::boundary;
        report.irregular_elements += c == ElementClass::irregular;
        report.regular_elements += c == ElementClass::regular;
    }
    report.extraordinary_edges = extraordinary_edges(level);
    report.sharp_edges = level.features.sharp_edge_count();
    for (const VertexFeature f : level.features.vertex) {
        report.crease_vertices += f == VertexFeature::crease;
        report.corner_vertices += f == VertexFeature::corner;
    }
    const std::vector<char> regular = regular_vertices(level);
    for (const hex::HexCell& cell : level.mesh.cell_array())
        report.refinable_elements +=
            std::all_of(cell.begin(), cell.end(), [&](VertexId v) { return regular[v.index()] != 0; });
}

/// Below this a coefficient is left out. What goes is given to the largest coefficient of its Bezier point,
/// so that the functions still sum to 1.
constexpr double negligible = 1e-15;

void drop_negligible(std::span<const RealRowSum::Term> terms, RealRowSum& kept) {
    double dropped = 0.0;
    std::size_t largest = 0;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        if (terms[i].value > terms[largest].value) largest = i;
        if (terms[i].value < negligible) dropped += terms[i].value;
    }
    for (std::size_t i = 0; i < terms.size(); ++i) {
        if (terms[i].value >= negligible)
            kept.add(terms[i].column, i == largest ? terms[i].value + dropped : terms[i].value);
    }
}

/// Adds the active elements of a level: their Bezier points, each once, with the rows of M T.
void extract(const HierarchyLevel& level, std::size_t number, const SparseRows* truncation,
             BezierSpline& spline) {
    const BlendingOperator blending(level.control);
    const std::size_t first_element = spline.elements.size();
    std::vector<CellId> cells;
    for (std::size_t c = 0; c < level.element_active.size(); ++c) {
        if (level.element_active[c] != 0) cells.push_back(CellId(c));
    }
    spline.elements.resize(first_element + cells.size());
    spline.element_level.resize(spline.elements.size(), static_cast<std::uint16_t>(number));
    hex::parallel_for(cells.size(), [&](std::size_t i) {
        spline.elements[first_element + i] = blending.element_points(cells[i]);
    });
    for (const CellId c : cells) {
        spline.element_cell.push_back(c.value());
        std::array<std::int32_t, 6> patches;
        for (int f = 0; f < 6; ++f) {
            const hex::QuadId q =
                level.control.boundary.quad_of_half_face[hex::HexMesh::half_face(c, f).index()];
            patches[static_cast<std::size_t>(f)] = q.valid() ? level.control.patch_of_quad[q.index()] : -1;
        }
        spline.boundary_patch.push_back(patches);
    }

    // Points in the order of their first use: what an element needs lies close together.
    std::vector<std::uint32_t> number_of_point(blending.point_count(), no_function);
    std::vector<std::uint32_t> used;
    const auto first_point = static_cast<std::uint32_t>(spline.rows.size());
    for (std::size_t e = first_element; e < spline.elements.size(); ++e) {
        for (std::uint32_t& point : spline.elements[e]) {
            std::uint32_t& entry = number_of_point[point];
            if (entry == no_function) {
                entry = first_point + static_cast<std::uint32_t>(used.size());
                used.push_back(point);
            }
            point = entry;
        }
    }
    number_of_point = {};

    if (truncation == nullptr) {
        SparseRows rows = build_rows(
            used.size(), [&](std::size_t p, RationalRowSum& row) { return blending.row(used[p], row); });
        if (spline.rows.size() == 0)
            spline.rows = std::move(rows);
        else
            append(spline.rows, rows);
        return;
    }
    append(spline.rows, build_rows<RealRowSum>(used.size(), [&](std::size_t p, RealRowSum& kept) {
               thread_local RationalRowSum untruncated;
               thread_local RealRowSum truncated;
               const auto denominator = static_cast<double>(blending.row(used[p], untruncated));
               truncated.clear();
               for (const auto& term : untruncated.merged()) {
                   const double coefficient = static_cast<double>(term.value) / denominator;
                   const SparseRow row = (*truncation)[term.column];
                   for (std::size_t i = 0; i < row.size(); ++i)
                       truncated.add(row.columns[i], coefficient * row.values[i]);
               }
               drop_negligible(truncated.merged(), kept);
           }));
}

class THSpline3D : public SplineBuilder {
  public:
    SplineResult build(const hex::HexMesh& mesh, const SplineOptions& options,
                       const hex::Context& context) const override {
        SplineResult result;
        LevelMesh coarsest = input_level(mesh, options);
        for (int g = 0; g < options.global_refinements; ++g) {
            context.check_cancelled();
            context.progress("global refinement", static_cast<double>(g) / options.global_refinements);
            Subdivision next = subdivide(coarsest);
            coarsest = std::move(next.fine);
        }
        describe(coarsest, result.report);

        Hierarchy hierarchy = refine(std::move(coarsest), options, context);
        result.report.diagnostics = std::move(hierarchy.diagnostics);

        const bool refined = hierarchy.levels.size() > 1;
        const std::vector<SparseRows> truncation =
            refined ? truncation_operators(hierarchy) : std::vector<SparseRows>();
        for (std::size_t l = 0; l < hierarchy.levels.size(); ++l) {
            context.check_cancelled();
            context.progress("extraction",
                             static_cast<double>(l) / static_cast<double>(hierarchy.levels.size()));
            HierarchyLevel& level = hierarchy.levels[l];
            extract(level, l, refined ? &truncation[l] : nullptr, result.spline);

            LevelReport about;
            about.elements = level.domain_cells;
            about.refined = level.refined.size();
            about.active_elements = level.domain_cells - level.refined.size();
            for (std::size_t v = 0; v < level.function_active.size(); ++v) {
                if (level.function_active[v] == 0) continue;
                ++about.active_functions;
                result.spline.control_points.push_back(level.control.mesh.position(VertexId(v)));
            }
            if (l < hierarchy.added.size()) about.added_by_closure = hierarchy.added[l];
            result.report.levels.push_back(about);
            result.levels.push_back({std::move(level.control.mesh), std::move(level.function_active),
                                     std::move(level.element_active), std::move(level.function),
                                     std::move(level.refined)});
            level = {};
        }
        result.spline.weights.assign(result.spline.control_points.size(), 1.0);
        context.progress("extraction", 1.0);
        return result;
    }
};

const hex::Register<SplineBuilder, THSpline3D> registered(
    spline_builders(), "thspline3d",
    "truncated hierarchical tricubic splines with Catmull-Clark levels (Wei et al.)");

}  // namespace
}  // namespace spline
