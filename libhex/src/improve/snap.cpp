/// The method `snap`: the boundary of a valid mesh that is near a surface is pulled onto it, and no element
/// is ever inverted on the way.

#include "improve/sliding_descent.h"
#include "improve/snap_targets.h"
#include "improve/star.h"
#include "improve/sweep.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/improve/corner_energies.h>
#include <hex/improve/improve.h>

#include <algorithm>
#include <cstdio>

namespace hex {
namespace {

using improving::SnapTarget;
using improving::SnapTargets;

/// Wished thickness of the layer, in shares of the edges of the quad that a cell of it stands on.
constexpr double layer_thickness = 0.5;
/// Strength of the pull to the targets, relative to the shape of the cells, round by round.
constexpr std::array<double, 10> pulls = {1.0, 2.0, 4.0, 10.0, 25.0, 60.0, 150.0, 400.0, 1000.0, 3000.0};
constexpr int iterations_per_pull = 20;
/// Share of the pull that also acts along the surface.
constexpr double tangential_share = 0.02;
/// What is off the surface by more than this share of the size is pulled harder, round by round by this
/// factor, until the sum of squares has not fallen below this share of the least so many rounds in a row.
constexpr double tolerated = 0.05;
constexpr double harder = 2.0;
constexpr int most_harder_pulls = 20;
constexpr double worth_pulling = 0.9;
constexpr int most_in_vain = 2;
constexpr int rings_that_give_way = 3;
/// A boundary vertex may go to its place on the surface if the scaled Jacobians around it stay above this,
/// or do not fall.
constexpr double worth_keeping = 0.1;
constexpr int most_attaching_passes = 6;

/// Mean lengths of the edges along the three axes of a cell; of the bottom only, where that is all there is.
Vec3 box_of(const HexMesh& mesh, const HexCell& cell, bool bottom_only) {
    constexpr std::array<Eigen::Index, 12> axis = {0, 1, 0, 1, 2, 2, 2, 2, 0, 1, 0, 1};
    Vec3 box = Vec3::Zero();
    for (std::size_t e = 0; e < 12; ++e) {
        const auto& [a, b] = hexahedron::edge_corners[e];
        if (bottom_only && (a > 3 || b > 3)) continue;
        box[axis[e]] += (mesh.position(cell[static_cast<std::size_t>(a)]) -
                         mesh.position(cell[static_cast<std::size_t>(b)]))
                            .norm() /
                        (bottom_only ? 2.0 : 4.0);
    }
    return box;
}

/// Edge lengths that the cells should have, along their three axes.
std::vector<Vec3> wished_boxes(const HexMesh& before, const HexMesh& layered) {
    std::vector<Vec3> boxes(layered.cell_count());
    parallel_for(boxes.size(), [&](std::size_t c) {
        const bool in_layer = c >= before.cell_count();
        boxes[c] = box_of(before, layered.cell_array()[c], in_layer);
        if (in_layer) boxes[c].z() = layer_thickness * std::min(boxes[c].x(), boxes[c].y());
    });
    return boxes;
}

class Snapper {
  public:
    Snapper(const HexMesh& before, const HexMesh& layered, const ImproveOptions& options,
            const Context& context)
        : context_(context),
          edges_(edge_table(layered)),
          boundary_(boundary_quads(layered)),
          surface_(*options.surface, layered, boundary_),
          boxes_(wished_boxes(before, layered)),
          mesh_(layered, edges_, nullptr, no_boundary(layered)),
          targets_(layered.vertex_count()),
          stiffness_(layered.vertex_count(), 0.0) {
        for (const VertexId v : boundary_.boundary_vertices) {
            double size = 0.0;
            for (const std::uint32_t corner : mesh_.corners_at(v))
                size += std::min(boxes_[corner / 8].x(), boxes_[corner / 8].y());
            const auto count = static_cast<double>(mesh_.corners_at(v).size());
            size /= count;
            stiffness_[v.index()] = 1.0 / (size * size * count);
        }
    }

    void run() {
        for (std::size_t round = 0; round < pulls.size(); ++round) {
            context_.progress("snap", static_cast<double>(round) / (pulls.size() + 1));
            aim();
            pull(pulls[round]);
        }
        pull_harder();
        attach();
    }

