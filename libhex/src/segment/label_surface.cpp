#include "segment/label_surface.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <cmath>

namespace hex {
namespace {

/// The points turned and scaled to a whole area of 1. A power of two comes first, which is exact: neither
/// tiny nor huge parts leave the range of doubles, and their size leaves no trace in the bits.
void scale_points(const TriangleMesh& mesh, const Eigen::Matrix3d& rotation, LabelSurface& surface) {
    auto& points = surface.points;
    points.resize(mesh.n_vertices());
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 upper = -lower;
    for (const auto& corners : surface.arrays.corners) {
        for (const int v : corners) {
            const Vec3 p = to_eigen(mesh.point(mesh.vertex_handle(static_cast<unsigned>(v))));
            lower = lower.cwiseMin(p);
            upper = upper.cwiseMax(p);
        }
    }
    const double extent = (upper - lower).maxCoeff();
    const int exponent = extent > 0.0 ? std::ilogb(extent) : 0;
    for (std::size_t v = 0; v < points.size(); ++v) {
        Vec3 p = to_eigen(mesh.point(mesh.vertex_handle(static_cast<unsigned>(v)))) - lower;
        for (int k = 0; k < 3; ++k) p[k] = std::ldexp(p[k], -exponent);
        points[v] = rotation * p;
    }
    surface.areas.resize(surface.size());
    double total = 0.0;
    for (std::size_t t = 0; t < surface.size(); ++t) {
        const auto& c = surface.arrays.corners[t];
        const Vec3& p = points[static_cast<std::size_t>(c[0])];
        const Vec3 u = points[static_cast<std::size_t>(c[1])] - p;
        const Vec3 v = points[static_cast<std::size_t>(c[2])] - p;
        surface.areas[t] = 0.5 * u.cross(v).norm();
        total += surface.areas[t];
    }
    if (!(total > 0.0)) total = 1.0;
    for (double& area : surface.areas) area /= total;
    for (Vec3& p : points) p /= std::sqrt(total);
    surface.flat = 1e-9 * std::ldexp(extent, -exponent) / std::sqrt(total);
}

/// Triangles of one polygon follow each other.
void collect_polygons(const TriangleMesh& mesh, LabelSurface& surface) {
    const int count = static_cast<int>(surface.size());
    surface.polygons.resize(surface.size());
    const auto source = [&](int t) { return mesh.data(mesh.face_handle(static_cast<unsigned>(t))).source; };
    for (int begin = 0, end = 0; begin < count; begin = end) {
        end = begin + 1;
        while (end < count && source(begin) >= 0 && source(end) == source(begin)) ++end;
        for (int t = begin; t < end; ++t) surface.polygons[static_cast<std::size_t>(t)] = {begin, end};
    }
}

void collect_edges(LabelSurface& surface) {
    constexpr double width = 0.25;  // of the bell curve over the cosine between the normals (Livesu et al.)
    constexpr double least = 0.05;
    constexpr double inside_a_polygon = 1e3;
    const TriangleArrays& arrays = surface.arrays;
    surface.edges_of_triangle.assign(arrays.size(), {-1, -1, -1});
    for (std::size_t t = 0; t < arrays.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const int n = arrays.neighbours[t][k];
            if (surface.edges_of_triangle[t][k] >= 0 || n < 0) continue;
            LabelEdge edge;
            edge.vertices = {arrays.corners[t][k], arrays.corners[t][(k + 1) % 3]};
            edge.triangles = {static_cast<int>(t), n};
            edge.length = (surface.points[static_cast<std::size_t>(edge.vertices[0])] -
                           surface.points[static_cast<std::size_t>(edge.vertices[1])])
                              .norm();
            const double bend =
                (1.0 - surface.normals[t].dot(surface.normals[static_cast<std::size_t>(n)])) / width;
            edge.weight = edge.length * std::max(least, std::exp(-0.5 * bend * bend));
            if (surface.polygons[t] == surface.polygons[static_cast<std::size_t>(n)])
                edge.weight += inside_a_polygon;
            const int index = static_cast<int>(surface.edges.size());
            surface.edges_of_triangle[t][k] = index;
            const auto& other = arrays.corners[static_cast<std::size_t>(n)];
            for (std::size_t j = 0; j < 3; ++j) {
                if (other[j] == edge.vertices[1] && other[(j + 1) % 3] == edge.vertices[0])
                    surface.edges_of_triangle[static_cast<std::size_t>(n)][j] = index;
            }
            surface.edges.push_back(edge);
        }
    }
}

}  // namespace

double label_cost(double cosine) {
    return (1.0 - cosine) + std::max(0.0, 0.3 - cosine) + 30.0 * std::max(0.0, -0.1 - cosine);
}

LabelSurface label_surface(const TriangleMesh& mesh, const Eigen::Matrix3d& rotation) {
    LabelSurface surface;
    surface.arrays = triangle_arrays(mesh);
    surface.normals = unit_normals(mesh, surface.arrays);
    for (Vec3& n : surface.normals) n = rotation * n;
    scale_points(mesh, rotation, surface);
    collect_polygons(mesh, surface);
    collect_edges(surface);
    surface.costs.resize(surface.size());
    for (std::size_t t = 0; t < surface.size(); ++t) {
        for (int label = 0; label < 6; ++label)
            surface.costs[t][static_cast<std::size_t>(label)] =
                surface.areas[t] * label_cost(surface.cosine(static_cast<int>(t), label));
    }
    return surface;
}

}  // namespace hex
