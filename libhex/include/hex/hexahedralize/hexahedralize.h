/// \file hexahedralize.h
/// From a closed surface to a good hexahedral mesh: the stages one after the other, and what is tried when
/// they give nothing good at once.
#pragma once

#include <hex/base/context.h>
#include <hex/hexahedralize/hex_model.h>
#include <hex/map/map.h>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hex {

/// The stages from a surface to a mesh, in their order.
enum class HexStage { segment, polycube, map, improve };

/// Number of stages: the length of lists with an entry a stage.
inline constexpr std::size_t hex_stage_count = 4;

/// "segment", "polycube", "map" or "improve".
const char* name_of(HexStage stage);

/// Which way is taken, and what the search may decide by itself: by default everything.
struct HexahedralizeOptions {
    /// How blocks are made: `labelling` or `voxel`; `given` for a HexModel that has patches and blocks.
    Route route = Route::labelling;
    /// The route `voxel` is taken where `labelling` gives no acceptable mesh. Otherwise the best mesh of
    /// `labelling` is good enough.
    bool or_voxels = true;
    /// Labels by the method `hbecvt` with this weight, which has no others to offer; none: `auto`.
    std::optional<double> boundary_weight;
    /// On the route `labelling` the number of hexahedra is the smallest with which the mesh follows the
    /// surface; the level, edge length or number of `map` is not used.
    bool choose_size = true;
    /// Stage map. On the route `voxel` its edge length or number of hexahedra is that of the grid.
    MapOptions map;
    /// Methods of stage improve, in order. None: `auto`, after `snap` on the route `voxel`, and with a layer
    /// (`pillow`) before it where that is better.
    std::optional<std::vector<std::string>> improve;
    /// Cosine of the angle between normals below which a boundary edge is sharp, in [-1, 1].
    double feature_cosine = 0.8;
    /// Called when a stage has made its part of the model, and when one made earlier is gone back to; for
    /// stage improve with the mesh that is kept.
    std::function<void(HexStage, const HexModel&)> on_made;
};

/// A mesh that competed.
struct HexTry {
    Route route = Route::labelling;    ///< by which its blocks were made
    std::optional<int> label_attempt;  ///< HexModel::label_attempt; none if the labels came from elsewhere
    std::size_t blocks = 0;            ///< blocks, on the route `voxel` cells, that it was made of
    QualitySummary quality;            ///< of the improved mesh
    double distance = 0.0;             ///< HexModel::distance
};

/// A mesh, how it was come by, and what else was tried.
struct HexahedralizeResult {
    /// What there was at the start, and what the stages up to the last one made; of several meshes the best.
    HexModel model;
    /// Why the route `labelling` was left, or why it was kept although it was not acceptable; may be empty.
    std::string route_reason;
    std::vector<HexTry> tries;  ///< in order
    /// By stage; looking for other labels counts as `segment`.
    std::array<double, hex_stage_count> seconds = {};
};

/// Runs the stages `first` to `last` on a model that has what the stages before `first` make. As long as
/// something is left to wish for (a scaled Jacobian of 0.2, 1.6 % of the diagonal from the surface) and not
/// too much has been spent, meshes of the same blocks with more hexahedra, meshes with a layer around them,
/// and other labels are tried, but only with what this call makes itself: given labels, blocks and sizes are
/// kept. The price is counted in hexahedra and triangles, not in seconds, so the result is the same on any
/// machine and for any number of threads. docs/automatic.md tells more.
///
/// The mesh that is kept may have inverted elements: `model.quality` tells. Throws Error{no_result} when no
/// route gives blocks, Error{usage} when the model lacks what `first` needs or the route is `given` and
/// blocks would have to be made, and what the stages throw.
HexahedralizeResult hexahedralize(HexModel start, HexStage first, HexStage last,
                                  const HexahedralizeOptions& options = {}, const Context& context = {});

/// All stages, for a closed surface.
HexahedralizeResult hexahedralize(const TriangleMesh& surface, const HexahedralizeOptions& options = {},
                                  const Context& context = {});

}  // namespace hex
