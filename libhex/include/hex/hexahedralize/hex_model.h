/// \file hex_model.h
/// A surface and all that stages have made of it so far.
#pragma once

#include <hex/improve/improve.h>
#include <hex/polycube/blocks.h>
#include <hex/polycube/polycube.h>
#include <hex/polycube/voxel.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/segment/segment.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <optional>
#include <string>
#include <vector>

namespace hex {

/// Where blocks come from.
enum class Route {
    given,      ///< somebody made patches and blocks
    labelling,  ///< the labels of stage segment become a polycube and its blocks (make_blocks)
    voxel,      ///< the cells of a grid, which are pulled onto the surface (voxel_blocks)
};

/// "given", "labelling" or "voxel".
const char* name_of(Route route);

/// One method of stage improve that was run.
struct ImproveStep {
    std::string method;    ///< its name in the registry
    ImproveReport report;  ///< what it did
};

/// Parts are empty until their stage has been. All belong together: the blocks are those of these labels, the
/// meshes those of these blocks.
struct HexModel {
    Route route = Route::labelling;  ///< by which blocks and meshes were made

    /// As it came in; part = label + 1 once it is labelled.
    TriangleMesh surface;
    /// Of `surface`; on the route `voxel` the blocks do not need it.
    std::optional<Segmentation> segmentation;
    /// Of the labels; none if the labels came from elsewhere.
    std::optional<SegmentReport> segment_report;
    int label_attempt = 0;  ///< SegmentOptions::attempt that gave the labels of `segment_report`

    /// The surface cut into four-sided patches (components of equal part id); not on the route `voxel`.
    std::optional<TriangleMesh> patches;
    /// Of `patches`; not on the route `voxel`.
    std::optional<Polycube> polycube;
    /// The block structure; on the route `voxel` the cells of the grid.
    std::optional<HexMesh> blocks;
    std::optional<BlocksReport> blocks_report;  ///< on the route `labelling`
    std::optional<VoxelReport> voxel_report;    ///< on the route `voxel`

    /// The blocks cut into hexahedra by stage map; on the route `voxel` the blocks as they are.
    std::optional<HexMesh> mapped;

    /// `mapped` after all of `improve_steps`.
    std::optional<HexMesh> improved;
    /// The methods that made `improved`, in order; each went on with the mesh of the one before.
    std::vector<ImproveStep> improve_steps;
    /// Of `improved`: largest distance to the surface, both ways, in percent of the surface's diagonal
    /// (surface_distance.h).
    double distance = 0.0;

    /// Of the newest mesh: `improved`, or `mapped` as long as there is no such.
    std::optional<QualitySummary> quality;

    /// What meshes follow: the patches, or on the route `voxel` the surface. Throws Error{usage} when there
    /// are no patches.
    const TriangleMesh& mapped_surface() const;
};

}  // namespace hex
