/// \file nearest_point.h
/// Closest points of one triangle and of one segment.
#pragma once

#include <hex/base/linear_algebra.h>

#include <algorithm>
#include <array>

namespace hex {

/// As a combination of the corners, with the squared distance.
struct NearestPoint {
    std::array<double, 3> shares;
    double squared;
};

/// The third share is 0.
inline NearestPoint nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 d = b - a;
    const double square = d.squaredNorm();
    const double t = square > 0.0 ? std::clamp((p - a).dot(d) / square, 0.0, 1.0) : 0.0;
    return {{1.0 - t, t, 0.0}, (a + t * d - p).squaredNorm()};
}

/// Ericson, Real-Time Collision Detection (2004), 5.1.5; of a triangle without area that of its sides.
inline NearestPoint nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ap = p - a;
    const auto at = [&](double t, double u) {
        return NearestPoint{{1.0 - t - u, t, u}, (t * ab + u * ac - ap).squaredNorm()};
    };
    const double d1 = ab.dot(ap);
    const double d2 = ac.dot(ap);
    if (d1 <= 0.0 && d2 <= 0.0) return at(0.0, 0.0);
    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp);
    const double d4 = ac.dot(bp);
    if (d3 >= 0.0 && d4 <= d3) return at(1.0, 0.0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) return at(d1 / (d1 - d3), 0.0);
    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp);
    const double d6 = ac.dot(cp);
    if (d6 >= 0.0 && d5 <= d6) return at(0.0, 1.0);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) return at(0.0, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 && (d4 - d3) + (d5 - d6) > 0.0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(1.0 - w, w);
    }
    const double sum = va + vb + vc;
    if (sum > 1e-12 * ab.squaredNorm() * ac.squaredNorm()) return at(vb / sum, vc / sum);
    // In a sliver rounding may decide where the point is, and one of the sides may be nearer.
    const NearestPoint on_ab = nearest_on_segment(p, a, b);
    const NearestPoint on_ac = nearest_on_segment(p, a, c);
    const NearestPoint on_bc = nearest_on_segment(p, b, c);
    NearestPoint best = on_ab;
    if (on_ac.squared < best.squared) best = {{on_ac.shares[0], 0.0, on_ac.shares[1]}, on_ac.squared};
    if (on_bc.squared < best.squared) best = {{0.0, on_bc.shares[0], on_bc.shares[1]}, on_bc.squared};
    if (va >= 0.0 && vb >= 0.0 && vc >= 0.0 && sum > 0.0) {
        const NearestPoint inside = at(vb / sum, vc / sum);
        if (inside.squared < best.squared) best = inside;
    }
    return best;
}

}  // namespace hex
