/// \file cases.h
/// Surfaces with patches that fit given blocks, and distances, for the tests of the stage map.
#pragma once

#include "support/meshes.h"

#include <hex/surface/patch_layout.h>
#include <hex/surface/polygon_soup.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <vector>

namespace hex::test {

/// The boundary of some blocks as triangles, n x n x 2 a boundary quad (bilinear), part = quad + 1. `move` is
/// applied to every vertex.
inline PolygonSoup surface_of_blocks(const HexMesh& blocks, int n,
                                     const std::function<Vec3(const Vec3&)>& move = {}) {
    PolygonSoup soup;
    // A vertex is known by the block vertices it hangs on and its weights on them, as integers.
    std::map<std::map<std::uint32_t, int>, std::uint32_t> known;
    const BoundaryQuads quads = boundary_quads(blocks);
    for (std::size_t q = 0; q < quads.size(); ++q) {
        const auto& v = quads.vertices[q];
        const auto at = [&](int i, int j) {
            std::map<std::uint32_t, int> key;
            const std::array<int, 4> weights = {(n - i) * (n - j), i * (n - j), i * j, (n - i) * j};
            Vec3 p = Vec3::Zero();
            for (std::size_t k = 0; k < 4; ++k) {
                if (weights[k] != 0) key[v[k].value()] = weights[k];
                p += weights[k] * blocks.position(v[k]);
            }
            const auto [entry, added] = known.emplace(key, static_cast<std::uint32_t>(soup.points.size()));
            if (added) {
                p /= n * n;
                soup.points.push_back(move ? move(p) : p);
            }
            return entry->second;
        };
        const int part = static_cast<int>(q) + 1;
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                soup.add_polygon(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, part);
                soup.add_polygon(std::array{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, part);
            }
        }
    }
    return soup;
}

inline HexMesh moved(const HexMesh& mesh, const std::function<Vec3(const Vec3&)>& move) {
    std::vector<Vec3> positions(mesh.positions().begin(), mesh.positions().end());
    for (Vec3& p : positions) p = move(p);
    return {std::move(positions), {mesh.cell_array().begin(), mesh.cell_array().end()}};
}

/// Distance from a point to a triangle (Ericson, Real-time collision detection, 5.1.5).
inline double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return ap.norm();
    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return bp.norm();
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).norm();
    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return cp.norm();
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).norm();
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
    const double total = va + vb + vc;
    return (ap - vb / total * ab - vc / total * ac).norm();
}

/// Distance to the nearest triangle, by looking at all whose bounding box is near enough.
inline double distance_to_surface(const Vec3& p, const TriangleMesh& surface) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto f : surface.faces()) {
        std::array<Vec3, 3> v;
        std::size_t k = 0;
        for (const auto corner : surface.fv_range(f)) v[k++] = to_eigen(surface.point(corner));
        const Vec3 lower = v[0].cwiseMin(v[1]).cwiseMin(v[2]);
        const Vec3 upper = v[0].cwiseMax(v[1]).cwiseMax(v[2]);
        if ((lower - p).cwiseMax(p - upper).maxCoeff() >= best) continue;
        best = std::min(best, distance_to_triangle(p, v[0], v[1], v[2]));
    }
    return best;
}

/// The smallest distance between two vertices of a mesh, by sorting along x.
inline double smallest_gap(const HexMesh& mesh) {
    std::vector<Vec3> p(mesh.positions().begin(), mesh.positions().end());
    std::sort(p.begin(), p.end(), [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
    double gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = i + 1; j < p.size() && p[j].x() - p[i].x() < gap; ++j)
            gap = std::min(gap, (p[j] - p[i]).norm());
    return gap;
}

}  // namespace hex::test
