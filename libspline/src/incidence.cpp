#include "incidence.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <numeric>

namespace spline {

Incidence::Incidence(const BezierSpline& spline) {
    std::vector<std::vector<std::uint32_t>> functions(spline.element_count());
    hex::parallel_for(
        functions.size(), [&](std::size_t e) { functions[e] = of_element(spline, e); }, 32);
    offsets.assign(spline.function_count() + 1, 0);
    for (const auto& list : functions)
        for (const std::uint32_t f : list) ++offsets[f + 1];
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    elements.resize(offsets.back());
    std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
    for (std::size_t e = 0; e < functions.size(); ++e)
        for (const std::uint32_t f : functions[e]) elements[next[f]++] = static_cast<std::uint32_t>(e);
}

std::vector<std::uint32_t> Incidence::of_element(const BezierSpline& spline, std::size_t e) {
    std::vector<std::uint32_t> list;
    for (const std::uint32_t p : spline.elements[e]) {
        const SparseRow row = spline.rows[p];
        list.insert(list.end(), row.columns.begin(), row.columns.end());
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

}  // namespace spline
