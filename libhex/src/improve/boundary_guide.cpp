#include "improve/boundary_guide.h"

#include "improve/curve_matching.h"

#include <hex/base/components.h>
#include <hex/base/error.h>
#include <hex/base/parallel.h>

#include <algorithm>
#include <map>

namespace hex::improving {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

struct Region {
    std::vector<std::uint32_t> triangles;  // of the surface
    std::unique_ptr<TriangleSearch> search;
};

}  // namespace

struct BoundaryGuide::Parts {
    GuideSurface surface;
    std::vector<SurfaceCurve> curves;
    std::vector<std::unique_ptr<SegmentSearch>> curve_search;
    std::vector<Region> regions;
    std::vector<std::vector<Vec3>> fine_points;  // of each curve's smooth stand-in
    std::vector<std::unique_ptr<SegmentSearch>> fine_search;
    std::vector<Vec3> corners;

    void make_fine_curves() {
        constexpr int pieces = 8;  // of a segment
        for (const SurfaceCurve& curve : curves) {
            const std::size_t n = curve.vertices.size();
            const auto point = [&](std::size_t i) -> const Vec3& {
                return surface.points[curve.vertices[i]];
            };
            const auto direction = [&](std::size_t i) {
                return Vec3((point(i + 1) - point(i)).normalized());
            };
            std::vector<Vec3> tangent(n, Vec3::Zero());
            for (std::size_t i = 0; i < n; ++i) {
                if (i + 1 < n) tangent[i] += direction(i);
                if (i > 0) tangent[i] += direction(i - 1);
                if (curve.closed() && i == 0) tangent[i] += direction(n - 2);
                if (curve.closed() && i + 1 == n) tangent[i] += direction(0);
                tangent[i].normalize();
            }
            std::vector<Vec3> fine = {point(0)};
            for (std::size_t i = 0; i + 1 < n; ++i) {
                const bool straight = tangent[i].dot(tangent[i + 1]) > 0.9999;
                for (int k = 1; k < pieces && !straight; ++k) {
                    const double share = static_cast<double>(k) / pieces;
                    const Vec3 p = point(i) + share * (point(i + 1) - point(i));
                    const Vec3 on_a = point(i) + (p - point(i)).dot(tangent[i]) * tangent[i];
                    const Vec3 on_b = point(i + 1) + (p - point(i + 1)).dot(tangent[i + 1]) * tangent[i + 1];
                    fine.push_back(0.5 * (p + (1.0 - share) * on_a + share * on_b));
                }
                fine.push_back(point(i + 1));
            }
            std::vector<SearchSegment> segments;
            for (std::size_t i = 0; i + 1 < fine.size(); ++i) segments.push_back({fine[i], fine[i + 1]});
            fine_points.push_back(std::move(fine));
            fine_search.push_back(std::make_unique<SegmentSearch>(std::move(segments)));
        }
    }

    SearchTriangle triangle(std::uint32_t t) const {
        const auto& v = surface.triangles[t];
        return {surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]};
    }

    void make_curve_search() {
        for (const SurfaceCurve& curve : curves) {
            std::vector<SearchSegment> segments;
            for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
                segments.push_back(
                    {surface.points[curve.vertices[i]], surface.points[curve.vertices[i + 1]]});
            curve_search.push_back(std::make_unique<SegmentSearch>(std::move(segments)));
        }
    }

    /// Regions between the edges of the surface that are flagged as cut; returns the region of each triangle.
    std::vector<std::uint32_t> make_regions(const std::vector<char>& cut) {
        Components components(surface.triangles.size());
        for (std::size_t e = 0; e < surface.edges.size(); ++e) {
            const auto& sides = surface.edges[e].triangles;
            if (!cut[e] && sides[0] >= 0 && sides[1] >= 0)
                components.join(static_cast<std::size_t>(sides[0]), static_cast<std::size_t>(sides[1]));
        }
        std::uint32_t count = 0;
        std::vector<std::uint32_t> region = components.numbers(count);
        regions.resize(count);
        for (std::uint32_t t = 0; t < region.size(); ++t) regions[region[t]].triangles.push_back(t);
        for (Region& r : regions) {
            std::vector<SearchTriangle> items;
            for (const std::uint32_t t : r.triangles) items.push_back(triangle(t));
            r.search = std::make_unique<TriangleSearch>(items);
        }
        return region;
    }
};

