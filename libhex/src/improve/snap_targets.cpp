#include "improve/snap_targets.h"

#include "improve/surface_curves.h"
#include "surface/search_set.h"

#include <hex/base/components.h>
#include <hex/base/error.h>
#include <hex/base/parallel.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>

namespace hex::improving {
namespace {

/// A triangle faces the same way as the boundary when the cosine between their normals is above this.
constexpr double same_way = 0.2;
/// Triangles of a direction are those whose normals have a larger cosine with it. No vector is farther than
/// 54.7 degrees from the nearest of the fourteen.
constexpr double of_direction = 0.25;
/// A point that faces the same way is not taken when it is so many times farther than the closest one.
constexpr double much_farther = 8.0;

std::array<Vec3, 14> make_directions() {
    std::array<Vec3, 14> d;
    std::size_t n = 0;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const int nonzero = std::abs(x) + std::abs(y) + std::abs(z);
                if (nonzero == 1 || nonzero == 3) d[n++] = Vec3(x, y, z).normalized();
            }
    return d;
}

/// Of the scaled quadric of the planes at a vertex: the second and third eigenvalue above which it is at an
/// edge or in a corner. Two planes of equal weight with an angle of 40 degrees between their normals have a
/// second eigenvalue of 0.12.
constexpr double edge_eigenvalue = 0.1;
constexpr double corner_eigenvalue = 0.04;
/// Planes are taken at points this far from the vertex to the middle of the quad.
constexpr double towards_middle = 0.4;
/// The point between the planes must be as near to the surface, and to the vertex, in shares of the size.
constexpr double on_surface_share = 0.1;
constexpr double farthest_share = 1.5;
/// No two edges of a quad may go to a feature with a cosine between them below this.
constexpr double straightest = -0.85;

struct Bin {
    std::vector<std::uint32_t> triangles;
    std::unique_ptr<TriangleSearch> search;
};

/// The triangles of one component of the surface.
struct Component {
    Bin all;
    std::array<Bin, 14> facing;
    double volume = 0.0;
};

double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c) {
    return a.dot(b.cross(c));
}

}  // namespace

struct SnapTargets::State {
    GuideSurface surface;
    std::array<Vec3, 14> directions = make_directions();
    std::vector<std::uint32_t> component_of;  // of each triangle
    std::vector<std::unique_ptr<Component>> components;
    std::vector<std::uint32_t> home;  // component of each boundary vertex
    std::vector<double> sign;         // -1: the surface is oriented against the boundary there
    std::vector<std::uint32_t>
        last;  // item of `all` found last for each vertex: where the next search starts

