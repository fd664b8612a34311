/// \file triangle_locator.h
/// Which triangle of a flat triangulation contains a point.
#pragma once

#include <hex/base/linear_algebra.h>

#include <boost/geometry/algorithms/disjoint.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <array>
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

    /// Of the triangles whose box holds the point, the one in which the smallest barycentric coordinate is
    /// largest; the one with the lowest index if equal. Of all triangles when no box holds it.
    Location locate(const Vec2& p, const std::vector<Vec2>& uv,
                    const std::vector<std::array<int, 3>>& triangles) const;

  private:
    using Point = boost::geometry::model::d2::point_xy<double>;
    using Box = boost::geometry::model::box<Point>;
    using Entry = std::pair<Box, int>;

    boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<8>> tree_;
};

}  // namespace hex