BoundaryGuide::BoundaryGuide(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                             GuideSurface surface, const CurveOptions& options)
    : parts_(std::make_unique<Parts>()),
      freedom_(mesh.vertex_count(), Freedom::interior),
      part_(mesh.vertex_count(), 0),
      feature_edge_(edges.size(), 0) {
    if (surface.triangles.empty())
        throw Error(ErrorKind::bad_input, "the surface to stay on has no triangle with an area");
    parts_->surface = std::move(surface);
    parts_->curves = find_surface_curves(parts_->surface, options);
    parts_->make_curve_search();
    parts_->make_fine_curves();
    curve_count_ = parts_->curves.size();

    const CurveMatches matches =
        match_curves(mesh, edges, boundary, parts_->surface, parts_->curves, parts_->curve_search);
    const auto& paths = matches.whole;
    std::vector<char> cut(parts_->surface.edges.size(), 0);
    for (const VertexId v : boundary.boundary_vertices) freedom_[v.index()] = Freedom::region;
    std::map<std::uint32_t, std::uint32_t> corner_of;  // surface vertex to corner
    for (std::size_t c = 0; c < paths.size(); ++c) {
        const auto& path = paths[c];
        if (path.empty()) continue;
        ++matched_count_;
        const SurfaceCurve& curve = parts_->curves[c];
        for (const std::uint32_t e : curve.edges) cut[e] = 1;
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
            feature_edge_[edges.find(path[i], path[i + 1]).index()] = 1;
        for (std::size_t i = 0; i < path.size(); ++i) {
            const bool end = !curve.closed() && (i == 0 || i + 1 == path.size());
            if (end) {
                const std::uint32_t at = i == 0 ? curve.vertices.front() : curve.vertices.back();
                const auto [place, fresh] =
                    corner_of.emplace(at, static_cast<std::uint32_t>(parts_->corners.size()));
                if (fresh) parts_->corners.push_back(parts_->surface.points[at]);
                part_[path[i].index()] = place->second;
            } else {
                part_[path[i].index()] = static_cast<std::uint32_t>(c);
            }
            freedom_[path[i].index()] = end ? Freedom::corner : Freedom::curve;
        }
    }

    for (std::size_t c = 0; c < matches.parts.size(); ++c) {
        for (const auto& run : matches.parts[c]) {
            for (std::size_t i = 0; i < run.size(); ++i) {
                part_[run[i].index()] = static_cast<std::uint32_t>(c);
                freedom_[run[i].index()] = Freedom::curve;
                if (i > 0) feature_edge_[edges.find(run[i - 1], run[i]).index()] = 1;
            }
        }
    }

    std::vector<SearchTriangle> triangles;
    for (std::uint32_t t = 0; t < parts_->surface.triangles.size(); ++t)
        triangles.push_back(parts_->triangle(t));
    const TriangleSearch whole(std::move(triangles));
    const std::vector<std::uint32_t> region_of = parts_->make_regions(cut);

    // Pieces of the boundary between matched paths, and the region where most of each piece is.
    Components components(boundary.size());
    std::vector<std::uint32_t> quad_at(edges.size(), none);
    for (std::size_t q = 0; q < boundary.size(); ++q) {
        const HalfFaceId h = boundary.half_faces[q];
        const auto& corners = hexahedron::face_corners[static_cast<std::size_t>(HexMesh::local_face(h))];
        for (std::size_t i = 0; i < 4; ++i) {
            const int local = hexahedron::edge_between(corners[i], corners[(i + 1) % 4]);
            const EdgeId e = edges.cell_edges[HexMesh::cell_of(h).index()][static_cast<std::size_t>(local)];
            if (feature_edge_[e.index()]) continue;
            if (quad_at[e.index()] == none)
                quad_at[e.index()] = static_cast<std::uint32_t>(q);
            else
                components.join(quad_at[e.index()], q);
        }
    }
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> piece = components.numbers(count);
    std::vector<std::uint32_t> vote(boundary.size(), none);
    std::vector<char> facing(boundary.size(), 0);
    parallel_for(
        boundary.size(),
        [&](std::size_t q) {
            const auto& quad = boundary.vertices[q];
            const Vec3 centre = 0.25 * (mesh.position(quad[0]) + mesh.position(quad[1]) +
                                        mesh.position(quad[2]) + mesh.position(quad[3]));
            const Vec3 area = (mesh.position(quad[2]) - mesh.position(quad[0]))
                                  .cross(mesh.position(quad[3]) - mesh.position(quad[1]));
            const std::uint32_t t = whole.closest(centre).item;
            vote[q] = region_of[t];
            facing[q] = parts_->surface.normals[t].dot(area) > 0.0;
        },
        64);
    std::vector<std::map<std::uint32_t, std::size_t>> votes(count);
    std::vector<std::map<std::uint32_t, std::size_t>> backwards(count);
    for (std::size_t q = 0; q < boundary.size(); ++q)
        if (facing[q]) ++votes[piece[q]][vote[q]];
    // Shells of the surface may be oriented against the boundary: then nothing faces the same way.
    for (std::size_t q = 0; q < boundary.size(); ++q)
        if (votes[piece[q]].empty()) ++backwards[piece[q]][vote[q]];
    for (std::size_t p = 0; p < count; ++p)
        if (votes[p].empty()) votes[p].swap(backwards[p]);
    std::vector<std::uint32_t> region(count, 0);
    for (std::size_t p = 0; p < count; ++p) {
        std::size_t most = 0;
        for (const auto& [r, number] : votes[p]) {
            if (number <= most) continue;
            most = number;
            region[p] = r;
        }
    }
    for (const VertexId v : boundary.boundary_vertices) {
        if (freedom_[v.index()] != Freedom::region) continue;
        part_[v.index()] = region[piece[boundary.vertex_quads[v.index()].front().index()]];
    }
}

