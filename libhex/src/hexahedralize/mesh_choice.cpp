#include "hexahedralize/mesh_choice.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

namespace hex {
namespace {

/// No smallest scaled Jacobian above this is worth another try.
constexpr double wished_scaled_jacobian = 0.2;
/// A mesh with a larger shortcoming (half the wished scaled Jacobian, twice the wished distance) is compared
/// with that of another route.
constexpr double largest_acceptable = 2.0;
/// Hexahedra that may be improved in all before the last try is begun.
constexpr std::size_t most_improved = 6000;
/// Triangles that may be labelled in all before the last labels are asked for.
constexpr std::size_t most_labelled = 50000;

bool is_worse(const HexModel& a, const HexModel& b) {
    return a.quality->inverted != b.quality->inverted ? a.quality->inverted > b.quality->inverted
                                                      : shortcoming(a) > shortcoming(b);
}

}  // namespace

bool is_valid(const HexModel& model) {
    return model.quality->inverted == 0;
}

double shortcoming(const HexModel& model) {
    if (!is_valid(model) || !(model.quality->min > 0.0)) return std::numeric_limits<double>::infinity();
    return std::max({1.0, model.distance / wished_distance, wished_scaled_jacobian / model.quality->min});
}

bool is_acceptable(const HexModel& model) {
    return shortcoming(model) <= largest_acceptable;
}

std::string describe(const HexModel& model) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "%zu hexahedra, %zu inverted, smallest scaled Jacobian %.3f, %.2f %% of the diagonal off "
                  "the surface",
                  model.quality->cells, model.quality->inverted, model.quality->min, model.distance);
    return text;
}

bool MeshChoice::consider(HexModel model) {
    improved_ += model.quality->cells;
    tries_.push_back(
        {.route = model.route,
         .label_attempt = model.segment_report ? std::optional(model.label_attempt) : std::nullopt,
         .blocks = model.blocks ? model.blocks->cell_count() : 0,
         .quality = *model.quality,
         .distance = model.distance});
    if (best_ && !is_worse(*best_, model)) return false;
    best_ = std::move(model);
    return true;
}

bool MeshChoice::may_label(std::size_t triangles) const {
    return labelled_ + triangles <= most_labelled;
}

bool MeshChoice::may_improve(std::size_t hexahedra) const {
    return improved_ == 0 || improved_ + hexahedra <= most_improved;
}

}  // namespace hex
