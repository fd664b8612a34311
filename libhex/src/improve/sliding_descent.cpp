#include "improve/sliding_descent.h"

#include "volume/counting_rows.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace hex::improving {
namespace {

constexpr std::size_t memory = 10;   // pairs that L-BFGS remembers
constexpr double sufficient = 1e-4;  // Armijo's constant
constexpr int most_halvings = 30;

/// No vector longer than `share` of the size of its vertex.
void shorten(std::vector<Vec3>& vectors, const std::vector<double>& sizes, double share) {
    parallel_for(vectors.size(), [&](std::size_t i) {
        const double most = share * sizes[i];
        const double length = vectors[i].norm();
        if (length > most) vectors[i] *= most / length;
    });
}

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return parallel_reduce(
        a.size(), 0.0, [&](double sum, std::size_t i) { return sum + a[i].dot(b[i]); },
        [](double x, double y) { return x + y; });
}

}  // namespace

SlidingMesh::SlidingMesh(const HexMesh& mesh, const EdgeTable& edges, const BoundaryGuide* guide,
                         const BoundaryQuads& boundary)
    : mesh_(mesh),
      edges_(edges),
      guide_(guide),
      boundary_(boundary),
      corners_at_(rows_by_counting<std::uint32_t>(mesh.vertex_count(),
                                                  [&](const auto& emit) {
                                                      for (std::size_t c = 0; c < mesh.cell_count(); ++c)
                                                          for (std::size_t k = 0; k < 8; ++k)
                                                              emit(mesh.cell_array()[c][k].index(),
                                                                   static_cast<std::uint32_t>(8 * c + k));
                                                  })),
      axis_(mesh.vertex_count(), Vec3::Zero()),
      item_(mesh.vertex_count()),
      foot_(mesh.vertex_count(), Vec3::Zero()),
      memory_(guide == nullptr ? 0 : mesh.vertex_count()),
      cell_gradient_(mesh.cell_count()),
      cell_value_(mesh.cell_count()) {}

void SlidingMesh::set_positions(std::span<const Vec3> positions) {
    mesh_.set_positions({positions.begin(), positions.end()});
    if (guide_ == nullptr) return;
    parallel_for(
        boundary_.boundary_vertices.size(),
        [&](std::size_t i) {
            const VertexId v = boundary_.boundary_vertices[i];
            const Vec3 here = mesh_.position(v);
            move(v, place(v, here));
            mesh_.set_position(v, here);
        },
        64);
}

void SlidingMesh::use_smooth_curves(bool smooth) {
    if (smooth == smooth_) return;
    smooth_ = smooth;
    for (const VertexId v : boundary_.boundary_vertices)
        if (guide_ != nullptr && guide_->freedom(v) == Freedom::curve) item_[v.index()].reset();
}

void SlidingMesh::attach() {
    if (guide_ == nullptr) return;
    parallel_for(
        boundary_.boundary_vertices.size(),
        [&](std::size_t i) {
            const VertexId v = boundary_.boundary_vertices[i];
            move(v, place(v, mesh_.position(v)));
        },
        64);
}

double SlidingMesh::evaluate(const MeshEnergy& energy, std::vector<Vec3>* gradient) const {
    constexpr std::size_t chunk = 128;
    work_ += static_cast<double>(mesh_.cell_count());
    parallel_for((mesh_.cell_count() + chunk - 1) / chunk,
                 [&](std::size_t i) {
                     energy.evaluate(mesh_, i * chunk, std::min((i + 1) * chunk, mesh_.cell_count()),
                                     cell_value_, gradient != nullptr ? cell_gradient_.data() : nullptr);
                 },
                 1);
    double sum = parallel_reduce(
        cell_value_.size(), 0.0, [&](double s, std::size_t c) { return s + cell_value_[c]; },
        [](double a, double b) { return a + b; });
    if (gradient == nullptr && keeper_ != nullptr && std::isfinite(sum))
        sum += keeper_->evaluate(positions(), nullptr);
    if (gradient != nullptr) {
        gradient->resize(mesh_.vertex_count());
        parallel_for(mesh_.vertex_count(), [&](std::size_t v) {
            Vec3 total = Vec3::Zero();
            for (const std::uint32_t corner : corners_at_[v]) total += cell_gradient_[corner / 8][corner % 8];
            (*gradient)[v] = total;
        });
        if (keeper_ != nullptr && std::isfinite(sum)) sum += keeper_->evaluate(positions(), gradient);
        make_tangential(*gradient, -1.0);
    }
    return sum;
}

