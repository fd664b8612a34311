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

/// How one patch was mapped.
struct PatchMapRecord {
    int patch = 0;
    std::string weights;      ///< "discrete-conformal", or "mean-value" when that had flipped triangles
    std::size_t flipped = 0;  ///< flipped parametric triangles in the map that is used
};

struct MapReport {
    std::size_t patches = 0;
    std::size_t blocks = 0;
    double largest_snap =
        0.0;  ///< distance between a block corner and its surface corner, in units of the diagonal
    std::vector<PatchMapRecord> patch_maps;
    Diagnostics diagnostics;
};

struct MapResult {
    HexMesh mesh;  ///< part of a cell = index of its block + 1
    MapReport report;
};

class Mapper {
  public:
    virtual ~Mapper() = default;
    virtual MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options,
                          const Context& context) const = 0;
};

Registry<Mapper>& mappers();

/// Runs `options.method`. Throws Error{bad_input} with patch, block and vertex ids when patches are not
/// four-sided, two block corners meet one surface corner, or a boundary quad has no patch; Error{usage} for a
/// level out of range.
MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options = {},
              const Context& context = {});

}  // namespace hex
