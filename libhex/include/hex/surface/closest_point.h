/// \file closest_point.h
/// Closest points on triangles, for stages outside this library that must not know CGAL.
#pragma once

#include <hex/base/linear_algebra.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hex {

/// A search tree over triangles (CGAL AABB tree). Queries are exact up to rounding and thread-safe.
class ClosestPoint {
  public:
    /// Triangles without area are left out of the search but keep their number. Throws Error{bad_input} when
    /// no triangle has an area.
    explicit ClosestPoint(std::span<const std::array<Vec3, 3>> triangles);
    explicit ClosestPoint(const TriangleMesh& mesh);
    ~ClosestPoint();
    ClosestPoint(const ClosestPoint&) = delete;
    ClosestPoint& operator=(const ClosestPoint&) = delete;

    struct Answer {
        Vec3 point;
        std::uint32_t triangle = 0;
    };
    Answer operator()(const Vec3& p) const;

    const std::array<Vec3, 3>& triangle(std::uint32_t number) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace hex
