#include "boundary_samples.h"

#include "face_points.h"
#include "spline_rows.h"

#include <algorithm>

namespace spline {

using hex::Vec3;

std::vector<BoundaryFace> boundary_faces(const BezierSpline& spline) {
    std::vector<BoundaryFace> faces;
    for (std::size_t e = 0; e < spline.boundary_patch.size(); ++e) {
        for (std::uint8_t f = 0; f < 6; ++f) {
            if (spline.boundary_patch[e][f] >= 0) faces.push_back({static_cast<std::uint32_t>(e), f});
        }
    }
    return faces;
}

SparseRows boundary_rows(const BezierSpline& spline, const std::vector<BoundaryFace>& faces,
                         const std::vector<BoundaryPlace>& places) {
    return build_rows<RealRowSum>(places.size(), [&](std::size_t i, RealRowSum& sum) {
        const BoundaryFace face = faces[places[i].face];
        const auto points = face_points(face.face);
        const auto s = bernstein(places[i].st[0]), t = bernstein(places[i].st[1]);
        for (std::size_t p = 0; p < 16; ++p) {
            const double weight = s[p % 4] * t[p / 4];
            if (weight == 0.0) continue;
            const SparseRow row = spline.rows[spline.elements[face.element][points[p]]];
            for (std::size_t k = 0; k < row.size(); ++k) sum.add(row.columns[k], weight * row.values[k]);
        }
    });
}

std::vector<BoundaryPlace> boundary_grid(std::size_t faces, int n) {
    std::vector<BoundaryPlace> places;
    places.reserve(faces * static_cast<std::size_t>(n * n));
    for (std::size_t f = 0; f < faces; ++f)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                places.push_back({static_cast<std::uint32_t>(f),
                                  {static_cast<double>(i) / (n - 1), static_cast<double>(j) / (n - 1)}});
    return places;
}

std::vector<std::array<BoundaryPlace, 2>> boundary_creases(const BezierSpline& spline,
                                                           const std::vector<BoundaryFace>& faces) {
    static constexpr std::array<std::array<std::size_t, 2>, 4> sides = {{{0, 3}, {3, 15}, {15, 12}, {12, 0}}};
    struct Side {
        std::array<std::uint32_t, 2> ends;  ///< Bezier points, ascending
        std::uint32_t face;
        std::uint8_t side;
    };
    std::vector<Side> all;
    all.reserve(4 * faces.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const auto points = face_points(faces[f].face);
        const auto& element = spline.elements[faces[f].element];
        for (std::uint8_t k = 0; k < 4; ++k) {
            const std::uint32_t a = element[points[sides[k][0]]], b = element[points[sides[k][1]]];
            all.push_back({{std::min(a, b), std::max(a, b)}, f, k});
        }
    }
    std::sort(all.begin(), all.end(), [](const Side& a, const Side& b) {
        return a.ends != b.ends ? a.ends < b.ends : a.face < b.face;
    });
    const auto patch = [&](const Side& side) {
        return spline.boundary_patch[faces[side.face].element][faces[side.face].face];
    };
    const auto place = [](const Side& side, std::size_t end) {
        const std::size_t p = sides[side.side][end];
        return BoundaryPlace{side.face, {p % 4 == 3 ? 1.0 : 0.0, p / 4 == 3 ? 1.0 : 0.0}};
    };
    std::vector<std::array<BoundaryPlace, 2>> creases;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        if (all[i].ends == all[i + 1].ends && patch(all[i]) != patch(all[i + 1]))
            creases.push_back({place(all[i], 0), place(all[i], 1)});
    }
    return creases;
}

std::vector<std::array<std::uint32_t, 3>> SampledBoundary::triangulate(std::size_t faces, int n) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    const auto side = static_cast<std::uint32_t>(n);
    for (std::uint32_t f = 0; f < faces; ++f)
        for (std::uint32_t j = 0; j + 1 < side; ++j)
            for (std::uint32_t i = 0; i + 1 < side; ++i) {
                const std::uint32_t a = f * side * side + j * side + i;
                triangles.push_back({a, a + 1, a + side + 1});
                triangles.push_back({a, a + side + 1, a + side});
            }
    return triangles;
}

namespace {

std::vector<std::array<Vec3, 3>> corners_of(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                            std::span<const Vec3> points) {
    std::vector<std::array<Vec3, 3>> corners;
    corners.reserve(triangles.size());
    for (const auto& [a, b, c] : triangles) corners.push_back({points[a], points[b], points[c]});
    return corners;
}

}  // namespace

SampledBoundary::SampledBoundary(std::vector<BoundaryPlace> grid, int n, std::span<const Vec3> points)
    : grid_(std::move(grid)),
      triangles_(triangulate(grid_.size() / static_cast<std::size_t>(n * n), n)),
      search_(corners_of(triangles_, points)) {}

SampledBoundary::Answer SampledBoundary::closest(const Vec3& p, std::uint32_t hint) const {
    const auto answer = search_(p, hint);
    const Vec3& point = answer.point;
    const auto& [a, b, c] = search_.triangle(answer.triangle);
    // Barycentric coordinates of the answer, by areas.
    const Vec3 normal = (b - a).cross(c - a);
    const double area = normal.squaredNorm();
    const double wb = (point - a).cross(c - a).dot(normal) / area;
    const double wc = (b - a).cross(point - a).dot(normal) / area;
    const auto& corners = triangles_[answer.triangle];
    BoundaryPlace place = grid_[corners[0]];
    for (std::size_t x = 0; x < 2; ++x)
        place.st[x] = std::clamp((1.0 - wb - wc) * grid_[corners[0]].st[x] + wb * grid_[corners[1]].st[x] +
                                     wc * grid_[corners[2]].st[x],
                                 0.0, 1.0);
    return {place, point, answer.triangle};
}

}  // namespace spline
