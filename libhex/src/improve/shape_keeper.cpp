#include "improve/shape_keeper.h"

#include "surface/nearest_point.h"
#include "surface/search_set.h"
#include "volume/counting_rows.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <cmath>

namespace hex::improving {
namespace {

constexpr double surface_weight = 20.0;  // of a quad
constexpr double sharp_weight = 4.0;     // of an edge
/// Where the energy of sharp edges turns from a square to a straight line, in shares of the size.
constexpr double turn = 0.05;
/// Points on sharp edges farther than this share of the size from any edge are not the mesh's to follow.
constexpr double sharp_reach = 0.5;
/// The hinge H max(0, (r / L)^2 - s)^2.
constexpr double hinge = 50.0;
constexpr double hinge_start = 0.6;
/// The surface is flat where the normals' cosine is above this.
constexpr double flat_cosine = 0.9995;
constexpr int most_steps = 20;
/// Share of the points that may need more than one quad before all are compared anew.
constexpr double most_compared = 0.3;
constexpr std::size_t grain = 64;

}  // namespace

ShapeKeeper::ShapeKeeper(const EdgeTable& edges, const BoundaryQuads& boundary, const GuideSurface& surface,
                         double sharp_cosine, std::span<const Vec3> positions)
    : edges_(edges), boundary_(boundary), limit_(surface.diagonal), near_edges_(edges.size()) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::array<std::uint32_t, 2>> quads_at(edges.size(), {none, none});
    std::vector<std::array<EdgeId, 4>> quad_edges(boundary.size());
    for (std::uint32_t q = 0; q < boundary.size(); ++q) {
        for (std::size_t i = 0; i < 4; ++i) {
            const EdgeId e = edges.find(boundary.vertices[q][i], boundary.vertices[q][(i + 1) % 4]);
            quad_edges[q][i] = e;
            auto& sides = quads_at[e.index()];
            sides[sides[0] == none ? 0 : 1] = q;
        }
    }
    near_quads_ = rows_by_counting<std::uint32_t>(boundary.size(), [&](const auto& emit) {
        for (std::uint32_t q = 0; q < boundary.size(); ++q) {
            emit(q, q);
            for (const EdgeId e : quad_edges[q])
                for (const std::uint32_t side : quads_at[e.index()])
                    if (side != none && side != q) emit(q, side);
        }
    });
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
        if (!edges.boundary[e]) continue;
        near_edges_[e].push_back(e);
        for (const VertexId v : edges.vertices[e])
            for (const EdgeId next : edges.vertex_edges[v.index()])
                if (edges.boundary[next.index()] && next.index() != e) near_edges_[e].push_back(next.value());
    }
    double length = 0.0;
    std::size_t count = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (!edges.boundary[e]) continue;
        length += (positions[edges.vertices[e][0].index()] - positions[edges.vertices[e][1].index()]).norm();
        ++count;
    }
    add_surface_points(surface, 0.5 * length / static_cast<double>(count), positions);
    add_sharp_points(surface, sharp_cosine, positions);
    feet_.resize(points_.size());
    nearest_.resize(points_.size());
    lead_.resize(points_.size());
    quad_move_.resize(boundary.size());
    follow(positions);
}

std::vector<double> ShapeKeeper::quad_sizes(std::span<const Vec3> positions) const {
    std::vector<double> sizes;
    double mean = 0.0;
    for (const auto& quad : boundary_.vertices) {
        double sum = 0.0;
        for (std::size_t i = 0; i < 4; ++i)
            sum += (positions[quad[i].index()] - positions[quad[(i + 1) % 4].index()]).norm();
        sizes.push_back(0.25 * sum);
        mean += 0.25 * sum / static_cast<double>(boundary_.size());
    }
    // Quads crushed to nothing must not weigh infinitely.
    for (double& size : sizes) size = std::max(size, 0.25 * mean);
    return sizes;
}

void ShapeKeeper::add_surface_points(const GuideSurface& surface, double spacing,
                                     std::span<const Vec3> positions) {
    std::vector<Vec3> places;
    std::vector<char> bent(surface.points.size(), 0);
    for (const GuideSurface::Edge& edge : surface.edges) {
        if (edge.cosine > flat_cosine) continue;
        const Vec3& a = surface.points[edge.vertices[0]];
        const Vec3& b = surface.points[edge.vertices[1]];
        for (const std::uint32_t v : edge.vertices) bent[v] = 1;
        const int pieces = static_cast<int>(std::min(1000.0, std::ceil((b - a).norm() / spacing)));
        for (int i = 1; i < pieces; ++i) places.emplace_back(a + static_cast<double>(i) / pieces * (b - a));
    }
    for (std::size_t v = 0; v < bent.size(); ++v)
        if (bent[v]) places.push_back(surface.points[v]);
    // No more than are needed on surfaces much finer than the mesh.
    const std::size_t stride = 1 + places.size() / (12 * boundary_.size());

    std::vector<SearchTriangle> triangles;
    const auto at = [&](VertexId v) -> const Vec3& { return positions[v.index()]; };
    for (const auto& quad : boundary_.vertices) {
        triangles.push_back({at(quad[0]), at(quad[1]), at(quad[2])});
        triangles.push_back({at(quad[0]), at(quad[2]), at(quad[3])});
    }
    const TriangleSearch search(std::move(triangles));
    const std::vector<double> sizes = quad_sizes(positions);
    points_.resize(places.size() / stride);
    parallel_for(
        points_.size(),
        [&](std::size_t i) {
            const Vec3& p = places[i * stride];
            const std::uint32_t quad = search.closest(p).item / 2;
            points_[i] = {p, quad, 1.0, sizes[quad], false};
        },
        grain);
    share_weights(0, boundary_.size(), surface_weight);
}

