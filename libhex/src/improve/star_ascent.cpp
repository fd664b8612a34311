#include "improve/star_ascent.h"

#include "improve/coloring.h"
#include "volume/counting_rows.h"

#include <hex/base/parallel.h>
#include <hex/improve/corner_energies.h>
#include <hex/quality/scaled_jacobian.h>

#include <algorithm>

namespace hex::improving {
namespace {

/// Below this minimum a star may be mended at any cost to the shape of the boundary.
constexpr double careless = 0.3;
/// Energy of the shape that a scaled Jacobian may cost: the slope of the barrier at a gap of 0.1.
constexpr double exchange = 10.0;
/// Edges that are shorter than this share of what they should be do not get shorter still.
constexpr double shortest = 0.05;
/// What raising a vertex costs, in evaluations of a cell's energy with its gradient.
constexpr double work_per_vertex = 30.0;
/// Lengths of the tried steps in shares of the mean edge length.
constexpr std::array<double, 6> steps = {0.4, 0.15, 0.05, 0.015, 0.005, 0.0015};

class StarAscent {
  public:
    explicit StarAscent(SlidingMesh& mesh) : mesh_(mesh), sizes_(mesh.vertex_sizes()) {
        if (mesh.keeper() != nullptr) mesh.keeper()->follow(mesh.positions());
    }

    /// Moves v to the best place found; whether it moved.
    bool raise(VertexId v) {
        const Vec3 here = mesh_.mesh().position(v);
        const double now = star_minimum(v, here, -2.0);
        double best = now + 1e-7;
        const bool bound = mesh_.on_boundary(v);
        if (bound && mesh_.guide() == nullptr) return false;
        const Freedom freedom = bound ? mesh_.guide()->freedom(v) : Freedom::interior;
        if (freedom == Freedom::corner) return false;
        const bool kept = bound && mesh_.keeper() != nullptr && now >= careless;
        const double cost = kept ? mesh_.keeper()->around(v, here, mesh_.positions()) : 0.0;
        const auto free_spot = [](const Vec3& p) { return SlidingMesh::Spot{{p, Vec3::Zero(), 0}, p}; };
        SlidingMesh::Spot best_place = free_spot(here);
        bool found = false;
        const auto attempt = [&](const Vec3& p) {
            const SlidingMesh::Spot place = bound ? mesh_.place(v, p) : free_spot(p);
            const double quality = star_minimum(v, place.point, best);
            if (!(quality > best)) return;
            if (kept &&
                mesh_.keeper()->around(v, place.point, mesh_.positions()) - cost > exchange * (quality - now))
                return;
            best = quality;
            best_place = place;
            found = true;
        };
        const double size = sizes_[v.index()];
        for (const double depth : {0.01, 0.05, 0.3}) {
            Vec3 direction = ascent_direction(v, now - depth);
            if (mesh_.slack() == 0.0) direction = tangential(v, freedom, direction);
            const double length = direction.norm();
            if (!(length > 0.0)) continue;
            for (const double share : steps) attempt(here + share * size / length * direction);
        }
        if (freedom == Freedom::curve) {
            for (const double share : steps) {
                attempt(here + share * size * mesh_.axis(v));
                attempt(here - share * size * mesh_.axis(v));
            }
            if (!mesh_.smooth_curves())
                for (const Vec3& kink : mesh_.guide()->segment(v, mesh_.item(v).value_or(0))) attempt(kink);
        } else if (!found) {
            for (const double share : {0.1, 0.02, 0.004}) {
                for (Eigen::Index i = 0; i < 3; ++i) {
                    attempt(here + share * size * Vec3::Unit(i));
                    attempt(here - share * size * Vec3::Unit(i));
                }
            }
        }
        if (found) mesh_.move(v, best_place);
        return found;
    }

    /// Vertices that the shape keeper looks at for each active vertex, beyond its own cells.
    CompressedRows<VertexId> reads(const std::vector<char>& active) const {
        return rows_by_counting<VertexId>(active.size(), [&](const auto& emit) {
            if (mesh_.keeper() == nullptr) return;
            for (std::size_t i = 0; i < active.size(); ++i) {
                const VertexId v(i);
                if (!active[i] || !mesh_.on_boundary(v)) continue;
                mesh_.keeper()->visit_reach(v, [&](VertexId w) {
                    if (active[w.index()] && w != v) emit(i, w);
                });
            }
        });
    }

