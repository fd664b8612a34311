#include "surface/search_set.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/quality/surface_distance.h>
#include <hex/surface/polygon_soup.h>
#include <hex/volume/topology.h>

#include <algorithm>

namespace hex {
namespace {

/// Distances of points from triangles.
std::vector<double> distances(const std::vector<Vec3>& points, const TriangleSearch& triangles,
                              const Context& context) {
    std::vector<double> result(points.size());
    // Within a run each search starts from the answer of the one before; runs are the same for any number of
    // threads.
    constexpr std::size_t run = 256, runs_between_looks = 64;
    const std::size_t runs = (points.size() + run - 1) / run;
    for (std::size_t first = 0; first < runs; first += runs_between_looks) {
        context.check_cancelled();
        context.progress("distance", static_cast<double>(first) / static_cast<double>(runs));
        parallel_for(
            std::min(runs_between_looks, runs - first),
            [&](std::size_t r) {
                std::uint32_t hint = 0;
                const std::size_t start = (first + r) * run;
                for (std::size_t i = start; i < std::min(start + run, points.size()); ++i) {
                    const auto answer = triangles.closest(points[i], hint);
                    hint = answer.item;
                    result[i] = (answer.point - points[i]).norm();
                }
            },
            1);
    }
    return result;
}

double mean(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

SearchTriangle triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    return {a, b, c};
}

/// Flat to a point or a line: nothing that its neighbours do not cover, and no plane to project on.
bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b - a).cross(c - a).squaredNorm() > 0.0;
}

}  // namespace

SurfaceDistance surface_distance(const HexMesh& mesh, const TriangleMesh& surface, const Context& context) {
    std::vector<SearchTriangle> surface_triangles, boundary_triangles;
    std::vector<Vec3> surface_points, boundary_points;
    const auto add = [](std::vector<SearchTriangle>& list, const Vec3& a, const Vec3& b, const Vec3& c) {
        if (has_area(a, b, c)) list.push_back(triangle(a, b, c));
    };
    for (const auto v : surface.vertices())
        if (!surface.is_isolated(v)) surface_points.push_back(to_eigen(surface.point(v)));
    for (const auto f : surface.faces()) {
        std::array<Vec3, 3> p;
        auto corner = p.begin();
        for (const auto v : surface.fv_range(f)) *corner++ = to_eigen(surface.point(v));
        add(surface_triangles, p[0], p[1], p[2]);
        surface_points.push_back((p[0] + p[1] + p[2]) / 3.0);
    }
    const BoundaryQuads quads = boundary_quads(mesh);
    for (const VertexId v : quads.boundary_vertices) boundary_points.push_back(mesh.position(v));
    for (const auto& quad : quads.vertices) {
        std::array<Vec3, 4> p;
        for (std::size_t i = 0; i < 4; ++i) p[i] = mesh.position(quad[i]);
        add(boundary_triangles, p[0], p[1], p[2]);
        add(boundary_triangles, p[0], p[2], p[3]);
        boundary_points.push_back((p[0] + p[1] + p[2] + p[3]) / 4.0);
    }
    if (surface_triangles.empty())
        throw Error(ErrorKind::bad_input, "the surface has no triangle with an area");
    if (boundary_triangles.empty())
        throw Error(ErrorKind::bad_input, "the boundary of the mesh has no face with an area");

    return with_threads(context, [&] {
        SurfaceDistance result;
        result.diagonal = bounding_box(surface).diagonal();
        const std::vector<double> to =
            distances(boundary_points, TriangleSearch(std::move(surface_triangles)), context);
        const std::vector<double> from =
            distances(surface_points, TriangleSearch(std::move(boundary_triangles)), context);
        const std::size_t vertices = quads.boundary_vertices.size();
        const auto farthest =
            std::max_element(to.begin(), to.begin() + static_cast<std::ptrdiff_t>(vertices));
        result.vertex_max = *farthest;
        result.farthest_vertex = quads.boundary_vertices[static_cast<std::size_t>(farthest - to.begin())];
        result.vertex_mean = mean(std::span(to).first(vertices));
        result.to_surface_max = *std::max_element(to.begin(), to.end());
        result.to_surface_mean = mean(to);
        result.from_surface_max = *std::max_element(from.begin(), from.end());
        result.from_surface_mean = mean(from);
        return result;
    });
}

}  // namespace hex