    void fill(Bin& bin) const {
        if (bin.triangles.empty()) return;
        std::vector<SearchTriangle> items;
        for (const std::uint32_t t : bin.triangles) {
            const auto& v = surface.triangles[t];
            items.push_back({surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]});
        }
        bin.search = std::make_unique<TriangleSearch>(std::move(items));
    }

    void make_components() {
        const auto count = static_cast<std::uint32_t>(surface.triangles.size());
        Components triangles(count);
        for (const auto& edge : surface.edges) {
            if (edge.triangles[0] >= 0 && edge.triangles[1] >= 0)
                triangles.join(static_cast<std::size_t>(edge.triangles[0]),
                               static_cast<std::size_t>(edge.triangles[1]));
        }
        std::uint32_t number = 0;
        component_of = triangles.numbers(number);
        for (std::uint32_t c = 0; c < number; ++c) components.push_back(std::make_unique<Component>());
        for (std::uint32_t t = 0; t < count; ++t) {
            Component& own = *components[component_of[t]];
            own.all.triangles.push_back(t);
            const auto& v = surface.triangles[t];
            own.volume += six_volumes(surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]);
            for (std::size_t d = 0; d < own.facing.size(); ++d)
                if (surface.normals[t].dot(directions[d]) > of_direction)
                    own.facing[d].triangles.push_back(t);
        }
        for (auto& own : components) {
            fill(own->all);
            parallel_for(
                own->facing.size(), [&](std::size_t d) { fill(own->facing[d]); }, 1);
        }
    }

    /// Which component of the surface the components of the boundary belong to, and how that is oriented.
    void find_homes(const HexMesh& mesh, const BoundaryQuads& boundary) {
        constexpr std::size_t most_votes = 1000;
        Components quads_joined(boundary.size());
        for (const VertexId v : boundary.boundary_vertices) {
            const auto quads = boundary.vertex_quads[v.index()];
            for (const QuadId q : quads) quads_joined.join(quads.front().index(), q.index());
        }
        std::uint32_t count = 0;
        const std::vector<std::uint32_t> piece = quads_joined.numbers(count);
        std::vector<double> volume(count, 0.0);
        std::vector<std::size_t> size(count, 0);
        std::vector<std::vector<std::size_t>> votes(count, std::vector<std::size_t>(components.size(), 0));
        for (std::size_t q = 0; q < boundary.size(); ++q) {
            const auto& quad = boundary.vertices[q];
            const std::array<Vec3, 4> p = {mesh.position(quad[0]), mesh.position(quad[1]),
                                           mesh.position(quad[2]), mesh.position(quad[3])};
            volume[piece[q]] += six_volumes(p[0], p[1], p[2]) + six_volumes(p[0], p[2], p[3]);
            ++size[piece[q]];
        }
        if (components.size() > 1) {
            Bin whole;
            for (std::uint32_t t = 0; t < component_of.size(); ++t) whole.triangles.push_back(t);
            fill(whole);
            std::vector<std::size_t> seen(count, 0);
            for (std::size_t q = 0; q < boundary.size(); ++q) {
                if (seen[piece[q]]++ % (1 + size[piece[q]] / most_votes) != 0) continue;
                Vec3 middle = Vec3::Zero();
                for (const VertexId v : boundary.vertices[q]) middle += 0.25 * mesh.position(v);
                ++votes[piece[q]][component_of[whole.search->closest(middle).item]];
            }
        }
        home.assign(mesh.vertex_count(), 0);
        sign.assign(mesh.vertex_count(), 1.0);
        last.assign(mesh.vertex_count(), 0);
        for (const VertexId v : boundary.boundary_vertices) {
            const std::uint32_t own = piece[boundary.vertex_quads[v.index()].front().index()];
            const auto& ballot = votes[own];
            home[v.index()] =
                static_cast<std::uint32_t>(std::max_element(ballot.begin(), ballot.end()) - ballot.begin());
            if (volume[own] * components[home[v.index()]]->volume < 0.0) sign[v.index()] = -1.0;
        }
    }
};

SnapTargets::SnapTargets(const TriangleMesh& surface, const HexMesh& mesh, const BoundaryQuads& boundary)
    : state_(std::make_unique<State>()), boundary_(boundary) {
    state_->surface = make_guide_surface(surface);
    if (state_->surface.triangles.empty())
        throw Error(ErrorKind::bad_input, "the surface to stay on has no triangle with an area");
    state_->make_components();
    state_->find_homes(mesh, boundary);
}

SnapTargets::~SnapTargets() = default;

double SnapTargets::diagonal() const {
    return state_->surface.diagonal;
}

/// The closest point that faces the way of `normal`; zero: any will do. Its axis points out of the mesh. To
/// be called by one thread for each vertex.
SnapTarget SnapTargets::closest(VertexId v, const Vec3& p, const Vec3& normal) const {
    const Component& own = *state_->components[state_->home[v.index()]];
    const double sign = state_->sign[v.index()];
    const auto target = [&](const Bin& bin, const TriangleSearch::Answer& answer) {
        return SnapTarget{answer.point, sign * state_->surface.normals[bin.triangles[answer.item]]};
    };
    std::uint32_t& last = state_->last[v.index()];
    const TriangleSearch::Answer found = own.all.search->closest(p, last);
    last = found.item;
    const SnapTarget nearest = target(own.all, found);
    if (normal.isZero(0.0) || nearest.axis.dot(normal) > same_way) return nearest;
    const Vec3 facing = sign * normal;
    std::size_t direction = 0;
    for (std::size_t d = 1; d < own.facing.size(); ++d)
        if (state_->directions[d].dot(facing) > state_->directions[direction].dot(facing)) direction = d;
    const Bin& bin = own.facing[direction];
    if (bin.triangles.empty()) return nearest;
    const auto other = bin.search->closest_within(p, much_farther * (nearest.point - p).norm());
    return other ? target(bin, *other) : nearest;
}