void ShapeKeeper::add_sharp_points(const GuideSurface& surface, double sharp_cosine,
                                   std::span<const Vec3> positions) {
    std::vector<SearchSegment> segments;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
        if (!edges_.boundary[e]) continue;
        segments.push_back(
            {positions[edges_.vertices[e][0].index()], positions[edges_.vertices[e][1].index()]});
        numbers.push_back(e);
    }
    const SegmentSearch search(std::move(segments));
    const std::size_t first = points_.size();
    const auto add = [&](const Vec3& p) {
        const auto found = search.closest(p);
        const std::uint32_t e = numbers[found.item];
        double size = 0.0;
        for (const std::uint32_t near : near_edges_[e])
            size +=
                (positions[edges_.vertices[near][0].index()] - positions[edges_.vertices[near][1].index()])
                    .norm();
        size /= static_cast<double>(near_edges_[e].size());
        if ((found.point - p).norm() < sharp_reach * size) points_.push_back({p, e, 1.0, size, true});
    };
    for (const GuideSurface::Edge& edge : surface.edges) {
        if (!(edge.cosine < sharp_cosine)) continue;
        const Vec3& a = surface.points[edge.vertices[0]];
        const Vec3& b = surface.points[edge.vertices[1]];
        for (const double share : {0.1, 0.5, 0.9}) add(a + share * (b - a));
    }
    share_weights(first, edges_.size(), sharp_weight);
}

void ShapeKeeper::share_weights(std::size_t first, std::size_t homes, double weight) {
    std::vector<std::size_t> count(homes, 0);
    for (std::size_t i = first; i < points_.size(); ++i) ++count[points_[i].home];
    for (std::size_t i = first; i < points_.size(); ++i)
        points_[i].weight = weight / static_cast<double>(count[points_[i].home]);
}

template <class Positions>
ShapeKeeper::Foot ShapeKeeper::foot_on(const Point& point, std::uint32_t home, const Positions& at) const {
    Foot found;
    found.home = home;
    if (point.sharp) {
        const auto& [a, b] = edges_.vertices[home];
        const NearestPoint nearest = nearest_on_segment(point.place, at(a), at(b));
        found.vertices = {a, b, b};
        found.shares = nearest.shares;
        found.squared = nearest.squared;
    } else {
        const auto& [a, b, c, d] = boundary_.vertices[home];
        const NearestPoint first = nearest_on_triangle(point.place, at(a), at(b), at(c));
        const NearestPoint second = nearest_on_triangle(point.place, at(a), at(c), at(d));
        const bool in_first = first.squared <= second.squared;
        found.vertices = in_first ? std::array<VertexId, 3>{a, b, c} : std::array<VertexId, 3>{a, c, d};
        found.shares = in_first ? first.shares : second.shares;
        found.squared = in_first ? first.squared : second.squared;
    }
    found.off = point.place;
    for (std::size_t i = 0; i < 3; ++i) found.off -= found.shares[i] * at(found.vertices[i]);
    return found;
}

template <class Positions>
ShapeKeeper::Foot ShapeKeeper::foot(const Point& point, const Positions& at) const {
    Foot best;
    best.squared = std::numeric_limits<double>::infinity();
    double rival = std::numeric_limits<double>::infinity();
    const auto take = [&](const Foot& candidate) {
        const bool nearer = candidate.squared < best.squared;
        rival = std::min(rival, nearer ? best.squared : candidate.squared);
        if (nearer) best = candidate;
    };
    if (point.sharp) {
        for (const std::uint32_t e : near_edges_[point.home]) take(foot_on(point, e, at));
    } else {
        for (const std::uint32_t q : near_quads_[point.home]) {
            const auto& v = boundary_.vertices[q];
            const Vec3& a = at(v[0]);
            const Vec3& b = at(v[1]);
            const Vec3& c = at(v[2]);
            const Vec3& d = at(v[3]);
            const Vec3 low = a.cwiseMin(b).cwiseMin(c.cwiseMin(d));
            const Vec3 high = a.cwiseMax(b).cwiseMax(c.cwiseMax(d));
            const double outside =
                (low - point.place).cwiseMax(point.place - high).cwiseMax(0.0).squaredNorm();
            if (outside < best.squared)
                take(foot_on(point, q, at));
            else
                rival = std::min(rival, outside);
        }
    }
    best.rival = rival;
    return best;
}

