/// \file boundary_samples.h
/// Points of the spline's boundary as combinations of control points.
#pragma once

#include <hex/base/linear_algebra.h>
#include <hex/surface/closest_point.h>
#include <spline/bezier.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace spline {

/// One face of an element that lies on the boundary.
struct BoundaryFace {
    std::uint32_t element;
    std::uint8_t face;
};

std::vector<BoundaryFace> boundary_faces(const BezierSpline& spline);

/// Where on the boundary: a face and its two parameters, the first running fastest in face_points.
struct BoundaryPlace {
    std::uint32_t face;  ///< place in the list of faces
    std::array<double, 2> st;
};

/// Weights of the control points at places of the boundary.
SparseRows boundary_rows(const BezierSpline& spline, const std::vector<BoundaryFace>& faces,
                         const std::vector<BoundaryPlace>& places);

/// `n` x `n` places of every face, from edge to edge.
std::vector<BoundaryPlace> boundary_grid(std::size_t faces, int n);

/// Where boundary faces of different patches meet: two places an edge, its ends, from one of the faces.
std::vector<std::array<BoundaryPlace, 2>> boundary_creases(const BezierSpline& spline,
                                                           const std::vector<BoundaryFace>& faces);

/// The boundary as triangles, (n - 1)^2 pairs a face over the points of boundary_grid.
class SampledBoundary {
  public:
    SampledBoundary(std::vector<BoundaryPlace> grid, int n, std::span<const hex::Vec3> points);
    /// The place whose point is closest to p, as far as the triangles tell.
    struct Answer {
        BoundaryPlace place;
        hex::Vec3 point;
        std::uint32_t triangle;
    };
    /// The search starts from triangle `hint`.
    Answer closest(const hex::Vec3& p, std::uint32_t hint) const;

  private:
    static std::vector<std::array<std::uint32_t, 3>> triangulate(std::size_t faces, int n);
    std::vector<BoundaryPlace> grid_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    hex::ClosestPoint search_;
};

}  // namespace spline
