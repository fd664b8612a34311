/// \file mesh_choice.h
/// Which of the meshes that `run` makes is kept, and how much may be spent on making more.
#pragma once

#include "hexspline/command.h"

#include <hex/quality/scaled_jacobian.h>
#include <hex/segment/segment.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <cstddef>
#include <optional>
#include <string>

namespace cli {

/// Farthest that mesh and surface should be apart, in percent of the surface's diagonal.
inline constexpr double wished_distance = 1.6;

/// An improved mesh and all that it was made from.
struct Candidate {
    std::string route;
    hex::TriangleMesh surface;
    std::optional<hex::Segmentation> segmentation;
    std::optional<hex::TriangleMesh> patches;  ///< not on the route `voxel`
    hex::HexMesh blocks;
    hex::HexMesh mapped;
    hex::HexMesh improved;
    hex::QualitySummary quality;
    double distance = 0.0;  ///< between `improved` and the surface, both ways, in percent of the diagonal
    Json report;            ///< as it is with this mesh

    bool valid() const { return quality.inverted == 0; }
    /// 1: nothing is left to wish for. Above: so many times too far from the surface, or its smallest scaled
    /// Jacobian so many times too small, whichever is more; infinite for a mesh that is not valid.
    double shortcoming() const;
    /// A valid mesh that is worth more than what another route may give.
    bool acceptable() const;
    /// "N hexahedra, smallest scaled Jacobian S, D % of the diagonal off the surface".
    std::string description() const;
};

/// Keeps the best of the meshes made, and counts what they cost. The price is counted in hexahedra improved
/// and triangles labelled, not in seconds, so that the result is the same on any machine.
class MeshChoice {
  public:
    /// Evaluations of an element that one improvement of one mesh may take (ImproveOptions::work_limit).
    static constexpr double most_work = 2e7;

    /// The mesh becomes the best one if it is better than what there was; returns whether it did. Every mesh
    /// counts as tried.
    bool consider(Candidate candidate);
    /// The one with the smallest shortcoming, the earliest of equals; of meshes that are not valid that with
    /// the fewest inverted elements.
    const std::optional<Candidate>& best() const { return best_; }

    void count_labelled(std::size_t triangles) { labelled_ += triangles; }
    /// Hexahedra that were mapped, but not worth improving, cost a quarter.
    void count_mapped_in_vain(std::size_t hexahedra) { improved_ += hexahedra / 4; }
    /// Whether so many triangles may be labelled anew.
    bool may_label(std::size_t triangles) const;
    /// Whether one more mesh of so many hexahedra may be improved. The first one may have any size.
    bool may_improve(std::size_t hexahedra) const;

    /// What was tried, in order, for the report.
    const Json& tries() const { return tries_; }

  private:
    std::optional<Candidate> best_;
    std::size_t labelled_ = 0;
    std::size_t improved_ = 0;
    Json tries_ = Json::array();
};

}  // namespace cli
