/// The methods `untangle` and `auto`.

#include "improve/guide_options.h"
#include "improve/minimum_raiser.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <cstdio>

namespace hex {
namespace {

using improving::Deadline;
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
    char text[200];
    std::snprintf(
        text, sizeof text,
        "boundary vertices are at most %.3g %% of the diagonal off their part of the surface; %zu of "
        "its %zu sharp curves are followed",
        raiser.best_record().distance, raiser.guide().matched_curve_count(), raiser.guide().curve_count());
    report.diagnostics.push_back({Severity::note, "surface-distance", text, "", {}});
    report.feature_edges = raiser.guide().curve_edges();
    const double percent = 100.0 / raiser.guide().diagonal();
    const auto scaled = [&](const improving::Fidelity& f) {
        return ImproveFidelity{percent * f.distance, percent * f.features};
    };
    if (!raiser.guided_by_surface()) return;
    report.fidelity_before = scaled(raiser.fidelity_before());
    report.fidelity_after = scaled(raiser.fidelity_after());
    report.fidelity_limit = scaled(raiser.fidelity_limits());
    std::snprintf(text, sizeof text,
                  "largest distance between boundary and surface %.4g %% of the diagonal (input %.4g), mean "
                  "distance of sharp edges %.4g %% (input %.4g)",
                  report.fidelity_after->distance, report.fidelity_before->distance,
                  report.fidelity_after->features, report.fidelity_before->features);
    const bool kept = raiser.fidelity_after().within(raiser.fidelity_limits());
    report.diagnostics.push_back(
        {kept ? Severity::note : Severity::warning, kept ? "fidelity" : "fidelity-lost", text, "", {}});
}

/// The raiser's mesh, or the input where that is better.
ImproveResult result_of(const HexMesh& input, const MinimumRaiser& raiser, const Context& context) {
    ImproveResult result;
    result.report.history = raiser.history();
    result.report.seconds = raiser.seconds();
    result.report.work = raiser.work();
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
        const Deadline deadline(options);
        MinimumRaiser raiser(mesh, improving::make_guide_surface(mesh, boundary_quads(mesh), options),
                             options, deadline, context);
        raiser.run();
        return result_of(mesh, raiser, context);
    }
};

/// Whether all of the worst cells have two boundary faces on one smooth region: at the edge between such
/// faces the surface leaves an angle of nearly 180 degrees, and no motion of vertices makes that a good
/// corner. A layer does not help the others.
bool limited_by_flat_edges(const MinimumRaiser& raiser, const Context& context) {
    const HexMesh& mesh = raiser.current();
    const std::vector<double> values = scaled_jacobians(mesh, context);
    const auto has_flat_edge = [&](CellId c) {
        for (std::size_t e = 0; e < hexahedron::edge_corners.size(); ++e) {
            const auto& ends = hexahedron::edge_corners[e];
            const auto& faces = hexahedron::edge_faces[e];
            if (!mesh.is_boundary(HexMesh::half_face(c, faces[0])) ||
                !mesh.is_boundary(HexMesh::half_face(c, faces[1])))
                continue;
            if (raiser.guide().freedom(mesh.corner(c, ends[0])) == Freedom::region ||
                raiser.guide().freedom(mesh.corner(c, ends[1])) == Freedom::region)
                return true;
        }
        return false;
    };
    constexpr double about_the_worst = 0.01;
    const double bad = raiser.now().min + about_the_worst;
    for (const CellId c : mesh.cells())
        if (values[c.index()] <= bad && !has_flat_edge(c)) return false;
    return true;
}

/// untangle; but where, once the mesh is valid, elements with two boundary faces on one smooth region are
/// what limits the minimum, a layer of elements is put around first. It is kept if that is better by enough.
class AutoImprover : public Improver {
  public:
    ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                          const Context& context) const override {
        const Deadline deadline(options);
        const GuideSurface surface = improving::make_guide_surface(mesh, boundary_quads(mesh), options);
        MinimumRaiser plain(mesh, surface, options, deadline, context);
        plain.begin();
        if (plain.now().min >= std::min(worth_a_layer, options.target) || deadline.passed() ||
            !limited_by_flat_edges(plain, context)) {
            plain.finish();
            return result_of(mesh, plain, context);
        }
        ImproveOptions layer;
        layer.count = 1;
        const HexMesh layered = improvers().make("pillow")->improve(plain.current(), layer, context).mesh;
        MinimumRaiser raised(layered, surface, options, deadline, context);
        raised.take_limits(plain);
        raised.run();
        const bool good = raised.has_best() && raised.best_record().inverted == 0 &&
                          raised.best_record().min >= worth_a_layer;
        if (!good) {
            plain.finish();
            if (plain.has_best() && !worth_it(raised, plain)) return result_of(mesh, plain, context);
        }
        ImproveResult result = result_of(mesh, raised, context);
        auto& history = result.report.history;
        history.insert(history.begin(), plain.history().begin(), plain.history().end());
        for (std::size_t i = 0; i < history.size(); ++i) history[i].sweep = static_cast<int>(i) + 1;
        result.report.work += plain.work();
        for (const auto& [step, seconds] : plain.seconds()) add_seconds(result.report, step, seconds);
        if (result.mesh.cell_count() == mesh.cell_count()) return result;
        std::string text =
            "elements with two boundary faces on a smooth part of the surface limited the minimum; a layer "
            "of ";
        text += std::to_string(layered.cell_count() - mesh.cell_count()) + " elements was put around";
        result.report.diagnostics.push_back({Severity::note, "layer-added", text, "", {}});
        return result;
    }

  private:
    static bool worth_it(const MinimumRaiser& layered, const MinimumRaiser& plain) {
        if (!layered.has_best()) return false;
        const ImproveRecord& before = plain.best_record();
        const ImproveRecord& after = layered.best_record();
        return after.inverted < before.inverted ||
               (after.inverted == before.inverted && after.min >= before.min + least_gain);
    }
    static void add_seconds(ImproveReport& report, const std::string& step, double seconds) {
        for (auto& [name, sum] : report.seconds) {
            if (name != step) continue;
            sum += seconds;
            return;
        }
        report.seconds.emplace_back(step, seconds);
    }
};

const Register<Improver, UntangleImprover> registered_untangle(
    improvers(), "untangle",
    "no inverted element, then the largest smallest scaled Jacobian; boundary slides");
const Register<Improver, AutoImprover> registered_auto(
    improvers(), "auto", "untangle, and a layer around where the surface's smoothness limits the elements");

}  // namespace
}  // namespace hex