void ShapeKeeper::find_feet(std::span<const Vec3> positions) const {
    const auto at = [&](VertexId v) -> const Vec3& { return positions[v.index()]; };
    const auto compare = [&] {
        compared_.assign(positions.begin(), positions.end());
        parallel_for(
            points_.size(),
            [&](std::size_t i) {
                feet_[i] = foot(points_[i], at);
                nearest_[i] = feet_[i].home;
                lead_[i] = std::sqrt(feet_[i].rival) - std::sqrt(feet_[i].squared);
            },
            grain);
    };
    if (compared_.size() != positions.size()) {
        compare();
        return;
    }
    parallel_for(
        boundary_.size(),
        [&](std::size_t q) {
            double farthest = 0.0;
            for (const VertexId v : boundary_.vertices[q])
                farthest = std::max(farthest, (at(v) - compared_[v.index()]).squaredNorm());
            quad_move_[q] = std::sqrt(farthest);
        },
        grain);
    // Neither the nearest nor a rival has come or gone farther than its vertices.
    const auto certain = [&](std::size_t i) {
        double move = 0.0;
        if (points_[i].sharp) {
            for (const std::uint32_t e : near_edges_[points_[i].home])
                for (const VertexId v : edges_.vertices[e])
                    move = std::max(move, (at(v) - compared_[v.index()]).norm());
        } else {
            for (const std::uint32_t q : near_quads_[points_[i].home]) move = std::max(move, quad_move_[q]);
        }
        return 2.0 * move < lead_[i];
    };
    const std::size_t compared = parallel_reduce(
        points_.size(), std::size_t{0},
        [&](std::size_t count, std::size_t i) {
            const bool known = certain(i);
            feet_[i] = known ? foot_on(points_[i], nearest_[i], at) : foot(points_[i], at);
            return count + (known ? 0 : 1);
        },
        [](std::size_t a, std::size_t b) { return a + b; }, grain);
    if (static_cast<double>(compared) > most_compared * static_cast<double>(points_.size()))
        compared_.clear();
}

std::array<double, 2> ShapeKeeper::cost(const Point& point, double squared) const {
    const double scale = 1.0 / (point.size * point.size);
    if (point.sharp) {
        const double inverse = scale / (turn * turn);
        const double root = std::sqrt(1.0 + inverse * squared);
        return {strength_ * point.weight * (root - 1.0), strength_ * point.weight * 0.5 * inverse / root};
    }
    double value = point.weight * scale * squared;
    double slope = point.weight * scale;
    const double over = squared / (limit_ * limit_) - hinge_start;
    if (over > 0.0) {
        value += hinge * over * over;
        slope += 2.0 * hinge * over / (limit_ * limit_);
    }
    return {strength_ * value, strength_ * slope};
}

void ShapeKeeper::follow(std::span<const Vec3> positions) {
    const auto at = [&](VertexId v) -> const Vec3& { return positions[v.index()]; };
    parallel_for(
        points_.size(),
        [&](std::size_t i) {
            for (int step = 0; step < most_steps; ++step) {
                const std::uint32_t home = foot(points_[i], at).home;
                if (home == points_[i].home) break;
                points_[i].home = home;
            }
        },
        grain);
    compared_.clear();
    points_at_ = rows_by_counting<std::uint32_t>(positions.size(), [&](const auto& emit) {
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            const std::uint32_t home = points_[i].home;
            if (points_[i].sharp) {
                for (const VertexId v : edges_.vertices[home]) emit(v.index(), i);
            } else {
                for (const VertexId v : boundary_.vertices[home]) emit(v.index(), i);
            }
        }
    });
}

double ShapeKeeper::evaluate(std::span<const Vec3> positions, std::vector<Vec3>* gradient) const {
    if (strength_ == 0.0) return 0.0;
    find_feet(positions);
    double sum = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const auto [value, slope] = cost(points_[i], feet_[i].squared);
        sum += value;
        if (gradient == nullptr) continue;
        for (std::size_t k = 0; k < 3; ++k)
            (*gradient)[feet_[i].vertices[k].index()] -= 2.0 * slope * feet_[i].shares[k] * feet_[i].off;
    }
    return sum;
}

double ShapeKeeper::around(VertexId v, const Vec3& p, std::span<const Vec3> positions) const {
    if (strength_ == 0.0) return 0.0;
    const auto at = [&](VertexId w) -> const Vec3& { return w == v ? p : positions[w.index()]; };
    double sum = 0.0;
    for (const std::uint32_t i : points_at_[v.index()]) {
        const Foot found = foot(points_[i], at);
        sum += cost(points_[i], found.squared)[0];
    }
    return sum;
}

}  // namespace hex::improving
