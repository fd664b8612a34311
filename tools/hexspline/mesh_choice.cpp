#include "hexspline/mesh_choice.h"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace cli {
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

}  // namespace

double Candidate::shortcoming() const {
    if (!valid() || !(quality.min > 0.0)) return std::numeric_limits<double>::infinity();
    return std::max({1.0, distance / wished_distance, wished_scaled_jacobian / quality.min});
}

bool Candidate::acceptable() const {
    return shortcoming() <= largest_acceptable;
}

std::string Candidate::description() const {
    char text[160];
    std::snprintf(text, sizeof text,
                  "%zu hexahedra, %zu inverted, smallest scaled Jacobian %.3f, %.2f %% of the diagonal off "
                  "the surface",
                  quality.cells, quality.inverted, quality.min, distance);
    return text;
}

bool MeshChoice::consider(Candidate candidate) {
    improved_ += candidate.quality.cells;
    tries_.push_back({{"route", candidate.route},
                      {"label_attempt", candidate.report.value("label_attempt", Json())},
                      {"blocks", candidate.blocks.cell_count()},
                      {"hexes", candidate.quality.cells},
                      {"inverted", candidate.quality.inverted},
                      {"min_scaled_jacobian", candidate.quality.min},
                      {"surface_distance_percent", candidate.distance}});
    const auto worse = [](const Candidate& a, const Candidate& b) {
        return a.quality.inverted != b.quality.inverted ? a.quality.inverted > b.quality.inverted
                                                        : a.shortcoming() > b.shortcoming();
    };
    if (best_ && !worse(*best_, candidate)) return false;
    best_ = std::move(candidate);
    return true;
}

bool MeshChoice::may_label(std::size_t triangles) const {
    return labelled_ + triangles <= most_labelled;
}

bool MeshChoice::may_improve(std::size_t hexahedra) const {
    return improved_ == 0 || improved_ + hexahedra <= most_improved;
}

}  // namespace cli
