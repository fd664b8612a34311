/// \file map.h
/// Stage `map`: from a surface with four-sided patches and a block structure to a hexahedral mesh.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/base/registry.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <memory>
#include <string>
#include <vector>

namespace hex {

/// How the inside of the blocks is filled.
enum class Interior {
    linear,       ///< straight lines between opposite sides (linear_blend.h)
    transfinite,  ///< Coons faces and Gordon-Hall blocks (transfinite.h)
    harmonic,     ///< a discrete Laplace equation over all inner nodes, those of inner block vertices, edges
                  ///< and faces too; where that makes an element worse than transfinite, and its scaled
                  ///< Jacobian less than 0.3, its nodes move less
};

/// "linear", "transfinite" or "harmonic".
std::string name_of(Interior interior);
/// The inverse of name_of; throws Error{usage} for another name.
Interior interior_named(const std::string& name);

/// What a method keeps for the next call with the same surface and blocks, such as the maps of the patches.
class MapMemory {
  public:
    virtual ~MapMemory() = default;
};

/// The method, how many hexahedra there shall be, and how blocks are filled.
struct MapOptions {
    /// Name of the method in the registry: `patchwise` (harmonic patches, blocks filled as `interior` says)
    /// or a plug-in's.
    std::string method = "patchwise";
    /// Every block becomes 2^level x 2^level x 2^level hexahedra; 0 .. 7. Paper: octree level, default 2.
    /// Without effect when an edge length or a number of hexahedra is asked for.
    int level = 2;
    /// When positive: block edges are cut into pieces of about this length, equally many for all edges of a
    /// sheet (divisions.h). In the units of the surface.
    double edge_length = 0.0;
    /// When positive: the edge length is chosen so that there are about as many hexahedra. Not both.
    std::size_t target_hexes = 0;
    /// How the insides of block faces and blocks are filled.
    Interior interior = Interior::harmonic;
    /// A block corner farther than this from its surface corner, in units of the bounding box diagonal, is
    /// warned about.
    double snap_warning = 1e-3;
    /// Where calls that differ only in the size of the elements leave what they have in common; starts as
    /// null. The result is the same with and without: what another surface or other blocks left is not used.
    std::shared_ptr<MapMemory>* memory = nullptr;
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

/// How a mesh was mapped. All but `method` is up to the method; the built-in one fills everything.
struct MapReport {
    std::string method;       ///< that was run
    std::size_t patches = 0;  ///< of the surface, one a boundary quad of the blocks
    std::size_t blocks = 0;   ///< of the block structure
    /// Largest distance between a block corner and its surface corner, in units of the diagonal.
    double largest_snap = 0.0;
    /// Pieces into which the edges of each sheet of the blocks are cut (block_sheets.h).
    std::vector<int> divisions;
    /// The edge length that they were chosen for; 0 when they follow from the level.
    double edge_length = 0.0;
    /// Interior::harmonic: nodes that moved less, or not, because an element would have got worse.
    std::size_t held_back_nodes = 0;
    std::vector<PatchMapRecord> patch_maps;  ///< one a patch, in the order of find_patches
    /// Warnings `far-corner` (block vertices) and `flipped-patch` (patches).
    Diagnostics diagnostics;
};

/// A hexahedral mesh, and how it was mapped.
struct MapResult {
    HexMesh mesh;      ///< part of a cell = index of its block + 1; no unused vertices
    MapReport report;  ///< how it was mapped
};

/// Interface of a mapping method.
class Mapper {
  public:
    virtual ~Mapper() = default;
    /// Makes the mesh. The options are in range; whether surface and blocks fit is the method's to check. A
    /// mesh that is not as MapResult says makes the stage throw Error{no_result}.
    virtual MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options,
                          const Context& context) const = 0;
};

/// The methods of the stage by name, those of plug-ins included.
Registry<Mapper>& mappers();

/// Runs `options.method`. The result of the built-in method `patchwise` is conforming by construction, and
/// its boundary vertices lie on the triangles of the surface; that its elements are not inverted is not
/// promised (stage `improve` is for that). It is unchanged by rotations, translations and scalings but for
/// rounding.
///
/// Throws Error{bad_input} with patch, block and vertex ids when patches are not four-sided, two block
/// corners meet one surface corner, or boundary quads and patches do not pair (block_match.h); Error{usage}
/// for a level out of range, an edge length that is not positive, both a length and a number, or an unknown
/// method; Error{unsupported} for more elements than 32-bit ids can
/// name.
MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options = {},
              const Context& context = {});

}  // namespace hex
