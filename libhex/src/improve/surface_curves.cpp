#include "improve/surface_curves.h"

#include <hex/base/error.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>

namespace hex::improving {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Adds a triangle unless it has no area; `side_flat[i]`: its edge i is inside a quad; `facet_normal`: that
/// counts for angles at its edges.
struct SurfaceBuilder {
    GuideSurface surface;
    std::vector<Vec3> facet_normals;
    std::vector<std::array<char, 3>> inner;

    void add(const std::array<std::uint32_t, 3>& t, const Vec3& facet_normal,
             const std::array<char, 3>& inner_sides) {
        const Vec3 area =
            (surface.points[t[1]] - surface.points[t[0]]).cross(surface.points[t[2]] - surface.points[t[0]]);
        const double length = area.norm();
        if (!(length > 0.0)) return;
        surface.triangles.push_back(t);
        surface.normals.push_back(area / length);
        facet_normals.push_back(facet_normal.isZero(0.0) ? surface.normals.back() : facet_normal);
        inner.push_back(inner_sides);
    }

    void connect() {
        struct Side {
            std::uint32_t low, high, triangle;
            char inner;
        };
        std::vector<Side> sides;
        sides.reserve(3 * surface.triangles.size());
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t a = surface.triangles[t][i];
                const std::uint32_t b = surface.triangles[t][(i + 1) % 3];
                sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), inner[t][i]});
            }
        }
        std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
            return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
        });
        for (std::size_t i = 0; i < sides.size();) {
            std::size_t end = i + 1;
            while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
                ++end;
            GuideSurface::Edge edge{{sides[i].low, sides[i].high}, {sides[i].triangle, -1}, -1.0};
            if (end - i == 2) {
                edge.triangles[1] = sides[i + 1].triangle;
                edge.cosine =
                    sides[i].inner
                        ? 1.0
                        : facet_normals[sides[i].triangle].dot(facet_normals[sides[i + 1].triangle]);
            }
            surface.edges.push_back(edge);
            i = end;
        }
        BoundingBox box;
        for (const auto& t : surface.triangles)
            for (const std::uint32_t v : t) box.add(surface.points[v]);
        surface.diagonal = box.diagonal();
    }
};

/// Sharp edges as a graph on the surface's vertices.
class CurveGraph {
  public:
    CurveGraph(const GuideSurface& surface, const CurveOptions& options)
        : surface_(surface), options_(options), at_(surface.points.size()), sharp_(surface.edges.size(), 0) {
        for (std::size_t e = 0; e < surface.edges.size(); ++e) {
            const bool sharp = surface.edges[e].cosine < options.sharp_cosine;
            if (!sharp && !(surface.edges[e].cosine < options.weak_cosine)) continue;
            for (const std::uint32_t v : surface.edges[e].vertices)
                at_[v].push_back(static_cast<std::uint32_t>(e));
            sharp_[e] = sharp;
        }
    }

    /// From each open end along the straightest weak edges to another sharp vertex; given up otherwise.
    void close_gaps() {
        for (std::uint32_t v = 0; v < at_.size(); ++v) {
            if (degree(v) != 1) continue;
            std::vector<std::uint32_t> path;
            std::uint32_t here = v;
            std::uint32_t last = first_sharp(v);
            bool reached = false;
            while (path.size() < 64) {
                const std::uint32_t next = straightest_weak(here, last, path);
                if (next == none) break;
                path.push_back(next);
                here = other(next, here);
                last = next;
                if (degree(here) > 0) {
                    reached = here != v;
                    break;
                }
            }
            if (!reached) continue;
            for (const std::uint32_t e : path) sharp_[e] = 1;
        }
    }

    /// Drops curves with an open end that are short, until there are none.
    void drop_dangling() {
        for (bool dropped = true; dropped;) {
            dropped = false;
            for (const SurfaceCurve& curve : curves()) {
                if (curve.closed()) continue;
                if (degree(curve.vertices.front()) != 1 && degree(curve.vertices.back()) != 1) continue;
                double length = 0.0;
                for (const std::uint32_t e : curve.edges) length += direction(e, none).norm();
                if (length >= options_.shortest_open * surface_.diagonal &&
                    curve.mean_cosine < options_.strong_cosine)
                    continue;
                for (const std::uint32_t e : curve.edges) sharp_[e] = 0;
                dropped = true;
            }
        }
    }

