/// \file triangle_rings.h
/// The surface as the labelling methods see it: unit normals, edge neighbours and vertex rings of triangles.
#pragma once

#include <hex/surface/mesh_types.h>
#include <hex/volume/topology.h>

#include <array>
#include <vector>

namespace hex {

/// Triangle mesh in plain arrays, indices as in the mesh.
struct TriangleArrays {
    std::vector<std::array<int, 3>> corners;     ///< vertices of each triangle
    std::vector<std::array<int, 3>> neighbours;  ///< across the edges c0c1, c1c2, c2c0; -1 on a boundary
    CompressedRows<int> vertex_triangles;        ///< triangles around each vertex, ascending

    std::size_t size() const { return corners.size(); }
};

TriangleArrays triangle_arrays(const TriangleMesh& mesh);

/// Unit normals from the winding. Scaling the mesh by a power of two gives the same bits, whatever the size
/// of the part. A triangle without area takes the normal of the nearest triangle with one, counted in edge
/// crossings; zero only when its whole component has no area. Call inside with_threads.
std::vector<Vec3> unit_normals(const TriangleMesh& mesh, const TriangleArrays& arrays);

/// Visits the triangles within two rings by vertices of a triangle: ring one are the triangles that touch a
/// vertex of it, ring two those that touch a vertex of ring one. Keeps only marks, no rings: memory stays
/// linear whatever the valences are. One object for each thread.
class TwoRing {
  public:
    explicit TwoRing(const TriangleArrays& arrays)
        : arrays_(&arrays),
          vertex_mark_(arrays.vertex_triangles.size(), 0),
          triangle_mark_(arrays.size(), 0) {}

    /// Calls `visit(t)` once for each triangle of the two rings of `triangle`, itself included.
    template <class Visit>
    void for_each(std::size_t triangle, const Visit& visit) {
        ++round_;
        for (const int v : arrays_->corners[triangle]) {
            for (const int near : arrays_->vertex_triangles[static_cast<std::size_t>(v)]) {
                for (const int w : arrays_->corners[static_cast<std::size_t>(near)]) {
                    if (!mark(vertex_mark_, w)) continue;
                    for (const int t : arrays_->vertex_triangles[static_cast<std::size_t>(w)]) {
                        if (mark(triangle_mark_, t)) visit(static_cast<std::size_t>(t));
                    }
                }
            }
        }
    }

  private:
    bool mark(std::vector<std::uint32_t>& marks, int index) {
        auto& m = marks[static_cast<std::size_t>(index)];
        if (m == round_) return false;
        m = round_;
        return true;
    }

    const TriangleArrays* arrays_;
    std::vector<std::uint32_t> vertex_mark_;
    std::vector<std::uint32_t> triangle_mark_;
    std::uint32_t round_ = 0;
};

}  // namespace hex