SnapTarget SnapTargets::target_of(const HexMesh& mesh, VertexId v) const {
    const Vec3& p = mesh.position(v);
    struct Plane {
        Vec3 point, normal;
        double weight;
    };
    std::array<Plane, 16> planes;
    std::size_t count = 0;
    Vec3 outward = Vec3::Zero();
    double size = 0.0;
    double weights = 0.0;
    const auto quads = boundary_.vertex_quads[v.index()];
    for (const QuadId q : quads) {
        const auto& quad = boundary_.vertices[q.index()];
        const Vec3 area = 0.5 * (mesh.position(quad[2]) - mesh.position(quad[0]))
                                    .cross(mesh.position(quad[3]) - mesh.position(quad[1]));
        const double weight = area.norm();
        outward += area;
        if (!(weight > 0.0) || count == planes.size()) continue;
        Vec3 middle = Vec3::Zero();
        for (const VertexId w : quad) middle += 0.25 * mesh.position(w);
        const SnapTarget at = closest(v, p + towards_middle * (middle - p), area / weight);
        planes[count++] = {at.point, at.axis, weight};
        weights += weight;
        size += std::sqrt(weight) / static_cast<double>(quads.size());
    }
    const double length = outward.norm();
    SnapTarget plain = closest(v, p, length > 0.0 ? Vec3(outward / length) : Vec3::Zero());
    const Vec3 off = p - plain.point;
    const double distance = off.norm();
    if (distance > 1e-4 * size) plain.axis = off / distance;
    if (count < 2) return plain;

    Eigen::Matrix3d quadric = Eigen::Matrix3d::Zero();
    Vec3 side = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3& n = planes[i].normal;
        quadric += planes[i].weight / weights * n * n.transpose();
        side += planes[i].weight / weights * n.dot(planes[i].point - plain.point) * n;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(quadric);
    const Vec3& values = solver.eigenvalues();  // ascending
    if (values[1] < edge_eigenvalue) return plain;
    SnapTarget target = plain;
    target.kind = values[0] < corner_eigenvalue ? SnapTarget::Kind::edge : SnapTarget::Kind::corner;
    for (Eigen::Index i = target.kind == SnapTarget::Kind::edge ? 1 : 0; i < 3; ++i) {
        const Vec3 direction = solver.eigenvectors().col(i);
        target.point += direction.dot(side) / values[i] * direction;
    }
    target.axis = solver.eigenvectors().col(0);
    const Vec3 on_surface = closest(v, target.point, Vec3::Zero()).point;
    if ((on_surface - target.point).norm() > on_surface_share * size ||
        (on_surface - p).norm() > farthest_share * size)
        return plain;
    target.point = on_surface;
    return target;
}

void SnapTargets::aim(const HexMesh& mesh, std::vector<SnapTarget>& targets) const {
    const auto& vertices = boundary_.boundary_vertices;
    parallel_for(
        vertices.size(), [&](std::size_t i) { targets[vertices[i].index()] = target_of(mesh, vertices[i]); },
        32);
    // Three vertices of a quad in a row on one edge: the outer two give it up.
    std::vector<char> demoted(mesh.vertex_count(), 0);
    for (const auto& quad : boundary_.vertices) {
        for (std::size_t k = 0; k < 4; ++k) {
            const std::array<VertexId, 3> run = {quad[k], quad[(k + 1) % 4], quad[(k + 2) % 4]};
            const auto& a = targets[run[0].index()];
            const auto& b = targets[run[1].index()];
            const auto& c = targets[run[2].index()];
            if (a.kind == SnapTarget::Kind::smooth || b.kind == SnapTarget::Kind::smooth ||
                c.kind == SnapTarget::Kind::smooth)
                continue;
            const Vec3 to_a = a.point - b.point;
            const Vec3 to_c = c.point - b.point;
            if (to_a.dot(to_c) > straightest * to_a.norm() * to_c.norm()) continue;
            for (const VertexId v : {run[0], run[2]})
                if (targets[v.index()].kind == SnapTarget::Kind::edge) demoted[v.index()] = 1;
        }
    }
    parallel_for(
        vertices.size(),
        [&](std::size_t i) {
            const VertexId v = vertices[i];
            if (!demoted[v.index()]) return;
            Vec3 outward = Vec3::Zero();
            for (const QuadId q : boundary_.vertex_quads[v.index()]) {
                const auto& quad = boundary_.vertices[q.index()];
                outward += (mesh.position(quad[2]) - mesh.position(quad[0]))
                               .cross(mesh.position(quad[3]) - mesh.position(quad[1]));
            }
            const double length = outward.norm();
            targets[v.index()] =
                closest(v, mesh.position(v), length > 0.0 ? Vec3(outward / length) : Vec3::Zero());
        },
        32);
}

}  // namespace hex::improving