    /// Drops connected groups of few edges.
    void drop_specks() {
        std::vector<char> seen(sharp_.size(), 0);
        for (std::uint32_t e = 0; e < sharp_.size(); ++e) {
            if (!sharp_[e] || seen[e]) continue;
            std::vector<std::uint32_t> group = {e};
            seen[e] = 1;
            for (std::size_t i = 0; i < group.size(); ++i)
                for (const std::uint32_t v : surface_.edges[group[i]].vertices)
                    for (const std::uint32_t next : at_[v]) {
                        if (!sharp_[next] || seen[next]) continue;
                        seen[next] = 1;
                        group.push_back(next);
                    }
            if (group.size() < options_.fewest_edges)
                for (const std::uint32_t own : group) sharp_[own] = 0;
        }
    }

    std::vector<SurfaceCurve> curves() const {
        std::vector<SurfaceCurve> found;
        std::vector<char> used(sharp_.size(), 0);
        const auto collect = [&](std::uint32_t start, std::uint32_t e) {
            SurfaceCurve curve;
            curve.vertices.push_back(start);
            for (std::uint32_t v = start;;) {
                used[e] = 1;
                curve.edges.push_back(e);
                v = other(e, v);
                curve.vertices.push_back(v);
                if (v == start || is_corner(v)) break;
                for (const std::uint32_t next : at_[v])
                    if (sharp_[next] && next != e) {
                        e = next;
                        break;
                    }
            }
            double weighted = 0.0;
            double length = 0.0;
            for (const std::uint32_t own : curve.edges) {
                const double span = direction(own, none).norm();
                weighted += span * surface_.edges[own].cosine;
                length += span;
            }
            curve.mean_cosine = length > 0.0 ? weighted / length : 1.0;
            found.push_back(std::move(curve));
        };
        for (std::uint32_t v = 0; v < at_.size(); ++v) {
            if (!is_corner(v)) continue;
            for (const std::uint32_t e : at_[v])
                if (sharp_[e] && !used[e]) collect(v, e);
        }
        for (std::uint32_t v = 0; v < at_.size(); ++v)
            for (const std::uint32_t e : at_[v])
                if (sharp_[e] && !used[e]) collect(v, e);
        return found;
    }

  private:
    std::uint32_t other(std::uint32_t e, std::uint32_t v) const {
        const auto& ends = surface_.edges[e].vertices;
        return ends[0] == v ? ends[1] : ends[0];
    }
    /// Along edge e away from v.
    Vec3 direction(std::uint32_t e, std::uint32_t v) const {
        const auto& ends = surface_.edges[e].vertices;
        const Vec3 d = surface_.points[ends[1]] - surface_.points[ends[0]];
        return ends[1] == v ? Vec3(-d) : d;
    }
    int degree(std::uint32_t v) const {
        int count = 0;
        for (const std::uint32_t e : at_[v]) count += sharp_[e] != 0;
        return count;
    }
    std::uint32_t first_sharp(std::uint32_t v) const {
        for (const std::uint32_t e : at_[v])
            if (sharp_[e]) return e;
        return none;
    }
    bool is_corner(std::uint32_t v) const {
        std::array<Vec3, 2> away;
        int count = 0;
        for (const std::uint32_t e : at_[v]) {
            if (!sharp_[e]) continue;
            if (count < 2) away[static_cast<std::size_t>(count)] = direction(e, v).normalized();
            ++count;
        }
        if (count == 0) return false;
        return count != 2 || -away[0].dot(away[1]) < options_.bend_cosine;
    }
    std::uint32_t straightest_weak(std::uint32_t v, std::uint32_t last,
                                   const std::vector<std::uint32_t>& path) const {
        std::uint32_t best = none;
        double best_cosine = options_.bend_cosine;
        const Vec3 back = direction(last, v).normalized();
        for (const std::uint32_t e : at_[v]) {
            if (sharp_[e] || std::find(path.begin(), path.end(), e) != path.end()) continue;
            const double cosine = -back.dot(direction(e, v).normalized());
            if (cosine <= best_cosine) continue;
            best = e;
            best_cosine = cosine;
        }
        return best;
    }

