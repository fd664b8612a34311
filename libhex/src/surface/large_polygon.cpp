#include "surface/large_polygon.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <utility>

namespace hex::surface {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel,
                                                CGAL::Triangulation_face_base_with_info_2<bool, Kernel>>;
/// Sides that cross each other are told by an exception.
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel,
                                               CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

/// Twice the vector area (Newell).
Vec3 area_vector(std::span<const Vec3> points) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += (points[i] - points[0]).cross(points[(i + 1) % points.size()] - points[0]);
    return sum;
}

/// Marks (in their info) the faces that can be reached from outside without crossing a side.
void mark_outside(Triangulation& triangulation) {
    for (const auto face : triangulation.all_face_handles()) face->info() = false;
    std::vector<Triangulation::Face_handle> front = {triangulation.infinite_face()};
    front.front()->info() = true;
    while (!front.empty()) {
        const auto face = front.back();
        front.pop_back();
        for (int i = 0; i < 3; ++i) {
            const auto neighbour = face->neighbor(i);
            if (neighbour->info() || triangulation.is_constrained({face, i})) continue;
            neighbour->info() = true;
            front.push_back(neighbour);
        }
    }
}

}  // namespace

std::vector<std::array<std::size_t, 3>> triangles_of_large_polygon(std::span<const Vec3> points) {
    const Vec3 normal = area_vector(points);
    Eigen::Index axis = 0;
    if (!(normal.cwiseAbs().maxCoeff(&axis) > 0.0)) return {};
    Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0.0) std::swap(u, v);

    std::vector<std::pair<Kernel::Point_2, std::size_t>> projected;
    projected.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        projected.emplace_back(Kernel::Point_2(points[i][u], points[i][v]), i);
    Triangulation triangulation;
    triangulation.insert(projected.begin(), projected.end());
    std::vector<Triangulation::Vertex_handle> corners(points.size());
    for (const auto vertex : triangulation.finite_vertex_handles()) corners[vertex->info()] = vertex;
    if (triangulation.number_of_vertices() != points.size() || triangulation.dimension() != 2) return {};
    try {
        for (std::size_t i = 0; i < corners.size(); ++i)
            triangulation.insert_constraint(corners[i], corners[(i + 1) % corners.size()]);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
        return {};
    }

    mark_outside(triangulation);
    std::vector<std::array<std::size_t, 3>> triangles;
    for (const auto face : triangulation.finite_face_handles()) {
        if (face->info()) continue;
        triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    // A polygon that touches itself encloses another number of triangles.
    if (triangles.size() + 2 != points.size()) triangles.clear();
    return triangles;
}

}  // namespace hex::surface
