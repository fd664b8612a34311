#include "part_targets.h"

#include <algorithm>
#include <cmath>

namespace spline {

using hex::Vec3;

namespace {

/// Edges of the part with a smaller cosine between normals are sharp; the paper's threshold.
constexpr double sharp_cosine = 0.8;
constexpr std::size_t most_samples = 60000;

SquareMetric off_plane(const Vec3& normal) {
    return {normal, Part::sliding, 1.0 - Part::sliding};
}
SquareMetric off_line(const Vec3& tangent) {
    return {tangent, 1.0, Part::sliding - 1.0};
}

std::vector<Part::Sample> sample(const hex::TriangleMesh& mesh) {
    std::vector<Part::Sample> samples;
    std::vector<double> around(mesh.n_vertices(), 0.0);
    std::vector<Part::Sample> centres;
    for (const auto f : mesh.faces()) {
        std::array<Vec3, 3> corners;
        auto corner = corners.begin();
        for (const auto v : mesh.fv_range(f)) *corner++ = hex::to_eigen(mesh.point(v));
        const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
        for (const auto v : mesh.fv_range(f)) around[static_cast<std::size_t>(v.idx())] += area / 6.0;
        centres.push_back({(corners[0] + corners[1] + corners[2]) / 3.0, 0.5 * area});
    }
    for (const auto v : mesh.vertices()) {
        if (!mesh.is_isolated(v))
            samples.push_back({hex::to_eigen(mesh.point(v)), around[static_cast<std::size_t>(v.idx())]});
    }
    samples.insert(samples.end(), centres.begin(), centres.end());
    if (samples.size() <= most_samples) return samples;
    std::vector<Part::Sample> some;
    for (std::size_t i = 0; i < most_samples; ++i) some.push_back(samples[i * samples.size() / most_samples]);
    return some;
}

}  // namespace

Part::Part(const hex::TriangleMesh& mesh)
    : search_(mesh), sharp_sides_(mesh.n_faces(), 0), samples_(sample(mesh)) {
    const auto normal = [&](OpenMesh::FaceHandle f) {
        const auto& [a, b, c] = search_.triangle(static_cast<std::uint32_t>(f.idx()));
        return Vec3((b - a).cross(c - a).stableNormalized());
    };
    for (const auto f : mesh.faces()) {
        std::size_t side = 0;
        // The first half-edge ends at the first vertex of fv_range: side k starts where half-edge k ends.
        for (const auto vertex : mesh.fv_range(f)) {
            const auto& triangle = search_.triangle(static_cast<std::uint32_t>(f.idx()));
            for (const auto h : mesh.fh_range(f)) {
                if (mesh.from_vertex_handle(h) != vertex) continue;
                const auto other = mesh.opposite_face_handle(h);
                if (!other.is_valid() || normal(f).dot(normal(other)) >= sharp_cosine) continue;
                sharp_sides_[static_cast<std::size_t>(f.idx())] |= static_cast<std::uint8_t>(1U << side);
                if (f.idx() < other.idx()) sharp_edges_.push_back({triangle[side], triangle[(side + 1) % 3]});
            }
            ++side;
        }
    }
    sharp_search_.emplace(sharp_edges_);
}

PartTarget Part::target(const Vec3& p, const hex::ClosestPoint::Answer& foot) const {
    const auto& triangle = search_.triangle(foot.triangle);
    const auto& [a, b, c] = triangle;
    const Vec3 across = (b - a).cross(c - a);
    const Vec3 normal = across.normalized();
    const double area = across.squaredNorm();
    const std::array<double, 3> share = {(c - b).cross(foot.point - b).dot(across) / area,
                                         (a - c).cross(foot.point - c).dot(across) / area,
                                         (b - a).cross(foot.point - a).dot(across) / area};
    constexpr double on_side = 1e-7;
    std::uint8_t sides = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (share[(k + 2) % 3] < on_side) sides |= static_cast<std::uint8_t>(1U << k);
    }
    const std::uint8_t sharp = sides & sharp_sides_[foot.triangle];
    if (sharp != 0) {
        // At a vertex of the triangle a sharp edge may end or turn.
        if ((sides & (sides - 1)) != 0) return {foot.point, {Vec3::Zero(), 1.0, 0.0}};
        const std::size_t k = sharp == 1 ? 0 : sharp == 2 ? 1 : 2;
        return {foot.point, off_line((triangle[(k + 1) % 3] - triangle[k]).normalized())};
    }
    const Vec3 away = p - foot.point;
    const double distance = away.norm();
    // On an edge or a vertex the distance grows in the direction from the foot to the point.
    if (sides != 0 && std::abs(away.dot(normal)) < 0.98 * distance)
        return {foot.point, off_plane(away / distance)};
    return {foot.point, off_plane(normal)};
}

std::optional<PartTarget> Part::crease_target(const Vec3& p, const Vec3& tangent, double radius) const {
    const auto found = (*sharp_search_)(p, radius);
    if (!found) return {};
    const auto& [from, to] = sharp_edges_[found->segment];
    const Vec3 along = (to - from).normalized();
    constexpr double runs_along = 0.8;
    if (std::abs(along.dot(tangent)) < runs_along) return {};
    return PartTarget{found->point, off_line(along)};
}

}  // namespace spline