    ImproveResult result(const HexMesh& input) {
        ImproveResult result{mesh_.mesh(), {}};
        result.report.history = history_;
        double largest = 0.0;
        aim();
        for (const VertexId v : boundary_.boundary_vertices)
            largest = std::max(largest, (targets_[v.index()].point - mesh_.mesh().position(v)).norm());
        char text[160];
        std::snprintf(text, sizeof text,
                      "boundary vertices are at most %.3g %% of the diagonal off the surface; the layer has "
                      "%zu elements",
                      100.0 * largest / surface_.diagonal(), mesh_.mesh().cell_count() - input.cell_count());
        result.report.diagnostics.push_back({Severity::note, "surface-distance", text, "", {}});
        return result;
    }

  private:
    /// To the minimiser every vertex is an inner one: what holds the boundary is the pull.
    const BoundaryQuads& no_boundary(const HexMesh& mesh) {
        free_.on_boundary.assign(mesh.vertex_count(), 0);
        return free_;
    }
    /// Targets for the boundary as it is now.
    void aim() { surface_.aim(mesh_.mesh(), targets_); }

    /// Minimises shape and pull together; infinite, and so never accepted, where a cell is inverted.
    void pull(double strength) {
        const FoldoverEnergy shape{0.0, 1.0};
        const auto energy = [&](std::size_t c, const HexCorners& corners, HexCorners* gradient) {
            double value = shape.evaluate(corners, boxes_[c], gradient);
            if (!std::isfinite(value)) return value;
            if (scaled_jacobian(corners) <= improving::rounding)
                return std::numeric_limits<double>::infinity();
            const HexCell& cell = mesh_.mesh().cell_array()[c];
            for (std::size_t k = 0; k < 8; ++k) {
                const double stiff = strength * stiffness_[cell[k].index()];
                if (stiff == 0.0) continue;
                const SnapTarget& target = targets_[cell[k].index()];
                const Vec3 off = corners[k] - target.point;
                const Vec3 along = off.dot(target.axis) * target.axis;
                Vec3 held = off;
                if (target.kind == SnapTarget::Kind::smooth) held = along;
                if (target.kind == SnapTarget::Kind::edge) held = off - along;
                const Vec3 force = (1.0 - tangential_share) * held + tangential_share * off;
                value += stiff * off.dot(force);
                if (gradient != nullptr) (*gradient)[k] += 2.0 * stiff * force;
            }
            return value;
        };
        improving::DescentOptions descent;
        descent.most_iterations = iterations_per_pull;
        descent.relative_gain = 1e-5;
        (void)improving::descend(mesh_, improving::PerCellEnergy(energy), descent, context_);
        record(0);
    }

    /// Where the solid is thinner than the cells, their wished shape holds the boundary off the surface. So
    /// cells there may keep the shape that they have come to, and the pull grows.
    void pull_harder() {
        double least = std::numeric_limits<double>::infinity();
        double strength = pulls.back();
        int in_vain = 0;
        for (int round = 0; round < most_harder_pulls; ++round, strength *= harder) {
            aim();
            std::vector<char> held(mesh_.mesh().vertex_count(), 0);
            const double off = find_held_off(held);
            in_vain = off > worth_pulling * least ? in_vain + 1 : 0;
            if (off == 0.0 || in_vain > most_in_vain) return;
            least = std::min(least, off);
            give_way_around(std::move(held));
            pull(strength);
        }
    }

    /// Marks boundary vertices that are farther from their targets than tolerated; returns the sum of the
    /// squares of their distances, in squares of the size of the quads there.
    double find_held_off(std::vector<char>& held) const {
        double sum = 0.0;
        for (const VertexId v : boundary_.boundary_vertices) {
            const double square = (targets_[v.index()].point - mesh_.mesh().position(v)).squaredNorm() *
                                  stiffness_[v.index()] * static_cast<double>(mesh_.corners_at(v).size());
            if (square <= tolerated * tolerated) continue;
            held[v.index()] = 1;
            sum += square;
        }
        return sum;
    }

