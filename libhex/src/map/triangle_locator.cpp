#include "map/triangle_locator.h"

// Boost.Geometry 1.74 itself includes a header that Boost 1.74 announces to remove.
#define BOOST_ALLOW_DEPRECATED_HEADERS
#include <boost/geometry/algorithms/disjoint.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

#include <limits>

namespace hex {
namespace {

using Point = boost::geometry::model::d2::point_xy<double>;
using Box = boost::geometry::model::box<Point>;
using Entry = std::pair<Box, int>;

double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Barycentric coordinates of p; false for a triangle without area.
bool barycentric(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c, Vec3& result) {
    const double area = cross(b - a, c - a);
    if (area == 0.0) return false;
    result = Vec3(cross(b - p, c - p), cross(c - p, a - p), cross(a - p, b - p)) / area;
    return result.allFinite();
}

}  // namespace

struct TriangleLocator::Tree {
    boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<8>> boxes;
};

TriangleLocator::~TriangleLocator() = default;

TriangleLocator::TriangleLocator(const std::vector<Vec2>& uv,
                                 const std::vector<std::array<int, 3>>& triangles) {
    // Slightly larger boxes: a point on a common edge must find both triangles, however it was rounded.
    constexpr double margin = 1e-12;
    std::vector<Entry> entries;
    entries.reserve(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        Vec2 lower = Vec2::Constant(std::numeric_limits<double>::infinity());
        Vec2 upper = -lower;
        for (const int v : triangles[t]) {
            lower = lower.cwiseMin(uv[static_cast<std::size_t>(v)]);
            upper = upper.cwiseMax(uv[static_cast<std::size_t>(v)]);
        }
        entries.emplace_back(
            Box(Point(lower.x() - margin, lower.y() - margin), Point(upper.x() + margin, upper.y() + margin)),
            static_cast<int>(t));
    }
    // The range constructor packs the tree: balanced, and the same for the same input.
    tree_ = std::make_unique<Tree>(Tree{{entries.begin(), entries.end()}});
}

TriangleLocator::Location TriangleLocator::locate(const Vec2& p, const std::vector<Vec2>& uv,
                                                  const std::vector<std::array<int, 3>>& triangles) const {
    Location best;
    double best_smallest = -std::numeric_limits<double>::infinity();
    const auto consider = [&](int t) {
        const auto& corner = triangles[static_cast<std::size_t>(t)];
        Vec3 weights;
        if (!barycentric(p, uv[static_cast<std::size_t>(corner[0])], uv[static_cast<std::size_t>(corner[1])],
                         uv[static_cast<std::size_t>(corner[2])], weights))
            return;
        const double smallest = weights.minCoeff();
        if (smallest > best_smallest || (smallest == best_smallest && t < best.triangle)) {
            best_smallest = smallest;
            best = {t, weights};
        }
    };
    tree_->boxes.query(
        boost::geometry::index::intersects(Point(p.x(), p.y())),
        boost::make_function_output_iterator([&](const Entry& entry) { consider(entry.second); }));
    if (best.triangle < 0)
        for (std::size_t t = 0; t < triangles.size(); ++t) consider(static_cast<int>(t));
    if (best.triangle >= 0) {
        best.barycentric = best.barycentric.cwiseMax(0.0);
        best.barycentric /= best.barycentric.sum();
    }
    return best;
}

}  // namespace hex