BoundaryGuide::Place SlidingMesh::on_part(VertexId v, const Vec3& p) const {
    const auto hint = item_[v.index()];
    TriangleSearch::Memory* const memory = &memory_[v.index()];
    return smooth_ ? guide_->nearest_smooth(v, p, hint, memory) : guide_->nearest(v, p, hint, memory);
}

SlidingMesh::Spot SlidingMesh::place(VertexId v, const Vec3& p) const {
    const BoundaryGuide::Place place = on_part(v, p);
    Spot spot{place, place.point};
    if (slack_ > 0.0 && guide_->freedom(v) != Freedom::corner) {
        const Vec3 off = p - spot.foot;
        const double distance = off.norm();
        spot.point = distance <= slack_ ? p : Vec3(spot.foot + slack_ / distance * off);
    }
    return spot;
}

void SlidingMesh::move(VertexId v, const Spot& spot) {
    mesh_.set_position(v, spot.point);
    axis_[v.index()] = spot.axis;
    item_[v.index()] = spot.item;
    foot_[v.index()] = spot.foot;
}

void SlidingMesh::make_tangential(std::vector<Vec3>& vectors, double sign) const {
    parallel_for(boundary_.boundary_vertices.size(), [&](std::size_t i) {
        const VertexId v = boundary_.boundary_vertices[i];
        Vec3& d = vectors[v.index()];
        const Vec3& axis = axis_[v.index()];
        if (slack_ > 0.0 && guide_ != nullptr && guide_->freedom(v) != Freedom::corner) {
            const Vec3 off = mesh_.position(v) - foot_[v.index()];
            const double distance = off.norm();
            if (distance < 0.999 * slack_) return;
            const double outwards = sign * d.dot(off) / distance;
            if (outwards > 0.0) d -= d.dot(off) / (distance * distance) * off;
            return;
        }
        switch (guide_ == nullptr ? Freedom::corner : guide_->freedom(v)) {
            case Freedom::region:
                d -= d.dot(axis) * axis;
                break;
            case Freedom::curve:
                d = d.dot(axis) * axis;
                break;
            case Freedom::corner:
                d.setZero();
                break;
            case Freedom::interior:
                break;
        }
    });
}

void SlidingMesh::retract(std::span<const Vec3> origin, std::span<const Vec3> direction, double step) {
    parallel_for(
        mesh_.vertex_count(),
        [&](std::size_t i) {
            const VertexId v(i);
            Vec3 p = origin[i] + step * direction[i];
            if (guide_ != nullptr && boundary_.contains(v)) {
                if (direction[i].isZero(0.0)) {
                    p = origin[i];
                } else {
                    move(v, place(v, p));
                    return;
                }
            }
            mesh_.set_position(v, p);
        },
        64);
}

std::vector<double> SlidingMesh::vertex_sizes() const {
    std::vector<double> sizes(mesh_.vertex_count(), 0.0);
    parallel_for(sizes.size(), [&](std::size_t i) {
        const VertexId v(i);
        const auto around = edges_.vertex_edges[i];
        if (around.empty()) return;
        double sum = 0.0;
        for (const EdgeId e : around) sum += (mesh_.position(edges_.other(e, v)) - mesh_.position(v)).norm();
        sizes[i] = sum / static_cast<double>(around.size());
    });
    return sizes;
}

