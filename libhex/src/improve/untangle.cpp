/// The methods `untangle` and `auto`.

#include "improve/minimum_raiser.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <cstdio>

namespace hex {
namespace {

using improving::Freedom;
using improving::GuideSurface;
using improving::MinimumRaiser;

/// Below this minimum a layer around the mesh is tried.
constexpr double worth_a_layer = 0.5;
/// A layer must raise the minimum by this much to be worth its elements.
constexpr double least_gain = 0.03;

ImproveRecord measure(const HexMesh& mesh, const Context& context) {
    const QualitySummary summary = summarize(mesh, context);
    ImproveRecord record;
    record.min = summary.min;
    record.mean = summary.mean;
    record.inverted = summary.inverted;
    return record;
}

void report_distance(const MinimumRaiser& raiser, ImproveReport& report) {
    double largest = 0.0;
    for (const VertexId v : raiser.boundary().boundary_vertices) {
        const Vec3& p = raiser.best().position(v);
        largest = std::max(largest, (raiser.guide().nearest(v, p, 0).point - p).norm());
    }
    char text[240];
    std::snprintf(
        text, sizeof text,
        "boundary vertices are at most %.3g %% of the diagonal off their part of the surface; %zu of "
        "its %zu sharp curves are followed",
        100.0 * largest / raiser.guide().diagonal(), raiser.guide().matched_curve_count(),
        raiser.guide().curve_count());
    report.diagnostics.push_back({Severity::note, "surface-distance", text, "", {}});
    const double percent = 100.0 / raiser.guide().diagonal();
    std::snprintf(text, sizeof text,
                  "largest distance between boundary and surface %.4g %% of the diagonal (input %.4g), mean "
                  "distance of sharp edges %.4g %% (input %.4g)",
                  percent * raiser.fidelity_after().distance, percent * raiser.fidelity_before().distance,
                  percent * raiser.fidelity_after().features, percent * raiser.fidelity_before().features);
    report.diagnostics.push_back({Severity::note, "fidelity", text, "", {}});
}

/// The raiser's mesh, or the input where that is better.
ImproveResult result_of(const HexMesh& input, const MinimumRaiser& raiser, const Context& context) {
    ImproveResult result;
    result.report.history = raiser.history();
    result.report.sharp_edges = raiser.sharp_edge_count();
    if (!raiser.has_best() || improving::better(measure(input, context), raiser.best_record())) {
        result.mesh = input;
        result.report.diagnostics.push_back(
            {Severity::note, "input-kept", "nothing better than the input was found", "", {}});
        return result;
    }
    result.mesh = raiser.best();
    report_distance(raiser, result.report);
    return result;
}

class UntangleImprover : public Improver {
  public:
    ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                          const Context& context) const override {
        MinimumRaiser raiser(mesh, improving::make_guide_surface(mesh, boundary_quads(mesh), options),
                             options, context);
        raiser.run();
        return result_of(mesh, raiser, context);
    }
};

/// Whether bad cells have two boundary faces on one smooth region: at the edge between such faces the surface
/// leaves an angle of nearly 180 degrees, and no motion of vertices makes that a good corner.
bool limited_by_flat_edges(const MinimumRaiser& raiser, const Context& context) {
    const HexMesh& mesh = raiser.best();
    const std::vector<double> values = scaled_jacobians(mesh, context);
    const double bad = raiser.best_record().min + 0.1;
    for (const CellId c : mesh.cells()) {
        if (values[c.index()] > bad) continue;
        for (const auto& ends : hexahedron::edge_corners) {
            const auto& faces =
                hexahedron::edge_faces[static_cast<std::size_t>(&ends - hexahedron::edge_corners.data())];
            if (!mesh.is_boundary(HexMesh::half_face(c, faces[0])) ||
                !mesh.is_boundary(HexMesh::half_face(c, faces[1])))
                continue;
            if (raiser.guide().freedom(mesh.corner(c, ends[0])) == Freedom::region ||
                raiser.guide().freedom(mesh.corner(c, ends[1])) == Freedom::region)
                return true;
        }
    }
    return false;
}

/// untangle; then, where elements with two boundary faces on one smooth region are what limits the minimum,
/// the same again with a layer of elements around the input, if that is better by enough.
class AutoImprover : public Improver {
  public:
    ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                          const Context& context) const override {
        const GuideSurface surface = improving::make_guide_surface(mesh, boundary_quads(mesh), options);
        MinimumRaiser plain(mesh, surface, options, context);
        plain.run();
        ImproveResult result = result_of(mesh, plain, context);
        if (!plain.has_best() || plain.best_record().min >= std::min(worth_a_layer, options.target) ||
            !limited_by_flat_edges(plain, context))
            return result;

        ImproveOptions layer;
        layer.count = 1;
        const HexMesh layered = improvers().make("pillow")->improve(plain.best(), layer, context).mesh;
        MinimumRaiser raised(layered, surface, options, context);
        raised.run();
        const ImproveRecord& before = plain.best_record();
        const ImproveRecord& after = raised.best_record();
        if (!raised.has_best() || after.inverted > before.inverted ||
            (after.inverted == before.inverted && after.min < before.min + least_gain))
            return result;
        ImproveResult with_layer = result_of(mesh, raised, context);
        with_layer.report.history.insert(with_layer.report.history.begin(), plain.history().begin(),
                                         plain.history().end());
        for (std::size_t i = 0; i < with_layer.report.history.size(); ++i)
            with_layer.report.history[i].sweep = static_cast<int>(i) + 1;
        with_layer.report.diagnostics.push_back(
            {Severity::note,
             "layer-added",
             "elements with two boundary faces on a smooth part of the surface limited the minimum; a layer "
             "of " +
                 std::to_string(layered.cell_count() - mesh.cell_count()) + " elements was put around",
             "",
             {}});
        return with_layer;
    }
};

const Register<Improver, UntangleImprover> registered_untangle(
    improvers(), "untangle",
    "no inverted element, then the largest smallest scaled Jacobian; boundary slides");
const Register<Improver, AutoImprover> registered_auto(
    improvers(), "auto", "untangle, and a layer around where the surface's smoothness limits the elements");

}  // namespace
}  // namespace hex
