/// \file search.h
/// The stages one after the other, and the search for a mesh that leaves nothing to wish for.
#pragma once

#include "hexahedralize/mesh_choice.h"

#include <hex/hexahedralize/hexahedralize.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hex {

/// One call of hexahedralize.
class Search {
  public:
    Search(HexModel start, const HexahedralizeOptions& options, const Context& context);

    HexahedralizeResult run(HexStage first, HexStage last);

  private:
    /// Thrown within the route `labelling`: these labels give no mesh that leaves nothing to wish for.
    struct RouteClosed {
        std::string reason;
    };
    /// The blocks cut into hexahedra.
    struct Mapped {
        MapResult result;
        QualitySummary quality;
        double target = 0.0;  ///< hexahedra asked for; 0: the size is the caller's
        double apart = 0.0;   ///< from the surface, in percent of the diagonal

        double folded_share() const;
    };
    /// What became of a mapped mesh.
    struct Improved {
        QualitySummary quality;
        double distance = 0.0;
        bool layer = false;  ///< one was put around it first
    };
    /// Blocks whose meshes do not follow the surface.
    struct Postponed {
        double nearest = 0.0;  ///< that a mesh of these blocks is to the surface
        HexModel model;
        std::shared_ptr<MapMemory> map_memory;
    };

    // search.cpp: the stages.
    void run_stage(HexStage stage);
    void segment();
    /// Labels the surface: SegmentOptions::attempt. Returns false for labels that there were before.
    bool label(int attempt);
    void polycube();
    void polycube_of_labels();
    void polycube_of_voxels();
    void map();
    void improve();
    /// Makes `mapped` better and lets it compete with the meshes that there are.
    Improved improve_mapped(bool layer);
    HexMesh run_improvers(bool layer);
    MapResult map_blocks(const MapOptions& options) const;
    void take_mapped(Mapped mapped);
    /// Largest distance between a mesh and the surface, both ways, in percent of the diagonal.
    double percent_apart(const HexMesh& mesh) const;

    // search_tries.cpp: what is tried, and when a route is left.
    /// What comes after labels that ended: other labels, the best mesh there is, or the route `voxel`.
    /// Returns the last stage that is done.
    HexStage go_on_after(const std::string& reason);
    bool may_take_other_labels() const;
    /// Labels the surface otherwise than before. Returns false when there is nothing else to try.
    bool take_other_labels();
    /// Keeps blocks for when no other labels give better ones; of several those that come nearest.
    void postpone(double nearest);
    /// Goes back to the blocks that were postponed. Returns false when there are none, when the best mesh is
    /// acceptable, or when no more may be spent.
    bool take_postponed();
    void take_voxel_route();
    /// This call makes labels and blocks, and may make others.
    bool is_searching() const;
    /// The number of hexahedra is left to the search.
    bool size_is_chosen() const;
    Mapped mapped_to(double target);
    /// The coarsest mesh that follows the surface.
    Mapped as_fine_as_needed();
    /// A finer mesh than the present one, that is nearer to the surface if it is the distance that the
    /// improved one lacks. Returns false if there is none, or if it is too expensive.
    bool take_finer_mesh(bool nearer);
    /// Improves finer meshes of the same blocks while they may give what is wished for.
    void refine_while_wanted(const Improved& coarse);
    /// Improves the mesh as it is, or with a layer of hexahedra around it when much of it is folded; and the
    /// other way, too, if that lacks something. Returns the better of the two.
    Improved improve_with_and_without_layer();
    /// Whether the best mesh leaves something to wish for that another try may give.
    bool wants_more() const;
    /// Goes on with the best mesh.
    void keep_best();

    void tell(HexStage stage) const;
    void info(const std::string& message) const { context_.log(LogLevel::info, message); }

    const HexahedralizeOptions& options_;
    const Context& context_;
    HexModel model_;
    std::optional<HexModel> first_labels_;        ///< the model as it was when these had been made
    std::shared_ptr<SegmentResult> next_labels_;  ///< of the next attempt, when they are known
    std::vector<std::vector<int>> tried_labels_;
    int attempt_ = 0;
    std::shared_ptr<MapMemory> map_memory_;  ///< of the patches and blocks mapped last
    double mapped_target_ = 0.0;             ///< Mapped, of the mesh in the model
    double mapped_apart_ = 0.0;
    double mapped_folded_ = 0.0;
    bool blocks_made_ = false;  ///< by this call, which so may make others
    bool newest_is_best_ = false;
    MeshChoice choice_;
    std::optional<Postponed> postponed_;
    HexahedralizeResult result_;
};

}  // namespace hex
