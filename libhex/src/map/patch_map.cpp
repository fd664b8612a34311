#include "map/triangle_locator.h"

#include <hex/base/error.h>
#include <hex/map/patch_map.h>

#include <fmt/format.h>

#include <algorithm>

namespace hex {

PatchMap::PatchMap(const TriangleMesh& surface, const Patch& patch) : flat_(parameterize(surface, patch)) {
    for (std::size_t k = 0; k < 4; ++k) sides_[k] = ChainCurve(surface, patch.loops.front()[k]);
    locator_ = std::make_unique<TriangleLocator>(flat_.uv, flat_.triangles);
}

PatchMap::~PatchMap() = default;
PatchMap::PatchMap(PatchMap&&) noexcept = default;
PatchMap& PatchMap::operator=(PatchMap&&) noexcept = default;

Vec3 PatchMap::point(double u, double v) const {
    u = std::clamp(u, 0.0, 1.0);
    v = std::clamp(v, 0.0, 1.0);
    // Sides 2 and 3 run backwards: c2 -> c3 along decreasing u, c3 -> c0 along decreasing v.
    if (v == 0.0) return sides_[0].point(u);
    if (u == 1.0) return sides_[1].point(v);
    if (v == 1.0) return sides_[2].point(1.0 - u);
    if (u == 0.0) return sides_[3].point(1.0 - v);
    const TriangleLocator::Location at = locator_->locate(Vec2(u, v), flat_.uv, flat_.triangles);
    if (at.triangle < 0)
        throw Error(ErrorKind::no_result,
                    fmt::format("no triangle of a flattened patch has area at ({}, {})", u, v));
    Vec3 point = Vec3::Zero();
    const auto& corners = flat_.triangles[static_cast<std::size_t>(at.triangle)];
    for (std::size_t k = 0; k < 3; ++k)
        point +=
            at.barycentric[static_cast<Eigen::Index>(k)] * flat_.points[static_cast<std::size_t>(corners[k])];
    return point;
}

}  // namespace hex