    /// The present shape is the wished one of all cells in so many rings around the marked vertices.
    void give_way_around(std::vector<char> marked) {
        const HexMesh& mesh = mesh_.mesh();
        std::vector<char> reached(mesh.cell_count(), 0);
        for (int ring = 0; ring < rings_that_give_way; ++ring) {
            for (std::size_t c = 0; c < reached.size(); ++c) {
                const HexCell& cell = mesh.cell_array()[c];
                reached[c] =
                    std::any_of(cell.begin(), cell.end(), [&](VertexId v) { return marked[v.index()] != 0; });
            }
            for (std::size_t c = 0; c < reached.size(); ++c)
                if (reached[c])
                    for (const VertexId v : mesh.cell_array()[c]) marked[v.index()] = 1;
        }
        parallel_for(boxes_.size(), [&](std::size_t c) {
            if (reached[c]) boxes_[c] = box_of(mesh, mesh.cell_array()[c], false);
        });
    }

    void record(std::size_t moved) {
        ImproveRecord now = improving::record_of(scaled_jacobians(mesh_.mesh(), context_));
        now.sweep = static_cast<int>(history_.size()) + 1;
        now.moved = moved;
        history_.push_back(now);
    }

    /// Puts boundary vertices exactly on the surface where that spoils nothing.
    void attach() {
        const CompressedRows<improving::StarCell> stars = improving::vertex_stars(mesh_.mesh());
        const auto classes = improving::independent_classes(mesh_.mesh(), boundary_.on_boundary);
        for (int pass = 0; pass < most_attaching_passes; ++pass) {
            aim();
            std::size_t moved = 0;
            for (const auto& members : classes) {
                context_.check_cancelled();
                moved += parallel_reduce(
                    members.size(), std::size_t{0},
                    [&](std::size_t count, std::size_t i) {
                        return count + attach(members[i], stars[members[i].index()]);
                    },
                    [](std::size_t a, std::size_t b) { return a + b; }, 16);
            }
            record(moved);
            if (moved == 0) break;
        }
    }

    bool attach(VertexId v, std::span<const improving::StarCell> cells) {
        const Vec3 here = mesh_.mesh().position(v);
        const Vec3& there = targets_[v.index()].point;
        if ((there - here).isZero(0.0)) return false;
        improving::Star star;
        star.gather(mesh_.mesh(), cells);
        const double now = star.quality(here).min;
        for (const double share : {1.0, 0.5, 0.25}) {
            const Vec3 p = share == 1.0 ? there : Vec3(here + share * (there - here));
            const double then = star.quality(p).min;
            if (then < now && then < worth_keeping) continue;
            mesh_.move(v, {{p, Vec3::Zero(), 0}, p});
            return true;
        }
        return false;
    }

    const Context& context_;
    EdgeTable edges_;
    BoundaryQuads boundary_;
    SnapTargets surface_;
    BoundaryQuads free_;
    std::vector<Vec3> boxes_;
    improving::SlidingMesh mesh_;
    std::vector<SnapTarget> targets_;
    std::vector<double> stiffness_;  // 1 / (size^2 number of cells); 0 inside
    std::vector<ImproveRecord> history_;
};

class SnapImprover : public Improver {
  public:
    ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                          const Context& context) const override {
        if (options.surface == nullptr)
            throw Error(ErrorKind::usage, "snap has no surface to snap to", {}, "give it with --surface");
        const QualitySummary given = summarize(mesh, context);
        if (given.inverted > 0)
            throw Error(ErrorKind::bad_input,
                        "snap starts from a mesh without inverted elements, this one has " +
                            std::to_string(given.inverted),
                        "cell " + std::to_string(given.worst.index()), "use untangle first");
        HexMesh layered = mesh;
        if (options.count != 0)
            layered = improvers().make("pillow")->improve(mesh, layers(options), context).mesh;
        const QualitySummary start = summarize(layered, context);
        if (start.inverted > 0)
            throw Error(ErrorKind::no_result, "no layer of elements fits around the mesh",
                        "cell " + std::to_string(start.worst.index()), "use -n 0 to snap without a layer");
        Snapper snapper(mesh, layered, options, context);
        snapper.run();
        return snapper.result(mesh);
    }

  private:
    static ImproveOptions layers(const ImproveOptions& options) {
        ImproveOptions layer = options;
        layer.method = "pillow";
        layer.count = 1;
        return layer;
    }
};

const Register<Improver, SnapImprover> registered(
    improvers(), "snap",
    "a layer around the mesh, then its boundary is pulled onto the surface; inverts nothing");

}  // namespace
}  // namespace hex