    const GuideSurface& surface_;
    const CurveOptions& options_;
    std::vector<std::vector<std::uint32_t>> at_;  // sharp and weak edges at each vertex
    std::vector<char> sharp_;
};

}  // namespace

GuideSurface make_guide_surface(const TriangleMesh& mesh) {
    SurfaceBuilder builder;
    for (const auto v : mesh.vertices()) builder.surface.points.push_back(to_eigen(mesh.point(v)));
    for (const auto f : mesh.faces()) {
        std::array<std::uint32_t, 3> t;
        std::size_t i = 0;
        for (const auto v : mesh.fv_range(f)) t[i++] = static_cast<std::uint32_t>(v.idx());
        builder.add(t, Vec3::Zero(), {0, 0, 0});
    }
    builder.connect();
    return std::move(builder.surface);
}

GuideSurface make_guide_surface(const HexMesh& mesh, const BoundaryQuads& boundary,
                                const std::vector<char>& listed) {
    SurfaceBuilder builder;
    builder.surface.points.assign(mesh.positions().begin(), mesh.positions().end());
    for (const auto& quad : boundary.vertices) {
        const Vec3 area = (mesh.position(quad[2]) - mesh.position(quad[0]))
                              .cross(mesh.position(quad[3]) - mesh.position(quad[1]));
        const double length = area.norm();
        const Vec3 normal = length > 0.0 ? Vec3(area / length) : Vec3(Vec3::Zero());
        const auto id = [&](std::size_t i) { return quad[i].value(); };
        builder.add({id(0), id(1), id(2)}, normal, {0, 0, 1});
        builder.add({id(0), id(2), id(3)}, normal, {1, 0, 0});
    }
    builder.connect();
    if (!listed.empty()) {
        std::vector<std::array<std::uint32_t, 2>> diagonals;
        for (const auto& quad : boundary.vertices)
            diagonals.push_back(
                {std::min(quad[0].value(), quad[2].value()), std::max(quad[0].value(), quad[2].value())});
        std::sort(diagonals.begin(), diagonals.end());
        for (GuideSurface::Edge& edge : builder.surface.edges) {
            const bool sharp = listed[edge.vertices[0]] && listed[edge.vertices[1]] &&
                               !std::binary_search(diagonals.begin(), diagonals.end(), edge.vertices);
            edge.cosine = sharp ? -1.0 : 1.0;
        }
    }
    return std::move(builder.surface);
}

void set_sharp_edges(GuideSurface& surface, std::vector<std::array<std::int64_t, 2>> edges) {
    for (auto& edge : edges) std::sort(edge.begin(), edge.end());
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::size_t found = 0;
    for (GuideSurface::Edge& edge : surface.edges) {
        const std::array<std::int64_t, 2> own = {edge.vertices[0], edge.vertices[1]};
        const auto place = std::lower_bound(edges.begin(), edges.end(), own);
        const bool sharp = place != edges.end() && *place == own;
        edge.cosine = sharp ? -1.0 : 1.0;
        found += sharp;
    }
    if (found == edges.size()) return;
    for (const auto& edge : edges) {
        const auto same = [&](const GuideSurface::Edge& e) {
            return edge[0] == e.vertices[0] && edge[1] == e.vertices[1];
        };
        if (std::any_of(surface.edges.begin(), surface.edges.end(), same)) continue;
        std::string text = "no edge of the surface joins the vertices ";
        text += std::to_string(edge[0]) + " and " + std::to_string(edge[1]);
        throw Error(ErrorKind::bad_input, text, {}, "sharp edges are pairs of its vertices, counted from 0");
    }
}

std::vector<SurfaceCurve> find_surface_curves(const GuideSurface& surface, const CurveOptions& options) {
    CurveGraph graph(surface, options);
    graph.close_gaps();
    graph.drop_dangling();
    graph.drop_specks();
    return graph.curves();
}

}  // namespace hex::improving
