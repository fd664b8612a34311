/// \file map.h
/// Stage `map`: from a surface with four-sided patches and a block structure to a hexahedral mesh.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/base/registry.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <string>
#include <vector>

namespace hex {

struct MapOptions {
    /// Name of the method in the registry: `transfinite` (harmonic patches, Coons and Gordon-Hall inside) or
    /// a plug-in's.
    std::string method = "transfinite";
    /// Every block becomes 2^level x 2^level x 2^level hexahedra; 0 .. 7. Paper: octree level, default 2.
    int level = 2;
    /// A block corner farther than this from its surface corner, in units of the bounding box diagonal, is
    /// warned about.
    double snap_warning = 1e-3;
};

/// The largest MapOptions::level.
inline constexpr int largest_map_level = 7;

/// How one patch was mapped.
struct PatchMapRecord {
    int patch = 0;                ///< 0-based, in the order of find_patches
    int part = 0;                 ///< part id of its triangles
    std::string weights;          ///< "discrete-conformal", "mean-value" when that had flipped triangles,
                                  ///< "uniform" when both had
    std::size_t flipped = 0;      ///< flipped parametric triangles in the map that is used
    std::size_t split_edges = 0;  ///< edges cut because both ends lie on one side (patch_map.h)
};

struct MapReport {
    std::string method;
    std::size_t patches = 0;
    std::size_t blocks = 0;
    /// Distance between a block corner and its surface corner, in units of the diagonal.
    double largest_snap = 0.0;
    std::vector<PatchMapRecord> patch_maps;
    /// Warnings `far-corner` (block vertices) and `flipped-patch` (patches).
    Diagnostics diagnostics;
};

struct MapResult {
    HexMesh mesh;  ///< part of a cell = index of its block + 1; no unused vertices
    MapReport report;
};

class Mapper {
  public:
    virtual ~Mapper() = default;
    virtual MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options,
                          const Context& context) const = 0;
};

Registry<Mapper>& mappers();

/// Runs `options.method`. The result of the built-in method `transfinite` is conforming by construction, and
/// its boundary vertices lie on the triangles of the surface; that its elements are not inverted is not
/// promised (stage `improve` is for that). It is unchanged by rotations, translations and scalings but for
/// rounding.
///
/// Throws Error{bad_input} with patch, block and vertex ids when patches are not four-sided, two block
/// corners meet one surface corner, or boundary quads and patches do not pair (block_match.h); Error{usage}
/// for a level out of range or an unknown method; Error{unsupported} for more elements than 32-bit ids can
/// name.
MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options = {},
              const Context& context = {});

}  // namespace hex
