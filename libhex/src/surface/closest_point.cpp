#include "surface/search_set.h"

#include <hex/base/error.h>
#include <hex/surface/closest_point.h>

#include <optional>

namespace hex {

struct ClosestPoint::State {
    std::vector<std::array<Vec3, 3>> triangles;
    std::vector<std::uint32_t> number;  ///< of the triangles in the search
    std::optional<TriangleSearch> search;
};

ClosestPoint::ClosestPoint(std::span<const std::array<Vec3, 3>> triangles)
    : state_(std::make_unique<State>()) {
    state_->triangles.assign(triangles.begin(), triangles.end());
    std::vector<SearchKernel::Triangle_3> items;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        if (!((b - a).cross(c - a).squaredNorm() > 0.0)) continue;
        items.emplace_back(to_search_point(a), to_search_point(b), to_search_point(c));
        state_->number.push_back(static_cast<std::uint32_t>(t));
    }
    if (items.empty()) throw Error(ErrorKind::bad_input, "the surface has no triangle with an area");
    state_->search.emplace(std::move(items));
}

ClosestPoint::ClosestPoint(const TriangleMesh& mesh)
    : ClosestPoint([&] {
          std::vector<std::array<Vec3, 3>> triangles;
          triangles.reserve(mesh.n_faces());
          for (const auto f : mesh.faces()) {
              std::array<Vec3, 3> corners;
              auto corner = corners.begin();
              for (const auto v : mesh.fv_range(f)) *corner++ = to_eigen(mesh.point(v));
              triangles.push_back(corners);
          }
          return triangles;
      }()) {}

ClosestPoint::~ClosestPoint() = default;

ClosestPoint::Answer ClosestPoint::operator()(const Vec3& p) const {
    const auto found = state_->search->closest(p, 0);
    return {found.point, state_->number[found.item]};
}

const std::array<Vec3, 3>& ClosestPoint::triangle(std::uint32_t number) const {
    return state_->triangles[number];
}

}  // namespace hex