  private:
    Vec3 tangential(VertexId v, Freedom freedom, const Vec3& d) const {
        const Vec3& axis = mesh_.axis(v);
        if (freedom == Freedom::region) return d - d.dot(axis) * axis;
        if (freedom == Freedom::curve) return d.dot(axis) * axis;
        return d;
    }

    /// Smallest scaled Jacobian around v when it is at p; only whether it is above `enough` matters.
    double star_minimum(VertexId v, const Vec3& p, double enough) const {
        double smallest = 1.0;
        for (const std::uint32_t c : mesh_.corners_at(v)) {
            std::array<Vec3, 8> corners = mesh_.mesh().corner_positions(CellId(c / 8));
            if (crushes(c, corners, p)) return -2.0;
            corners[c % 8] = p;
            const double quality = scaled_jacobian(corners);
            // Exactly 0 is an edge without length, from which there is no direction out again.
            smallest = std::min(smallest, quality == 0.0 ? -1.0 : quality);
            if (smallest <= enough) break;
        }
        return smallest;
    }

    /// Whether an edge at corner c % 8 of cell c / 8 is too short with the corner at p, and shorter than now.
    bool crushes(std::uint32_t c, const std::array<Vec3, 8>& corners, const Vec3& p) const {
        if (mesh_.boxes().empty()) return false;
        const Vec3& box = mesh_.boxes()[c / 8];
        const auto& uvw = hexahedron::corner_uvw[c % 8];
        for (const int n : hexahedron::corner_neighbours[c % 8]) {
            const auto neighbour = static_cast<std::size_t>(n);
            std::size_t axis = 0;
            while (hexahedron::corner_uvw[neighbour][axis] == uvw[axis]) ++axis;
            const double least = shortest * box[static_cast<Eigen::Index>(axis)];
            const double square = (corners[neighbour] - p).squaredNorm();
            if (square < least * least && square < (corners[neighbour] - corners[c % 8]).squaredNorm())
                return true;
        }
        return false;
    }

    /// Against the gradient of the barrier around v.
    Vec3 ascent_direction(VertexId v, double floor) const {
        QualityBarrier barrier;
        barrier.floor = floor;
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t c : mesh_.corners_at(v)) {
            HexCorners gradient;
            gradient.fill(Vec3::Zero());
            if (std::isfinite(barrier.evaluate(mesh_.mesh().corner_positions(CellId(c / 8)), &gradient)))
                sum -= gradient[c % 8];
        }
        return sum;
    }

    SlidingMesh& mesh_;
    std::vector<double> sizes_;
};

}  // namespace

int raise_star_minima(SlidingMesh& mesh, const AscentOptions& options, const Context& context) {
    StarAscent ascent(mesh);
    const CompressedRows<CellId> cells = vertex_cells(mesh.mesh());
    std::vector<double> minima;
    int sweeps = 0;
    for (; sweeps < options.most_sweeps; ++sweeps) {
        context.check_cancelled();
        if (options.satisfied && options.satisfied()) break;
        const std::vector<double> values = scaled_jacobians(mesh.mesh());
        const double worst = *std::min_element(values.begin(), values.end());
        minima.push_back(worst);
        if (worst >= options.target) break;
        const auto patience = static_cast<std::size_t>(options.patience);
        if (minima.size() > patience && worst - minima[minima.size() - 1 - patience] < options.gain) break;
        const double bad = worst + options.margin;
        std::vector<char> active(mesh.mesh().vertex_count(), 0);
        for (const CellId c : mesh.mesh().cells())
            if (values[c.index()] < bad)
                for (const VertexId v : mesh.mesh().cell(c)) active[v.index()] = 1;
        std::size_t moved = 0;
        for (const auto& members : independent_classes(mesh.mesh(), cells, active, ascent.reads(active))) {
            mesh.add_work(work_per_vertex * static_cast<double>(members.size()));
            moved += parallel_reduce(
                members.size(), std::size_t{0},
                [&](std::size_t count, std::size_t i) { return count + ascent.raise(members[i]); },
                [](std::size_t x, std::size_t y) { return x + y; }, 4);
        }
        if (moved == 0) break;
    }
    return sweeps;
}

}  // namespace hex::improving
