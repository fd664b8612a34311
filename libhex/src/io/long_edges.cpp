#include "io/long_edges.h"

#include <hex/base/error.h>

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace hex::io {
namespace {

using Edge = std::array<std::uint32_t, 2>;

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

Error too_many() {
    return Error(ErrorKind::unsupported, "the surface would have too many triangles", {},
                 "allow longer edges");
}

/// Refuses what would not end, before the first cut.
void require_bearable(const PolygonSoup& triangles, double longest) {
    constexpr double most_triangles = 5e7;
    double pieces = 0.0;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        double longest_side = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& p = triangles.points[triangles.polygon(f)[k]];
            const Vec3& q = triangles.points[triangles.polygon(f)[(k + 1) % 3]];
            longest_side = std::max(longest_side, (p - q).norm());
        }
        pieces += longest_side / longest;  // at least, however thin it is
    }
    if (pieces > most_triangles) throw too_many();
}

/// One round: a midpoint for each long edge, then each triangle by how many of its edges have one.
class Round {
  public:
    Round(PolygonSoup& soup, double longest) : soup_(soup), longest_(longest) {}

    /// False when no edge is long.
    bool run(std::vector<Edge>& marked) {
        for (std::size_t f = 0; f < soup_.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k)
                find_or_cut(soup_.polygon(f)[k], soup_.polygon(f)[(k + 1) % 3]);
        if (middle_.empty()) return false;
        PolygonSoup cut;
        cut.points = std::move(soup_.points);
        for (std::size_t f = 0; f < soup_.size(); ++f) {
            const auto corner = soup_.polygon(f);
            cut_triangle({corner[0], corner[1], corner[2]}, soup_.parts[f], cut);
        }
        soup_ = std::move(cut);
        cut_marked(marked);
        return true;
    }

  private:
    void find_or_cut(std::uint32_t a, std::uint32_t b) {
        const Vec3 p = soup_.points[a];
        const Vec3 q = soup_.points[b];
        if (!((p - q).norm() > longest_)) return;
        const auto [entry, added] =
            middle_.emplace(key_of(a, b), static_cast<std::uint32_t>(soup_.points.size()));
        if (added) soup_.points.emplace_back(0.5 * (p + q));
        if (soup_.points.size() >= std::numeric_limits<std::int32_t>::max() / 4) throw too_many();
    }

    void cut_triangle(std::array<std::uint32_t, 3> v, int part, PolygonSoup& out) const {
        constexpr auto none = std::numeric_limits<std::uint32_t>::max();
        std::array<std::uint32_t, 3> m{};
        int count = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto found = middle_.find(key_of(v[k], v[(k + 1) % 3]));
            m[k] = found == middle_.end() ? none : found->second;
            count += m[k] == none ? 0 : 1;
        }
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            out.add_polygon(std::array{a, b, c}, part);
        };
        const auto turn = [&] {
            std::rotate(v.begin(), v.begin() + 1, v.end());
            std::rotate(m.begin(), m.begin() + 1, m.end());
        };
        if (count == 0) {
            add(v[0], v[1], v[2]);
        } else if (count == 1) {
            while (m[0] == none) turn();
            add(v[0], m[0], v[2]);
            add(m[0], v[1], v[2]);
        } else if (count == 2) {
            while (m[2] != none) turn();
            // m0 on v0 v1 and m1 on v1 v2; the quadrilateral v0 m0 m1 v2 by its shorter diagonal.
            add(m[0], v[1], m[1]);
            const auto length = [&](std::uint32_t a, std::uint32_t b) {
                return (out.points[a] - out.points[b]).squaredNorm();
            };
            if (length(v[0], m[1]) <= length(m[0], v[2])) {
                add(v[0], m[0], m[1]);
                add(v[0], m[1], v[2]);
            } else {
                add(v[0], m[0], v[2]);
                add(m[0], m[1], v[2]);
            }
        } else {
            for (std::size_t k = 0; k < 3; ++k) add(v[k], m[k], m[(k + 2) % 3]);
            add(m[0], m[1], m[2]);
        }
    }

    void cut_marked(std::vector<Edge>& marked) const {
        std::vector<Edge> pieces;
        for (const auto& [a, b] : marked) {
            const auto found = middle_.find(key_of(a, b));
            if (found == middle_.end()) {
                pieces.push_back({a, b});
            } else {
                pieces.push_back({a, found->second});
                pieces.push_back({found->second, b});
            }
        }
        marked = std::move(pieces);
    }

    PolygonSoup& soup_;
    double longest_;
    std::unordered_map<std::uint64_t, std::uint32_t> middle_;
};

}  // namespace

void cut_long_edges(PolygonSoup& triangles, std::vector<Edge>& marked, double longest) {
    require_bearable(triangles, longest);
    while (Round(triangles, longest).run(marked)) {
    }
}

}  // namespace hex::io
