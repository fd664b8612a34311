/// \file triangle_locator.h
/// Which triangle of a flat triangulation contains a point.
#pragma once

#include <hex/base/linear_algebra.h>

#include <array>
#include <memory>
#include <vector>

namespace hex {

/// A packed R-tree over the bounding boxes of flat triangles.
class TriangleLocator {
  public:
    struct Location {
        int triangle = -1;
        Vec3 barycentric = Vec3::Zero();  ///< not negative, sum 1
    };

    TriangleLocator(const std::vector<Vec2>& uv, const std::vector<std::array<int, 3>>& triangles);
    ~TriangleLocator();

    /// Of the triangles whose box holds the point, the one in which the smallest barycentric coordinate is
    /// largest; the one with the lowest index if equal. Of all triangles when no box holds it.
    Location locate(const Vec2& p, const std::vector<Vec2>& uv,
                    const std::vector<std::array<int, 3>>& triangles) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace hex
