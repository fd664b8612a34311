#include "surface/search_set.h"

#include <hex/base/error.h>
#include <hex/surface/closest_point.h>

#include <algorithm>
#include <optional>

namespace hex {

struct ClosestPoint::State {
    std::vector<std::array<Vec3, 3>> triangles;
    std::vector<std::uint32_t> number;  ///< of the triangles in the search
    std::vector<std::uint32_t> place;   ///< in the search, of each triangle; of one left out: of some other
    std::optional<TriangleSearch> search;
};

ClosestPoint::ClosestPoint(std::span<const std::array<Vec3, 3>> triangles)
    : state_(std::make_unique<State>()) {
    state_->triangles.assign(triangles.begin(), triangles.end());
    std::vector<SearchTriangle> items;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        state_->place.push_back(static_cast<std::uint32_t>(items.size()));
        if (!((b - a).cross(c - a).squaredNorm() > 0.0)) continue;
        items.push_back({a, b, c});
        state_->number.push_back(static_cast<std::uint32_t>(t));
    }
    if (items.empty()) throw Error(ErrorKind::bad_input, "the surface has no triangle with an area");
    const auto last = static_cast<std::uint32_t>(items.size() - 1);
    for (std::uint32_t& place : state_->place) place = std::min(place, last);
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

ClosestPoint::Answer ClosestPoint::operator()(const Vec3& p, std::optional<std::uint32_t> hint) const {
    const auto found = hint ? state_->search->closest(p, state_->place[*hint]) : state_->search->closest(p);
    return {found.point, state_->number[found.item]};
}

const std::array<Vec3, 3>& ClosestPoint::triangle(std::uint32_t number) const {
    return state_->triangles[number];
}

struct ClosestOnSegments::State {
    std::vector<std::uint32_t> number;  ///< of the segments in the search
    std::optional<SegmentSearch> search;
};

ClosestOnSegments::ClosestOnSegments(std::span<const std::array<Vec3, 2>> segments)
    : state_(std::make_unique<State>()) {
    std::vector<SearchSegment> items;
    for (std::size_t s = 0; s < segments.size(); ++s) {
        if (segments[s][0] == segments[s][1]) continue;
        items.push_back(segments[s]);
        state_->number.push_back(static_cast<std::uint32_t>(s));
    }
    if (!items.empty()) state_->search.emplace(std::move(items));
}

ClosestOnSegments::~ClosestOnSegments() = default;

std::optional<ClosestOnSegments::Answer> ClosestOnSegments::operator()(const Vec3& p, double radius) const {
    if (!state_->search) return {};
    const auto found = state_->search->closest_within(p, radius);
    if (!found) return {};
    return Answer{found->point, state_->number[found->item]};
}

}  // namespace hex
