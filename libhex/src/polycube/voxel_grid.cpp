#include "polycube/voxel_grid.h"

#include <hex/base/parallel.h>
#include <hex/surface/polygon_soup.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>

namespace hex::voxels {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Planes closer to each other than this share of the cell size are one.
constexpr double closest_planes = 0.3;
/// A flat face has a plane of its own when its area is at least this share of the square of the cell size.
constexpr double least_area = 0.1;
/// Triangles are perpendicular to an axis when they extend along it by less than this share of the diagonal.
constexpr double flat = 1e-6;

std::array<Vec3, 3> corners_of(const TriangleMesh& surface, TriangleMesh::FaceHandle f) {
    std::array<Vec3, 3> p;
    std::size_t i = 0;
    for (const auto v : surface.fv_range(f)) p[i++] = to_eigen(surface.point(v));
    return p;
}

struct FlatFace {
    double at;
    double area;
};

/// Where triangles are perpendicular to each axis, largest area first.
std::array<std::vector<FlatFace>, 3> flat_faces(const TriangleMesh& surface, double diagonal) {
    std::array<std::vector<FlatFace>, 3> faces;
    for (const auto f : surface.faces()) {
        const auto p = corners_of(surface, f);
        const double area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
        if (!(area > 0.0)) continue;
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
            // Small triangles extend little along any axis: their normal must agree as well.
            const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]) / (2.0 * area);
            if (high - low <= flat * diagonal && std::abs(normal[axis]) > 0.999)
                faces[static_cast<std::size_t>(axis)].push_back({low, area});
        }
    }
    for (auto& list : faces) {
        std::sort(list.begin(), list.end(), [](const FlatFace& a, const FlatFace& b) {
            return a.at != b.at ? a.at < b.at : a.area > b.area;
        });
        std::vector<FlatFace> merged;
        for (const FlatFace& face : list) {
            if (!merged.empty() && face.at - merged.back().at <= 10.0 * flat * diagonal)
                merged.back().area += face.area;
            else
                merged.push_back(face);
        }
        std::sort(merged.begin(), merged.end(), [](const FlatFace& a, const FlatFace& b) {
            return a.area != b.area ? a.area > b.area : a.at < b.at;
        });
        list = std::move(merged);
    }
    return faces;
}

/// On which side of the directed line from a to b a point is, +1 or -1; one on the line is moved by (e, e^2)
/// with an infinitely small e. 0 only if a == b.
int side(const Vec2& a, const Vec2& b, const Vec2& p) {
    const auto orientation = CGAL::orientation(Kernel::Point_2(a.x(), a.y()), Kernel::Point_2(b.x(), b.y()),
                                               Kernel::Point_2(p.x(), p.y()));
    if (orientation != CGAL::COLLINEAR) return orientation == CGAL::LEFT_TURN ? 1 : -1;
    if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
    if (a.x() != b.x()) return b.x() > a.x() ? 1 : -1;
    return 0;
}

}  // namespace

Cell Grid::find(const Vec3& p) const {
    Cell c;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto above =
            std::upper_bound(planes[axis].begin(), planes[axis].end(), p[static_cast<Eigen::Index>(axis)]);
        c[axis] = std::clamp(static_cast<int>(above - planes[axis].begin()) - 1, 0, count(axis) - 1);
    }
    return c;
}

Grid make_grid(const TriangleMesh& surface, double size) {
    const BoundingBox box = bounding_box(surface);
    const auto faces = flat_faces(surface, box.diagonal());
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        std::vector<double> fixed = {box.lower[a], box.upper[a]};
        for (const FlatFace& face : faces[axis]) {
            if (face.area < least_area * size * size) break;
            const bool free = std::all_of(fixed.begin(), fixed.end(), [&](double at) {
                return std::abs(at - face.at) >= closest_planes * size;
            });
            if (!free) continue;
            fixed.push_back(face.at);
            ++grid.aligned[axis];
        }
        std::sort(fixed.begin(), fixed.end());
        auto& planes = grid.planes[axis];
        for (std::size_t i = 0; i + 1 < fixed.size(); ++i) {
            const double span = fixed[i + 1] - fixed[i];
            const int pieces = std::max(1, static_cast<int>(std::lround(span / size)));
            for (int k = 0; k < pieces; ++k) planes.push_back(fixed[i] + span * k / pieces);
        }
        planes.push_back(fixed.back());
        planes.insert(planes.begin(), planes.front() - std::min(size, planes[1] - planes[0]));
        planes.push_back(planes.back() + std::min(size, planes.back() - planes[planes.size() - 2]));
    }
    return grid;
}

