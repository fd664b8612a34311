/// \file closest_point.h
/// Closest points on triangles and segments, for stages outside this library that must not know CGAL.
#pragma once

#include <hex/base/linear_algebra.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace hex {

/// A search tree over triangles (CGAL AABB tree). Queries are exact up to rounding and thread-safe.
class ClosestPoint {
  public:
    /// Triangles without area are left out of the search but keep their number. Throws Error{bad_input} when
    /// no triangle has an area.
    explicit ClosestPoint(std::span<const std::array<Vec3, 3>> triangles);
    /// Of the faces of a surface, which are the triangles 0, 1, 2, ... in their order. Throws the same.
    explicit ClosestPoint(const TriangleMesh& mesh);
    ~ClosestPoint();
    ClosestPoint(const ClosestPoint&) = delete;
    ClosestPoint& operator=(const ClosestPoint&) = delete;

    /// What is closest to a point.
    struct Answer {
        Vec3 point;                  ///< on the triangle, closest to the point that was asked for
        std::uint32_t triangle = 0;  ///< number of a triangle that has it
    };
    /// The point of the triangles that is closest to p. The search starts from triangle `hint`, which must
    /// exist: fastest when that is near the answer; without, it looks for a start. Of several triangles that
    /// are equally close the answer may depend on it.
    Answer operator()(const Vec3& p, std::optional<std::uint32_t> hint = {}) const;

    /// Corners of a triangle by its number, one without area, too. The number must exist.
    const std::array<Vec3, 3>& triangle(std::uint32_t number) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// A search tree over segments. Queries are thread-safe.
class ClosestOnSegments {
  public:
    /// Segments without length are left out of the search but keep their number.
    explicit ClosestOnSegments(std::span<const std::array<Vec3, 2>> segments);
    ~ClosestOnSegments();
    ClosestOnSegments(const ClosestOnSegments&) = delete;
    ClosestOnSegments& operator=(const ClosestOnSegments&) = delete;

    /// What is closest to a point.
    struct Answer {
        Vec3 point;                 ///< on the segment, closest to the point that was asked for
        std::uint32_t segment = 0;  ///< number of a segment that has it
    };
    /// The point of the segments that is closest to p. None when all are farther than `radius`.
    std::optional<Answer> operator()(const Vec3& p, double radius) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace hex
