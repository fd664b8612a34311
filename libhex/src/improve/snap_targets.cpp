#include "improve/snap_targets.h"

#include "improve/search_set.h"
#include "improve/surface_curves.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>

#include <array>
#include <cmath>

namespace hex::improving {
namespace {

/// A triangle faces the same way as the boundary when the cosine between their normals is above this.
constexpr double same_way = 0.2;
/// Triangles of a direction are those whose normals have a larger cosine with it. No vector is farther than
/// 54.7 degrees from the nearest of the fourteen.
constexpr double of_direction = 0.25;
/// A point that faces the same way is not taken when it is so many times farther than the closest one and
/// than the size at the vertex allows.
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

struct Bin {
    std::vector<std::uint32_t> triangles;
    std::unique_ptr<TriangleSearch> search;
};

}  // namespace

struct SnapTargets::State {
    GuideSurface surface;
    std::array<Vec3, 14> directions = make_directions();
    Bin all;
    std::array<Bin, 14> bins;

    void fill(Bin& bin) const {
        if (bin.triangles.empty()) return;
        std::vector<SearchKernel::Triangle_3> items;
        for (const std::uint32_t t : bin.triangles) {
            const auto& v = surface.triangles[t];
            items.emplace_back(to_search_point(surface.points[v[0]]), to_search_point(surface.points[v[1]]),
                               to_search_point(surface.points[v[2]]));
        }
        bin.search = std::make_unique<TriangleSearch>(std::move(items));
    }
};

SnapTargets::SnapTargets(const TriangleMesh& surface) : state_(std::make_unique<State>()) {
    state_->surface = make_guide_surface(surface);
    const auto count = static_cast<std::uint32_t>(state_->surface.triangles.size());
    if (count == 0) throw Error(ErrorKind::bad_input, "the surface to stay on has no triangle with an area");
    for (std::uint32_t t = 0; t < count; ++t) {
        state_->all.triangles.push_back(t);
        for (std::size_t d = 0; d < state_->bins.size(); ++d)
            if (state_->surface.normals[t].dot(state_->directions[d]) > of_direction)
                state_->bins[d].triangles.push_back(t);
    }
    state_->fill(state_->all);
    parallel_for(
        state_->bins.size(), [&](std::size_t d) { state_->fill(state_->bins[d]); }, 1);
}

SnapTargets::~SnapTargets() = default;

SnapTarget SnapTargets::closest(const Vec3& p, const Vec3& normal) const {
    const auto target = [&](const Bin& bin) {
        const auto found = bin.search->closest(p, 0);
        return SnapTarget{found.point, state_->surface.normals[bin.triangles[found.item]], false};
    };
    const SnapTarget nearest = target(state_->all);
    if (normal.isZero(0.0) || nearest.axis.dot(normal) > same_way) return nearest;
    std::size_t direction = 0;
    for (std::size_t d = 1; d < state_->bins.size(); ++d)
        if (state_->directions[d].dot(normal) > state_->directions[direction].dot(normal)) direction = d;
    if (state_->bins[direction].triangles.empty()) return nearest;
    const SnapTarget facing = target(state_->bins[direction]);
    const double far = (facing.point - p).norm();
    const double near = (nearest.point - p).norm();
    return far <= much_farther * near ? facing : nearest;
}

std::vector<Vec3> boundary_normals(const HexMesh& mesh, const BoundaryQuads& boundary) {
    std::vector<Vec3> normals(mesh.vertex_count(), Vec3::Zero());
    parallel_for(boundary.boundary_vertices.size(), [&](std::size_t i) {
        const VertexId v = boundary.boundary_vertices[i];
        Vec3 sum = Vec3::Zero();
        for (const QuadId q : boundary.vertex_quads[v.index()]) {
            const auto& quad = boundary.vertices[q.index()];
            sum += (mesh.position(quad[2]) - mesh.position(quad[0]))
                       .cross(mesh.position(quad[3]) - mesh.position(quad[1]));
        }
        const double length = sum.norm();
        if (length > 0.0) normals[v.index()] = sum / length;
    });
    return normals;
}

}  // namespace hex::improving
