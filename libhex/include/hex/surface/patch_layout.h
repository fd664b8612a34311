/// \file patch_layout.h
/// Patches of a surface whose triangles carry part ids: components, corners, boundary chains (REFERENCE:
/// paper, section 3).
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace hex {

/// A run of boundary vertices between two corners, both included, in the winding of the patch it was
/// collected for.
using Chain = std::vector<int>;

/// One patch: a connected component, through shared triangle edges, of triangles of equal part id.
struct Patch {
    int part = 0;                ///< the part id its triangles share
    std::vector<int> triangles;  ///< ascending
    /// Boundary loops; each loop is a list of chains between consecutive corners, counter-clockwise seen from
    /// outside. A loop without any corner is a single closed chain whose first and last vertex are equal. The
    /// first loop's first corner is the first corner met when scanning `triangles` and their vertices 0,
    /// 1, 2.
    std::vector<std::vector<Chain>> loops;
    int euler_characteristic = 0;  ///< V - E + F of the patch's triangles; 1 for a disk

    /// A disk with one simple boundary loop of exactly four corners.
    bool four_sided = false;
    /// Its corners c0..c3, counter-clockwise seen from outside, when `four_sided`.
    std::array<int, 4> corners = {-1, -1, -1, -1};
};

/// The patches of a surface. Patch order is the order of the first triangle of each when scanning triangles
/// 0, 1, 2, ...
struct PatchLayout {
    std::vector<Patch> patches;          ///< of the whole surface: each triangle is in one
    std::vector<int> patch_of_triangle;  ///< one index into `patches` a triangle
    /// Vertices around which at least three distinct patches meet, ascending.
    std::vector<int> corners;
    /// Number of distinct patches around each vertex (0 for isolated ones).
    std::vector<int> valence;
};

/// Finds the patches of a closed triangle surface from `mesh.data(face).part`. Never throws on odd patches:
/// what is wrong with them is told by `four_sided == false` and diagnose_layout. It takes O(n log n)
/// for n triangles.
PatchLayout find_patches(const TriangleMesh& mesh);

/// Everything that keeps the layout from being a polycube surface: patches that are no disks, have several
/// loops, not four corners, or a boundary that visits a vertex twice. Severity error, entity "patch", with
/// vertex ids in the message.
Diagnostics diagnose_layout(const PatchLayout& layout);

}  // namespace hex
