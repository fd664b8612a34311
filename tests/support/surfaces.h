/// \file surfaces.h
/// Closed triangle surfaces that tests of the surface stages want.
#pragma once

#include "support/meshes.h"

#include <hex/surface/polygon_soup.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace hex::test {

inline void add_triangle(PolygonSoup& soup, int a, int b, int c, int part = 1) {
    soup.add_polygon(std::array{static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                static_cast<std::uint32_t>(c)},
                     part);
}

/// Torus about the z axis, `around` x `across` quads cut in two: quad (i, j) is the triangles 2 (i across +
/// j) and the next, vertex (i, j) has the index i across + j; every vertex has six triangles. i runs along
/// the big circle (radius 3), j along the small one (radius 1).
inline PolygonSoup torus(int around, int across) {
    PolygonSoup soup;
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            const double u = 2 * std::numbers::pi * i / around;
            const double v = 2 * std::numbers::pi * j / across;
            const double r = 3 + std::cos(v);
            soup.points.emplace_back(r * std::cos(u), r * std::sin(u), std::sin(v));
        }
    }
    const auto at = [=](int i, int j) { return (i % around) * across + j % across; };
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            add_triangle(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1));
            add_triangle(soup, at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return soup;
}

/// Prism along z over the polygon `section` (counter-clockwise in x, y), its caps fans around a middle
/// vertex.
inline PolygonSoup prism(const std::vector<Vec2>& section, double height) {
    PolygonSoup soup;
    const int n = static_cast<int>(section.size());
    Vec2 middle = Vec2::Zero();
    for (const Vec2& p : section) middle += p / n;
    for (const double z : {0.0, height}) {
        for (const Vec2& p : section) soup.points.emplace_back(p.x(), p.y(), z);
    }
    soup.points.emplace_back(middle.x(), middle.y(), 0.0);
    soup.points.emplace_back(middle.x(), middle.y(), height);
    for (int i = 0; i < n; ++i) {
        const int next = (i + 1) % n;
        add_triangle(soup, i, next, n + next);
        add_triangle(soup, i, n + next, n + i);
        add_triangle(soup, 2 * n, next, i);
        add_triangle(soup, 2 * n + 1, n + i, n + next);
    }
    return soup;
}

/// box_surface with n x n x 2 triangles a side, blown up to a ball of radius 1; the parts are the sides'
/// labels.
inline PolygonSoup ball(int n) {
    PolygonSoup soup = box_surface(2, 2, 2, n);
    for (Vec3& p : soup.points) p = (p - Vec3::Ones()).normalized();
    return soup;
}

/// Adds a surface to another, moved and perhaps turned inside out; parts are kept.
inline void append(PolygonSoup& soup, const PolygonSoup& more, double scale, const Vec3& shift,
                   bool inside_out = false) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const Vec3& p : more.points) soup.points.push_back(scale * p + shift);
    for (std::size_t f = 0; f < more.size(); ++f) {
        std::vector<std::uint32_t> polygon(more.polygon(f).begin(), more.polygon(f).end());
        if (inside_out) std::reverse(polygon.begin(), polygon.end());
        for (std::uint32_t& v : polygon) v += first;
        soup.add_polygon(polygon, more.parts[f]);
    }
}

}  // namespace hex::test
