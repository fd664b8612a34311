/// \file label_surface.h
/// What the automatic labelling knows of a surface: flat arrays, and what each label costs on each triangle.
#pragma once

#include "segment/triangle_rings.h"

#include <hex/base/linear_algebra.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <vector>

namespace hex {

/// An edge of a closed surface. Lengths are in units of the square root of the whole area.
struct LabelEdge {
    std::array<int, 2> vertices{};   ///< the left triangle's winding runs from the first to the second
    std::array<int, 2> triangles{};  ///< left, right
    double length = 0.0;
    /// What a label boundary along it costs: its length, down to a twentieth of it on a sharp crease.
    double weight = 0.0;
};

struct LabelSurface {
    TriangleArrays arrays;
    std::vector<Vec3> points;   ///< scaled to a whole area of 1, turned by the rotation
    std::vector<Vec3> normals;  ///< unit, turned by the rotation
    std::vector<double> areas;  ///< their sum is 1
    std::vector<LabelEdge> edges;
    std::vector<std::array<int, 3>> edges_of_triangle;  ///< in the order of arrays.neighbours
    /// Infidelity: area times (1 - cosine to the label's axis), more below a cosine of 0.3, and much more
    /// below -0.1: a label against the normal.
    std::vector<std::array<double, 6>> costs;
    /// Where the triangles of the same polygon of the input begin and end: they take one label, or the labels
    /// of the polygons would depend on how those were triangulated.
    std::vector<std::array<int, 2>> polygons;
    double flat = 0.0;  ///< coordinates that differ by less count as equal

    std::size_t size() const { return arrays.size(); }
    double cosine(int triangle, int label) const {
        const double c = normals[static_cast<std::size_t>(triangle)][label / 2];
        return label % 2 == 0 ? c : -c;
    }
};

/// The cost of a label whose axis has this cosine to the normal, for a unit of area.
double label_cost(double cosine);

/// `rotation` turns the part before it is labelled. Call inside with_threads.
LabelSurface label_surface(const TriangleMesh& mesh, const Eigen::Matrix3d& rotation);

inline bool opposite_labels(int label, int other) {
    return label != other && label / 2 == other / 2;
}

}  // namespace hex