DescentResult descend(SlidingMesh& mesh, const MeshEnergy& energy, const DescentOptions& options,
                      const Context& context) {
    struct Pair {
        std::vector<Vec3> move, change;
        double inverse_product;
    };
    DescentResult result;
    const std::size_t n = mesh.mesh().vertex_count();
    const std::vector<double> sizes = mesh.vertex_sizes();
    std::vector<double> scale(n);  // the initial inverse Hessian's diagonal
    for (std::size_t i = 0; i < n; ++i) scale[i] = sizes[i] * sizes[i];
    const auto scaled = [&](std::vector<Vec3>& v, double factor) {
        parallel_for(n, [&](std::size_t i) { v[i] *= factor * scale[i]; });
    };
    const auto add = [&](std::vector<Vec3>& v, double factor, const std::vector<Vec3>& w) {
        parallel_for(n, [&](std::size_t i) { v[i] += factor * w[i]; });
    };

    if (mesh.keeper() != nullptr) mesh.keeper()->follow(mesh.positions());
    std::vector<Vec3> gradient;
    double value = mesh.evaluate(energy, &gradient);
    result.before = result.after = value;
    ++result.evaluations;
    if (!std::isfinite(value)) return result;
    std::deque<Pair> pairs;
    std::vector<double> values = {value};
    while (result.iterations < options.most_iterations) {
        context.check_cancelled();
        std::vector<Vec3> direction = gradient;
        std::vector<double> alpha(pairs.size());
        for (std::size_t k = pairs.size(); k-- > 0;) {
            alpha[k] = pairs[k].inverse_product * dot(pairs[k].move, direction);
            add(direction, -alpha[k], pairs[k].change);
        }
        double factor = 1.0;
        if (!pairs.empty()) {
            std::vector<Vec3> weighted = pairs.back().change;
            scaled(weighted, 1.0);
            factor = 1.0 / (pairs.back().inverse_product * dot(pairs.back().change, weighted));
        }
        scaled(direction, -factor);
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            const double beta = pairs[k].inverse_product * dot(pairs[k].change, direction);
            add(direction, -alpha[k] - beta, pairs[k].move);
        }
        mesh.make_tangential(direction, 1.0);
        // One vertex with a huge gradient, at a very short edge, must not hold up all the others. Shortened
        // for each vertex alone, the direction of steepest descent still leads down.
        if (pairs.empty()) shorten(direction, sizes, options.largest_move);
        double slope = dot(gradient, direction);
        if (!(slope < 0.0)) {
            if (pairs.empty()) break;
            pairs.clear();
            continue;
        }
        const double fastest = parallel_reduce(
            n, 0.0,
            [&](double most, std::size_t i) {
                return sizes[i] > 0.0 ? std::max(most, direction[i].norm() / sizes[i]) : most;
            },
            [](double a, double b) { return std::max(a, b); });
        double step = std::min(1.0, options.largest_move / fastest);
        const std::vector<Vec3> origin(mesh.positions().begin(), mesh.positions().end());
        std::vector<Vec3> new_gradient;
        double new_value = value;
        bool lower = false;
        for (int i = 0; i < most_halvings && !lower; ++i, step *= 0.5) {
            mesh.retract(origin, direction, step);
            new_value = mesh.evaluate(energy, &new_gradient);
            ++result.evaluations;
            lower = new_value <= value + sufficient * step * slope;
        }
        if (!lower) {
            mesh.set_positions(origin);
            if (pairs.empty()) break;
            pairs.clear();
            mesh.evaluate(energy, &gradient);
            continue;
        }
        ++result.iterations;
        Pair pair;
        pair.move.assign(mesh.positions().begin(), mesh.positions().end());
        add(pair.move, -1.0, origin);
        pair.change = new_gradient;
        add(pair.change, -1.0, gradient);
        const double product = dot(pair.move, pair.change);
        const double norms = std::sqrt(dot(pair.move, pair.move) * dot(pair.change, pair.change));
        if (product > 1e-8 * norms) {
            pair.inverse_product = 1.0 / product;
            pairs.push_back(std::move(pair));
            if (pairs.size() > memory) pairs.pop_front();
        }
        gradient.swap(new_gradient);
        value = new_value;
        values.push_back(value);
        if (options.satisfied && options.satisfied()) break;
        const auto window = static_cast<std::size_t>(options.window);
        if (values.size() > window &&
            values[values.size() - 1 - window] - value <
                options.relative_gain *
                    std::max(std::abs(value), static_cast<double>(mesh.mesh().cell_count())))
            break;
    }
    result.after = value;
    return result;
}

}  // namespace hex::improving