BoundaryGuide::~BoundaryGuide() = default;

BoundaryGuide::Place BoundaryGuide::nearest(VertexId v, const Vec3& p, std::optional<std::uint32_t> hint,
                                            TriangleSearch::Memory* memory) const {
    const std::uint32_t part = part_[v.index()];
    switch (freedom_[v.index()]) {
        case Freedom::region: {
            const Region& region = parts_->regions[part];
            const auto found = region.search->closest(p, hint, memory);
            return {found.point, parts_->surface.normals[region.triangles[found.item]], found.item};
        }
        case Freedom::curve: {
            const auto found = parts_->curve_search[part]->closest(p, hint);
            const auto& vertices = parts_->curves[part].vertices;
            return {found.point,
                    (parts_->surface.points[vertices[found.item + 1]] -
                     parts_->surface.points[vertices[found.item]])
                        .normalized(),
                    found.item};
        }
        case Freedom::corner:
            return {parts_->corners[part], Vec3::Zero(), 0};
        case Freedom::interior:
            break;
    }
    return {p, Vec3::Zero(), 0};
}

BoundaryGuide::Place BoundaryGuide::nearest_smooth(VertexId v, const Vec3& p,
                                                   std::optional<std::uint32_t> hint,
                                                   TriangleSearch::Memory* memory) const {
    if (freedom_[v.index()] != Freedom::curve) return nearest(v, p, hint, memory);
    const std::uint32_t part = part_[v.index()];
    const auto found = parts_->fine_search[part]->closest(p, hint);
    const auto& fine = parts_->fine_points[part];
    return {found.point, (fine[found.item + 1] - fine[found.item]).normalized(), found.item};
}

std::array<Vec3, 2> BoundaryGuide::segment(VertexId v, std::uint32_t item) const {
    const auto& vertices = parts_->curves[part_[v.index()]].vertices;
    return {parts_->surface.points[vertices[item]], parts_->surface.points[vertices[item + 1]]};
}

const GuideSurface& BoundaryGuide::surface() const {
    return parts_->surface;
}

std::vector<std::array<std::int64_t, 2>> BoundaryGuide::curve_edges() const {
    std::vector<std::array<std::int64_t, 2>> found;
    for (const SurfaceCurve& curve : parts_->curves)
        for (const std::uint32_t e : curve.edges)
            found.push_back({parts_->surface.edges[e].vertices[0], parts_->surface.edges[e].vertices[1]});
    std::sort(found.begin(), found.end());
    return found;
}

double BoundaryGuide::diagonal() const {
    return parts_->surface.diagonal;
}

}  // namespace hex::improving
