#include "improve/fidelity_meter.h"

#include "surface/search_set.h"

#include <hex/base/parallel.h>

#include <algorithm>

namespace hex::improving {
namespace {

constexpr std::size_t grain = 64;

template <class Search>
double distance(const Search& search, const Vec3& p) {
    return (search.closest(p).point - p).norm();
}

template <class Search>
double largest_distance(const Search& search, std::span<const Vec3> points) {
    return parallel_reduce(
        points.size(), 0.0,
        [&](double most, std::size_t i) { return std::max(most, distance(search, points[i])); },
        [](double a, double b) { return std::max(a, b); }, grain);
}

}  // namespace

struct FidelityMeter::Trees {
    std::unique_ptr<TriangleSearch> surface;
};

FidelityMeter::FidelityMeter(const EdgeTable& edges, const BoundaryQuads& boundary,
                             const GuideSurface& surface, double sharp_cosine)
    : edges_(edges), boundary_(boundary), trees_(std::make_unique<Trees>()) {
    std::vector<SearchTriangle> triangles;
    std::vector<char> used(surface.points.size(), 0);
    for (const auto& t : surface.triangles) {
        triangles.push_back({surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]});
        for (const std::uint32_t v : t) used[v] = 1;
        surface_samples_.emplace_back((surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) /
                                      3.0);
    }
    trees_->surface = std::make_unique<TriangleSearch>(std::move(triangles));
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v]) surface_samples_.push_back(surface.points[v]);
    for (const GuideSurface::Edge& edge : surface.edges) {
        if (!(edge.cosine < sharp_cosine)) continue;
        const Vec3& a = surface.points[edge.vertices[0]];
        const Vec3& b = surface.points[edge.vertices[1]];
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
            feature_samples_.emplace_back(a + share * (b - a));
    }
}

FidelityMeter::~FidelityMeter() = default;

Fidelity FidelityMeter::measure(std::span<const Vec3> positions) const {
    std::vector<SearchTriangle> triangles;
    std::vector<Vec3> own;
    const auto at = [&](VertexId v) -> const Vec3& { return positions[v.index()]; };
    for (const auto& quad : boundary_.vertices) {
        triangles.push_back({at(quad[0]), at(quad[1]), at(quad[2])});
        triangles.push_back({at(quad[0]), at(quad[2]), at(quad[3])});
        own.emplace_back(0.25 * (positions[quad[0].index()] + positions[quad[1].index()] +
                                 positions[quad[2].index()] + positions[quad[3].index()]));
    }
    for (const VertexId v : boundary_.boundary_vertices) own.push_back(positions[v.index()]);
    const TriangleSearch boundary(std::move(triangles));
    Fidelity found;
    found.distance =
        std::max(largest_distance(*trees_->surface, own), largest_distance(boundary, surface_samples_));
    if (feature_samples_.empty()) return found;
    std::vector<SearchSegment> segments;
    for (std::size_t e = 0; e < edges_.size(); ++e)
        if (edges_.boundary[e]) segments.push_back({at(edges_.vertices[e][0]), at(edges_.vertices[e][1])});
    const SegmentSearch lines(std::move(segments));
    found.features =
        parallel_reduce(
            feature_samples_.size(), 0.0,
            [&](double sum, std::size_t i) { return sum + distance(lines, feature_samples_[i]); },
            [](double a, double b) { return a + b; }, grain) /
        static_cast<double>(feature_samples_.size());
    return found;
}

}  // namespace hex::improving
