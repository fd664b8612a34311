/// \file mesh_choice.h
/// Which of the meshes that are made is kept, and how much may be spent on making more.
#pragma once

#include <hex/hexahedralize/hexahedralize.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hex {

/// Farthest that mesh and surface should be apart, in percent of the surface's diagonal.
inline constexpr double wished_distance = 1.6;

/// An improved mesh has no inverted elements.
bool is_valid(const HexModel& model);
/// 1: nothing is left to wish for. Above: so many times too far from the surface, or its smallest scaled
/// Jacobian so many times too small, whichever is more; infinite for a mesh that is not valid.
double shortcoming(const HexModel& model);
/// A valid mesh that is worth more than what another route may give.
bool is_acceptable(const HexModel& model);
/// "N hexahedra, smallest scaled Jacobian S, D % of the diagonal off the surface".
std::string describe(const HexModel& model);

/// Keeps the best of the improved meshes, and counts what they cost. The price is counted in hexahedra
/// improved and triangles labelled, not in seconds, so that the result is the same on any machine.
class MeshChoice {
  public:
    /// Evaluations of an element that one improvement of one mesh may take (ImproveOptions::work_limit).
    static constexpr double most_work = 2e7;

    /// The mesh becomes the best one if it is better than what there was; returns whether it did. Every mesh
    /// counts as tried.
    bool consider(HexModel model);
    /// The one with the smallest shortcoming, the earliest of equals; of meshes that are not valid that with
    /// the fewest inverted elements.
    const std::optional<HexModel>& best() const { return best_; }
    /// The best one, for good.
    HexModel take_best() { return std::move(*best_); }

    void count_labelled(std::size_t triangles) { labelled_ += triangles; }
    /// Hexahedra that were mapped, but not worth improving, cost a quarter.
    void count_mapped_in_vain(std::size_t hexahedra) { improved_ += hexahedra / 4; }
    /// Whether so many triangles may be labelled anew.
    bool may_label(std::size_t triangles) const;
    /// Whether one more mesh of so many hexahedra may be improved. The first one may have any size.
    bool may_improve(std::size_t hexahedra) const;

    const std::vector<HexTry>& tries() const { return tries_; }

  private:
    std::optional<HexModel> best_;
    std::size_t labelled_ = 0;
    std::size_t improved_ = 0;
    std::vector<HexTry> tries_;
};

}  // namespace hex
