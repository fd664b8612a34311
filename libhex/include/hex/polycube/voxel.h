/// \file voxel.h
/// The way that always ends: the cells of an axis-aligned grid that stand for a closed surface, with its
/// topology.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <array>
#include <cstddef>

namespace hex {

/// How large the cells of the grid are, and how small they may get in the search for the right topology.
struct VoxelOptions {
    /// Mean edge length of the cells, in units of the surface, >= 0. 0: such that `target_cells` come out,
    /// but no more than 1/30 of the diagonal of the surface's bounding box. In any case no
    /// more than 1/6 of the diagonal of a body's own box.
    double cell_size = 0.0;
    /// Wished number of hexahedra, counting one more on every boundary face (the layer that `snap` puts
    /// around), > 0. Without a `cell_size` only.
    std::size_t target_cells = 6000;
    /// Where the topology of the cells is not the surface's, cells of a body get smaller as long as that
    /// leaves it about this many hexahedra at most, again counting the layer. > 0.
    std::size_t most_cells = 60000;
    /// Where the topology is right, but parts of the surface are farther from the cells than a cell's size,
    /// cells get smaller as long as that leaves a body about this many hexahedra at most, counting the layer;
    /// then the try with the smallest distance counts.
    std::size_t most_cells_for_distance = 20000;
};

/// How the cells came about.
struct VoxelReport {
    std::array<int, 3> grid = {0, 0, 0};    ///< cells along x, y, z
    double cell_size = 0.0;                 ///< wished size of the accepted try
    std::array<int, 3> planes = {0, 0, 0};  ///< grid planes that lie on flat faces of the surface
    std::size_t cells = 0;                  ///< hexahedra of the result
    std::size_t tries = 0;    ///< fillings of grids, up to three a grid, the accepted one included
    std::size_t repairs = 0;  ///< cells added or removed where the boundary was not a manifold
    std::size_t specks = 0;   ///< cells of pieces and cavities that the surface does not have
    std::size_t grown = 0;    ///< cells added for thin parts of the solid
    std::size_t carved = 0;   ///< cells removed for thin gaps
    /// Largest distance of the surface to the boundary of the cells, in units of the surface; 2 `cell_size`
    /// stands for more.
    double distance = 0.0;
    std::size_t bodies = 1;    ///< with a grid of their own each; the numbers above are sums, `grid` and
                               ///< `planes` those of the body with most cells, sizes and distances extremes
    std::size_t surfaces = 0;  ///< connected components of the boundary: those of the surface
    int euler_characteristic = 0;  ///< of the boundary: that of the surface
};

/// The cells that stand for a surface.
struct VoxelResult {
    HexMesh cells;       ///< cuboids along the axes, body after body; no unused vertices
    VoxelReport report;  ///< how they came about
};

/// Cells of a grid whose boundary is a 2-manifold with as many components as the surface, each with the
/// Euler characteristic of its counterpart. The solid is where a ray meets the surface an odd number of
/// times, so the orientation of shells plays no role. Each outer shell with the voids right inside it is a
/// body with a grid of its own; bodies may touch or overlap, as their shells do, and share no vertices.
///
/// Grid planes are put on large flat faces that are perpendicular to an axis, and spaced evenly between them.
/// A cell is taken when at least half of it is inside (27 samples, found by exact predicates). At every
/// vertex the taken ones of the eight cells must form a disk of boundary faces that some direction sees
/// from outside (so that a layer can be put around); cells are added or removed where not. Then cells are
/// added along thin parts, and removed along thin gaps, where that does not change the topology (simple
/// points: Bertrand and Malandain, A new characterization of three-dimensional simple points, Pattern
/// Recognition Letters 15, 1994). If the topology is not that of the surface, the same is tried with
/// smaller cells.
///
/// Throws Error{usage} for options out of range, Error{bad_input} for a surface without triangles or with a
/// flat component, Error{no_result} naming a place when `most_cells` do not suffice, Error{unsupported} for
/// cells so small that a grid would have more than 200 million.
VoxelResult voxel_blocks(const TriangleMesh& surface, const VoxelOptions& options = {},
                         const Context& context = {});

}  // namespace hex
