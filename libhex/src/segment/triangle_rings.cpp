#include "segment/triangle_rings.h"

#include "volume/counting_rows.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <cmath>

namespace hex {
namespace {

/// Twice the area, in units of the squared power of two below the longest edge component, under which the
/// direction of the normal is rounding noise.
constexpr double least_area = 1e-14;

/// Normal of a triangle, not normalised, its longest edge component scaled to [1, 2) by a power of two:
/// that is exact, and neither tiny nor huge parts leave the range of doubles.
Vec3 scaled_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = b - a;
    const Vec3 v = c - a;
    const double largest = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
    if (!(largest > 0.0)) return Vec3::Zero();
    const int exponent = std::ilogb(largest);
    const auto scaled = [=](const Vec3& edge) {
        return Vec3(std::ldexp(edge.x(), -exponent), std::ldexp(edge.y(), -exponent),
                    std::ldexp(edge.z(), -exponent));
    };
    const Vec3 p = scaled(u);
    const Vec3 q = scaled(v);
    return {p.y() * q.z() - p.z() * q.y(), p.z() * q.x() - p.x() * q.z(), p.x() * q.y() - p.y() * q.x()};
}

/// Spreads normals breadth first into the triangles without one.
void fill_missing(const TriangleArrays& arrays, std::vector<Vec3>& normals, std::vector<char>& known) {
    if (std::find(known.begin(), known.end(), 0) == known.end()) return;
    std::vector<std::size_t> queue;
    for (std::size_t t = 0; t < known.size(); ++t) {
        if (known[t]) queue.push_back(t);
    }
    for (std::size_t next = 0; next < queue.size(); ++next) {
        const std::size_t from = queue[next];
        for (const int n : arrays.neighbours[from]) {
            const auto to = static_cast<std::size_t>(n);
            if (n < 0 || known[to]) continue;
            normals[to] = normals[from];
            known[to] = 1;
            queue.push_back(to);
        }
    }
}

}  // namespace

TriangleArrays triangle_arrays(const TriangleMesh& mesh) {
    TriangleArrays arrays;
    const std::size_t count = mesh.n_faces();
    arrays.corners.resize(count);
    arrays.neighbours.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
        auto h = mesh.halfedge_handle(mesh.face_handle(static_cast<unsigned>(t)));
        // OpenMesh keeps the half-edge that ends in the first vertex of the face.
        h = mesh.next_halfedge_handle(h);
        for (std::size_t k = 0; k < 3; ++k) {
            arrays.corners[t][k] = mesh.from_vertex_handle(h).idx();
            arrays.neighbours[t][k] = mesh.face_handle(mesh.opposite_halfedge_handle(h)).idx();
            h = mesh.next_halfedge_handle(h);
        }
    }
    arrays.vertex_triangles = rows_by_counting<int>(mesh.n_vertices(), [&](const auto& emit) {
        for (std::size_t t = 0; t < count; ++t) {
            for (const int v : arrays.corners[t]) emit(static_cast<std::size_t>(v), static_cast<int>(t));
        }
    });
    return arrays;
}

std::vector<Vec3> unit_normals(const TriangleMesh& mesh, const TriangleArrays& arrays) {
    std::vector<Vec3> normals(arrays.size(), Vec3::Zero());
    std::vector<char> known(arrays.size(), 0);
    const auto point = [&](int v) {
        return to_eigen(mesh.point(mesh.vertex_handle(static_cast<unsigned>(v))));
    };
    parallel_for(arrays.size(), [&](std::size_t t) {
        const auto& c = arrays.corners[t];
        const Vec3 n = scaled_normal(point(c[0]), point(c[1]), point(c[2]));
        const double length = std::sqrt(n.x() * n.x() + n.y() * n.y() + n.z() * n.z());
        if (!(length > least_area)) return;
        normals[t] = n / length;
        known[t] = 1;
    });
    fill_missing(arrays, normals, known);
    return normals;
}

}  // namespace hex
