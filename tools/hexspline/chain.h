/// \file chain.h
/// The stages of `run` one after the other, and the routes from a surface to blocks.
#pragma once

#include "hexspline/command.h"
#include "hexspline/mesh_choice.h"

#include <hex/map/map.h>
#include <hex/polycube/polycube.h>
#include <hex/segment/segment.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cli {

/// What a stage makes stays in memory for the next one and is written to its numbered file; what was made by
/// an earlier run, or by a person, is read from there.
///
/// Three routes lead to blocks: `given` (a person's --segmentation and --blocks), `labelling` (the labels of
/// stage segment become a polycube and its blocks) and `voxel` (the cells of a grid, pulled onto the
/// surface). On the route `labelling`, as long as something is left to wish for and MeshChoice allows it, the
/// blocks are mapped with more hexahedra, and blocks are made from other labels. With --route auto, `voxel`
/// is taken where no mesh made in this way is acceptable; of all meshes the best is kept. `route_reason` in
/// the report tells why, and `tries` what was tried.
class Chain {
  public:
    explicit Chain(const CommandLine& line);

    /// Runs from --from to --to. Returns the exit code.
    int run();

  private:
    enum : std::size_t { segment_stage, polycube_stage, map_stage, improve_stage, spline_stage };

    /// Thrown within the route `labelling`: these labels give no mesh that leaves nothing to wish for.
    struct RouteClosed {
        std::string reason;
    };
    /// The blocks cut into hexahedra.
    struct Mapped {
        hex::MapResult result;
        double target = 0.0;  ///< hexahedra asked for; 0: the size is the user's
        double apart = 0.0;   ///< from the surface, in percent of the diagonal
        double folded = 0.0;  ///< share of the hexahedra that are inverted
    };

    /// Blocks and what they were made from.
    struct Postponed {
        double nearest = 0.0;  ///< that a mesh of these blocks is to the surface
        hex::TriangleMesh surface;
        std::optional<hex::Segmentation> segmentation;
        std::optional<hex::TriangleMesh> patches;
        hex::HexMesh blocks;
        std::shared_ptr<hex::MapMemory> map_memory;
        Json report;
    };

    void run_stage(std::size_t stage);
    /// Adds the time since `start` to what the report says of a stage.
    void count_time(std::size_t stage, std::chrono::steady_clock::time_point start);
    void make_folder();
    void choose_route(std::size_t first);
    /// What comes after labels that ended: other labels, the best mesh there is, or the route `voxel`.
    /// Returns the last stage that is done.
    std::size_t go_on_after(const std::string& reason);
    /// Labels the surface: SegmentOptions::attempt.
    void label(int attempt);
    bool may_take_other_labels() const;
    /// Labels it otherwise than before. Returns false when there is nothing else to try.
    bool take_other_labels();
    /// Keeps blocks whose meshes do not follow the surface, for when no other labels give ones that do; of
    /// several those that come nearest.
    void postpone(double nearest);
    /// Goes back to the blocks that were postponed. Returns false when there are none, when the best mesh is
    /// acceptable, or when no more may be spent.
    bool take_postponed();
    void take_voxel_route();
    void write_labels() const;
    void write_polycube(const hex::Polycube& quads) const;

    void segment();
    void polycube();
    void map();
    void improve();
    void spline();

    void polycube_of_patches();
    void polycube_of_labels();
    void polycube_of_voxels();
    /// The number of hexahedra is left to the program.
    bool size_is_chosen() const;
    /// This run makes labels and blocks, and may make others.
    bool is_searching() const;
    Mapped mapped_to(double target);
    /// The coarsest mesh that follows the surface.
    Mapped as_fine_as_needed();
    /// A finer mesh than the present one, that is nearer to the surface if it is the distance that the
    /// improved one lacks. Returns false if there is none, or if it is too expensive.
    bool take_finer_mesh(bool nearer);
    /// Improves finer meshes of the same blocks while they may give what is wished for.
    void refine_while_wanted(const Candidate& coarse);
    /// Improves the mesh as it is, or with a layer of hexahedra around it when much of it is folded; and the
    /// other way, too, if that lacks something. Finer meshes are made as the better of the two.
    Candidate improve_with_and_without_layer(const hex::HexMesh& mapped);
    void take_mapped(Mapped mapped);
    /// Tells of the mapped mesh and writes it.
    void report_mapped();
    /// Improves the mapped mesh and lets it compete with those there are. Returns what became of it, without
    /// the meshes themselves.
    Candidate improve_and_consider();
    /// Whether the best mesh leaves something to wish for that another try may give.
    bool wants_more() const;
    /// Goes on with the best mesh.
    void keep_best();
    /// Runs the methods of --improve, and tells what each did.
    Json improve_mesh(hex::HexMesh& mesh);
    /// Largest distance between a mesh and the surface, both ways, in percent of the diagonal.
    double percent_apart(const hex::HexMesh& mesh);

    /// The surface as it came in, labelled when this run labelled it.
    const hex::TriangleMesh& surface();
    /// The surface with four-sided patches; on the route `voxel` the surface as it came in.
    const hex::TriangleMesh& patches();
    const hex::HexMesh& blocks();
    void report_quality(const hex::QualitySummary& summary);

    const CommandLine& line_;
    std::filesystem::path folder_;
    std::string route_ = "given";
    std::optional<hex::TriangleMesh> surface_;
    std::optional<hex::Segmentation> segmentation_;
    std::optional<hex::Segmentation> first_labels_;
    Json first_report_;                                ///< as it was with the first labels
    std::shared_ptr<hex::SegmentResult> next_labels_;  ///< of the next attempt, when they are known
    std::vector<std::vector<int>> tried_labels_;
    int attempt_ = 0;
    std::optional<hex::TriangleMesh> patches_;
    std::optional<hex::HexMesh> blocks_;
    std::shared_ptr<hex::MapMemory> map_memory_;  ///< of the patches and blocks mapped last
    std::optional<hex::HexMesh> mapped_;
    double mapped_target_ = 0.0;
    double mapped_apart_ = 0.0;
    bool blocks_made_ = false;  ///< by this run, which so may make others
    MeshChoice choice_;
    std::optional<Postponed> postponed_;
    bool newest_is_best_ = false;
    double mapped_folded_ = 0.0;
    bool layer_first_ = false;  ///< a layer is put around mapped meshes before they are improved
    std::optional<hex::HexMesh> improved_;
    Json report_;
    Json seconds_;
};

}  // namespace cli
