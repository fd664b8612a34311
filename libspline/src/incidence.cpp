#include "incidence.h"

#include <hex/base/parallel.h>

#include <algorithm>
#include <numeric>

namespace spline {

Incidence::Incidence(const BezierSpline& spline) {
    std::vector<std::vector<std::uint32_t>> functions(spline.element_count());
    constexpr std::size_t chunk_size = 64;
    hex::parallel_for((functions.size() + chunk_size - 1) / chunk_size,
                      [&](std::size_t chunk) {
                          ElementFunctions functions_of;
                          const std::size_t end = std::min(functions.size(), (chunk + 1) * chunk_size);
                          for (std::size_t e = chunk * chunk_size; e < end; ++e) {
                              const auto found = functions_of(spline, e);
                              functions[e].assign(found.begin(), found.end());
                          }
                      },
                      1);
    offsets.assign(spline.function_count() + 1, 0);
    for (const auto& list : functions)
        for (const std::uint32_t f : list) ++offsets[f + 1];
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    elements.resize(offsets.back());
    std::vector<std::size_t> next(offsets.begin(), offsets.end() - 1);
    for (std::size_t e = 0; e < functions.size(); ++e)
        for (const std::uint32_t f : functions[e]) elements[next[f]++] = static_cast<std::uint32_t>(e);
}

}  // namespace spline
