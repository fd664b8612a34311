/// \file chain.h
/// The stages of `run` one after the other, and the routes from a surface to blocks.
#pragma once

#include "hexspline/command.h"

#include <hex/segment/segment.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cli {

/// What a stage makes stays in memory for the next one and is written to its numbered file; what was made by
/// an earlier run, or by a person, is read from there.
///
/// Three routes lead to blocks: `given` (a person's --segmentation and --blocks), `labelling` (the labels of
/// stage segment become a polycube and its blocks) and `voxel` (the cells of a grid, pulled onto the
/// surface). With --route auto, `voxel` is taken where `labelling` gives no mesh that is valid;
/// `route_reason` in the report tells why.
class Chain {
  public:
    explicit Chain(const CommandLine& line);

    /// Runs from --from to --to. Returns the exit code.
    int run();

  private:
    /// Thrown within the route `labelling`: it cannot end in a valid mesh.
    struct RouteClosed {
        std::string reason;
    };

    void run_stage(std::size_t stage);
    void make_folder();
    void choose_route(bool from_start);
    /// Labels the surface: SegmentOptions::attempt.
    void label(int attempt);
    /// Labels it otherwise than before. Returns false when there is nothing else to try.
    bool take_other_labels();
    void take_voxel_route(const std::string& reason);

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
    /// Maps so many hexahedra, and more until they follow the surface.
    void map_as_fine_as_needed(double target);
    /// Runs the methods of --improve, and tells what each did.
    Json improve_mesh(hex::HexMesh& mesh);
    /// Largest distance between a mesh and the surface, both ways, in percent of the diagonal.
    double percent_apart(const hex::HexMesh& mesh);

    /// The surface as it came in, labelled when this run labelled it.
    const hex::TriangleMesh& surface();
    /// The surface with four-sided patches; on the route `voxel` the surface as it came in.
    const hex::TriangleMesh& patches();
    const hex::HexMesh& blocks();
    void report_quality(const hex::HexMesh& mesh);

    const CommandLine& line_;
    std::filesystem::path folder_;
    std::string route_ = "given";
    std::optional<hex::TriangleMesh> surface_;
    std::optional<hex::Segmentation> segmentation_;
    std::vector<std::vector<int>> tried_labels_;
    int attempt_ = 0;
    int late_failures_ = 0;  ///< improved meshes that were not valid
    std::optional<hex::TriangleMesh> patches_;
    std::optional<hex::HexMesh> blocks_;
    std::optional<hex::HexMesh> mapped_;
    double mapped_target_ = 0;  ///< hexahedra that map_as_fine_as_needed ended with
    std::optional<hex::HexMesh> improved_;
    Json report_;
    Json seconds_;
};

}  // namespace cli
