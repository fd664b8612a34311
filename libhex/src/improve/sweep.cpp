#include "improve/sweep.h"

#include "improve/guide_options.h"

#include <hex/base/parallel.h>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstdio>

namespace hex::improving {
namespace {

/// Distances below this share of the surface's diagonal count as none.
constexpr double on_surface = 1e-9;
constexpr int most_attaching_passes = 10;

}  // namespace

FeatureSet make_features(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                         const ImproveOptions& options) {
    switch (options.features) {
        case FeatureSource::none:
            return no_features(mesh, edges, boundary);
        case FeatureSource::angle:
            return features_by_angle(mesh, edges, boundary, options.feature_cosine);
        case FeatureSource::list:
            return features_from_vertices(mesh, edges, boundary, options.feature_vertices);
    }
    return no_features(mesh, edges, boundary);
}

ImproveRecord record_of(std::span<const double> values) {
    struct Partial {
        double sum = 0.0;
        double min = std::numeric_limits<double>::infinity();
        std::size_t inverted = 0;
    };
    const Partial total = parallel_reduce(
        values.size(), Partial{},
        [&](Partial p, std::size_t i) {
            return Partial{p.sum + values[i], std::min(p.min, values[i]), p.inverted + (values[i] <= 0.0)};
        },
        [](const Partial& a, const Partial& b) {
            return Partial{a.sum + b.sum, std::min(a.min, b.min), a.inverted + b.inverted};
        });
    ImproveRecord record;
    record.min = total.min;
    record.mean = total.sum / static_cast<double>(values.size());
    record.inverted = total.inverted;
    return record;
}

Sweeper::Sweeper(const HexMesh& mesh, const ImproveOptions& options, const TriangleMesh* surface,
                 const Context& context)
    : mesh_(mesh),
      context_(context),
      edges_(edge_table(mesh_)),
      boundary_(boundary_quads(mesh_)),
      features_(make_features(mesh_, edges_, boundary_, options)),
      stars_(vertex_stars(mesh_)),
      values_(scaled_jacobians(mesh_, context)) {
    report_.sharp_edges = features_.sharp_edge_count();
    if (surface != nullptr)
        guide_ = std::make_unique<BoundaryGuide>(
            mesh_, edges_, boundary_, make_guide_surface(mesh_, boundary_, options), curve_options(options));
    motion_.emplace(mesh_, edges_, boundary_, features_, guide_.get());
}

Sweeper::Sweeper(const HexMesh& mesh, const ImproveOptions& options, const Context& context)
    : Sweeper(mesh, options, options.surface, context) {
    if (guide_) {
        classes_ = independent_classes(mesh_, boundary_.on_boundary);
        attach_to_surface();
    }
    std::vector<char> movable(mesh_.vertex_count(), 1);
    for (const VertexId v : boundary_.boundary_vertices) movable[v.index()] = !motion_->is_fixed(v);
    classes_ = independent_classes(mesh_, movable);
}

Sweeper::Sweeper(const HexMesh& mesh, const std::vector<char>& interior_flags, const Context& context)
    : Sweeper(mesh, ImproveOptions(), nullptr, context) {
    std::vector<char> movable = interior_flags;
    for (const VertexId v : boundary_.boundary_vertices) movable[v.index()] = 0;
    classes_ = independent_classes(mesh_, movable);
}

double Sweeper::mean_edge_length(VertexId v) const {
    const auto around = edges_.vertex_edges[v.index()];
    double sum = 0.0;
    for (const EdgeId e : around) sum += (mesh_.position(edges_.other(e, v)) - mesh_.position(v)).norm();
    return sum / static_cast<double>(around.size());
}

double Sweeper::star_minimum(VertexId v) const {
    double smallest = 1.0;
    for (const StarCell& c : stars_[v.index()]) smallest = std::min(smallest, values_[c.cell]);
    return smallest;
}

Star& Sweeper::gather(VertexId v, Workspace& workspace) const {
    workspace.star.gather(mesh_, stars_[v.index()]);
    return workspace.star;
}

void Sweeper::move(VertexId v, const Vec3& p, const Star& star) {
    mesh_.set_position(v, p);
    star.store(p, values_);
}

std::size_t Sweeper::sweep(const Visit& visit) {
    tbb::enumerable_thread_specific<Workspace> workspaces;
    std::size_t moved = 0;
    for (const auto& members : classes_) {
        context_.check_cancelled();
        moved += parallel_reduce(
            members.size(), std::size_t{0},
            [&](std::size_t count, std::size_t i) { return count + visit(members[i], workspaces.local()); },
            [](std::size_t a, std::size_t b) { return a + b; }, 16);
    }
    return moved;
}

void Sweeper::run(int count, const std::string& step, const Visit& visit,
                  const std::function<void()>& prepare) {
    for (int i = 0; i < count; ++i) {
        if (prepare) prepare();
        const std::size_t moved = sweep(visit);
        ImproveRecord record = record_of(values_);
        record.sweep = i + 1;
        record.moved = moved;
        report_.history.push_back(record);
        context_.progress(step, static_cast<double>(i + 1) / count);
        if (record.moved == 0) break;
    }
}

/// Boundary vertices that are off the surface go to their place on it, unless that inverts an element.
void Sweeper::attach_to_surface() {
    const double nothing = on_surface * guide_->diagonal();
    const auto visit = [&](VertexId v, Workspace& workspace) {
        const Vec3 here = mesh_.position(v);
        const Vec3 target = motion_->constrained(v, here);
        if ((target - here).norm() <= nothing) return false;
        const Star& star = gather(v, workspace);
        if (star.quality(target).inverted > star.quality(here).inverted) return false;
        move(v, target, star);
        return true;
    };
    for (int pass = 0; pass < most_attaching_passes && sweep(visit) > 0; ++pass) {
    }
}

void Sweeper::report_distance() {
    Diagnostic off;
    off.severity = Severity::warning;
    off.code = "off-surface";
    off.entity = "vertex";
    double largest = 0.0;
    for (const VertexId v : boundary_.boundary_vertices) {
        const double distance = (motion_->constrained(v, mesh_.position(v)) - mesh_.position(v)).norm();
        if (distance <= on_surface * guide_->diagonal()) continue;
        off.ids.push_back(static_cast<std::int64_t>(v.index()));
        largest = std::max(largest, distance);
    }
    if (off.ids.empty()) return;
    char percent[32];
    std::snprintf(percent, sizeof percent, "%.3g", 100.0 * largest / guide_->diagonal());
    off.message =
        std::to_string(off.ids.size()) +
        " boundary vertices could not be brought onto the surface without inverting an element; the "
        "farthest is " +
        percent + " % of the diagonal away";
    report_.diagnostics.push_back(std::move(off));
}

ImproveResult Sweeper::finish() {
    if (guide_) {
        // What the sweeps made room for.
        classes_ = independent_classes(mesh_, boundary_.on_boundary);
        attach_to_surface();
        report_distance();
    }
    return {std::move(mesh_), std::move(report_)};
}

}  // namespace hex::improving
