#include "fit_regions.h"

#include <hex/base/error.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace spline {
namespace {

/// The `share` of the level's elements that are farthest off, of those that can be; ties by their number.
std::vector<std::int64_t> farthest(const BezierSpline& spline, const std::vector<double>& errors,
                                   std::size_t level, double share) {
    std::vector<std::size_t> order;
    std::size_t count = 0;
    for (std::size_t e = 0; e < spline.element_count(); ++e) {
        if (spline.element_level[e] != level) continue;
        ++count;
        if (errors[e] >= 0.0) order.push_back(e);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
    const auto wanted = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
    order.resize(std::min(order.size(), wanted));
    std::vector<std::int64_t> cells;
    for (const std::size_t e : order) cells.push_back(spline.element_cell[e]);
    std::sort(cells.begin(), cells.end());
    return cells;
}

}  // namespace

void list_fit_regions(const std::function<SplineResult(const SplineOptions&)>& build,
                      SplineOptions& options) {
    const auto begin = std::stable_partition(
        options.regions.begin(), options.regions.end(),
        [](const RefineRegion& region) { return region.kind != RefineRegion::Kind::worst_fit; });
    const std::vector<RefineRegion> by_fit(begin, options.regions.end());
    options.regions.erase(begin, options.regions.end());
    if (by_fit.empty()) return;
    if (!options.fit_errors)
        throw hex::Error(hex::ErrorKind::usage, "refining by the distance from a part needs the part", {},
                         "give --surface");
    int deepest = 0;
    for (const RefineRegion& region : by_fit) deepest = std::max(deepest, region.level);
    for (std::size_t l = 0; l < static_cast<std::size_t>(deepest); ++l) {
        const SplineResult so_far = build(options);
        if (so_far.levels.size() <= l) return;
        const std::vector<double> errors = options.fit_errors(so_far.spline);
        // What closure and other regions refine is named, too, so that ids of the next levels stay as they
        // are.
        if (options.refinement.size() <= l) options.refinement.resize(l + 1);
        for (std::size_t k = 0; k <= l; ++k) {
            options.refinement[k].clear();
            for (const hex::CellId c : so_far.levels[k].refined) options.refinement[k].push_back(c.value());
        }
        auto& list = options.refinement[l];
        std::unordered_set<std::int64_t> listed(list.begin(), list.end());
        for (const RefineRegion& region : by_fit) {
            if (region.level <= static_cast<int>(l)) continue;
            for (const std::int64_t cell : farthest(so_far.spline, errors, l, region.share))
                if (listed.insert(cell).second) list.push_back(cell);
        }
    }
}

}  // namespace spline