std::optional<double> crossing(const std::array<Vec3, 3>& p, const Vec2& line) {
    const std::array<Vec2, 3> q = {Vec2(p[0].y(), p[0].z()), Vec2(p[1].y(), p[1].z()),
                                   Vec2(p[2].y(), p[2].z())};
    const int first = side(q[0], q[1], line);
    if (first == 0 || side(q[1], q[2], line) != first || side(q[2], q[0], line) != first) return {};
    const auto [low, high] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
    if (normal.x() == 0.0) return 0.5 * (low + high);
    const double x =
        p[0].x() - (normal.y() * (line.x() - p[0].y()) + normal.z() * (line.y() - p[0].z())) / normal.x();
    return std::clamp(x, low, high);
}

std::vector<std::uint8_t> samples_inside(const Grid& grid, const TriangleMesh& surface) {
    std::array<std::vector<double>, 3> samples;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i + 1 < grid.planes[axis].size(); ++i) {
            const double low = grid.planes[axis][i];
            const double span = grid.planes[axis][i + 1] - low;
            for (int k = 0; k < samples_per_axis; ++k)
                samples[axis].push_back(low + span * (2 * k + 1) / (2 * samples_per_axis));
        }
    }
    // Where each line along x through a sample in y and z meets the surface.
    const std::size_t columns = samples[1].size();
    std::vector<std::vector<double>> crossings(columns * samples[2].size());
    const auto range = [&](std::size_t axis, double low, double high) {
        const auto& s = samples[axis];
        return std::pair(std::lower_bound(s.begin(), s.end(), low) - s.begin(),
                         std::upper_bound(s.begin(), s.end(), high) - s.begin());
    };
    for (const auto f : surface.faces()) {
        const auto p = corners_of(surface, f);
        const auto [low_y, high_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
        const auto [low_z, high_z] = std::minmax({p[0].z(), p[1].z(), p[2].z()});
        const auto ys = range(1, low_y, high_y);
        const auto zs = range(2, low_z, high_z);
        for (auto z = zs.first; z < zs.second; ++z) {
            for (auto y = ys.first; y < ys.second; ++y) {
                const auto x = crossing(p, Vec2(samples[1][static_cast<std::size_t>(y)],
                                                samples[2][static_cast<std::size_t>(z)]));
                if (!x) continue;
                crossings[static_cast<std::size_t>(y) + columns * static_cast<std::size_t>(z)].push_back(*x);
            }
        }
    }
    std::vector<std::uint8_t> inside(grid.cell_count(), 0);
    const int ny = grid.count(1);
    const auto& xs = samples[0];
    parallel_for(
        static_cast<std::size_t>(ny) * static_cast<std::size_t>(grid.count(2)),
        [&](std::size_t row) {
            const std::size_t j = row % static_cast<std::size_t>(ny);
            const std::size_t k = row / static_cast<std::size_t>(ny);
            std::uint8_t* cells = inside.data() + row * static_cast<std::size_t>(grid.count(0));
            constexpr auto per = static_cast<std::size_t>(samples_per_axis);
            for (std::size_t dz = 0; dz < per; ++dz) {
                for (std::size_t dy = 0; dy < per; ++dy) {
                    auto& line = crossings[per * j + dy + columns * (per * k + dz)];
                    std::sort(line.begin(), line.end());
                    for (std::size_t c = 0; c + 1 < line.size(); c += 2) {
                        auto s = static_cast<std::size_t>(std::upper_bound(xs.begin(), xs.end(), line[c]) -
                                                          xs.begin());
                        for (; s < xs.size() && xs[s] < line[c + 1]; ++s) ++cells[s / per];
                    }
                }
            }
        },
        16);
    return inside;
}

}  // namespace hex::voxels
