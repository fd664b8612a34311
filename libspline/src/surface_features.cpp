#include <hex/base/parallel.h>
#include <hex/surface/closest_point.h>
#include <hex/volume/topology.h>
#include <spline/surface_features.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace spline {

using hex::Vec3;

namespace {

/// A side of a boundary quad.
struct QuadSide {
    VertexPair ends;
    std::size_t quad;
};

/// All sides of the boundary quads, those of one edge one after the other.
std::vector<QuadSide> sides_by_edge(const hex::BoundaryQuads& boundary) {
    std::vector<QuadSide> sides;
    sides.reserve(4 * boundary.size());
    for (std::size_t q = 0; q < boundary.size(); ++q) {
        const auto& quad = boundary.vertices[q];
        for (std::size_t i = 0; i < 4; ++i) {
            const std::int64_t a = quad[i].value(), b = quad[(i + 1) % 4].value();
            sides.push_back({{std::min(a, b), std::max(a, b)}, q});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const QuadSide& a, const QuadSide& b) {
        return a.ends != b.ends ? a.ends < b.ends : a.quad < b.quad;
    });
    return sides;
}

/// The edges whose quads are chosen: `sharp(ends, first, last)` looks at the sides of one edge.
template <class Test>
std::vector<VertexPair> edges_where(const hex::BoundaryQuads& boundary, const Test& sharp) {
    const std::vector<QuadSide> sides = sides_by_edge(boundary);
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < sides.size(); ++i)
        if (i == 0 || sides[i].ends != sides[i - 1].ends) first.push_back(i);
    first.push_back(sides.size());
    std::vector<char> chosen(first.size() - 1);
    hex::parallel_for(chosen.size(), [&](std::size_t e) {
        chosen[e] = sharp(std::span(sides).subspan(first[e], first[e + 1] - first[e]));
    });
    std::vector<VertexPair> edges;
    for (std::size_t e = 0; e < chosen.size(); ++e)
        if (chosen[e] != 0) edges.push_back(sides[first[e]].ends);
    return edges;
}

std::vector<VertexPair> edges_between(const hex::BoundaryQuads& boundary,
                                      const std::vector<int>& patch_of_quad) {
    return edges_where(boundary, [&](std::span<const QuadSide> sides) {
        return std::any_of(sides.begin(), sides.end(), [&](const QuadSide& side) {
            return patch_of_quad[side.quad] != patch_of_quad[sides.front().quad];
        });
    });
}

/// Edges of a surface by their angle, and what meets at its vertices.
class SharpEdges {
  public:
    SharpEdges(const hex::TriangleMesh& surface, double cosine)
        : surface_(surface), sharp_(surface.n_edges(), 0), weak_(surface.n_edges(), 0) {
        constexpr double weak_cosine = 0.94;
        for (const auto e : surface.edges()) {
            if (surface.is_boundary(e)) continue;
            const auto h = surface.halfedge_handle(e, 0);
            const double c = normal(surface.face_handle(h)).dot(normal(surface.opposite_face_handle(h)));
            sharp_[index(e)] = c < cosine;
            weak_[index(e)] = c >= cosine && c < weak_cosine;
        }
    }

    std::vector<Segment> segments() {
        drop_specks();
        for (const auto v : surface_.vertices()) {
            if (!is_corner(v)) continue;
            for (const auto h : surface_.voh_range(v))
                if (weak_[index(surface_.edge_handle(h))] != 0) follow(h);
        }
        std::vector<Segment> segments;
        for (const auto e : surface_.edges()) {
            if (sharp_[index(e)] == 0 && joined_.count(e.idx()) == 0) continue;
            const auto h = surface_.halfedge_handle(e, 0);
            segments.push_back({hex::to_eigen(surface_.point(surface_.from_vertex_handle(h))),
                                hex::to_eigen(surface_.point(surface_.to_vertex_handle(h)))});
        }
        return segments;
    }

  private:
    static std::size_t index(OpenMesh::EdgeHandle e) { return static_cast<std::size_t>(e.idx()); }

    Vec3 normal(OpenMesh::FaceHandle f) const {
        std::array<Vec3, 3> corners;
        auto corner = corners.begin();
        for (const auto v : surface_.fv_range(f)) *corner++ = hex::to_eigen(surface_.point(v));
        return (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
    }
    Vec3 direction(OpenMesh::HalfedgeHandle h) const {
        return hex::to_eigen(surface_.point(surface_.to_vertex_handle(h)) -
                             surface_.point(surface_.from_vertex_handle(h)))
            .stableNormalized();
    }

    /// Sharp edges end, meet or bend here.
    bool is_corner(OpenMesh::VertexHandle v) const {
        constexpr double bend_cosine = 0.7;
        std::vector<Vec3> directions;
        for (const auto h : surface_.voh_range(v))
            if (sharp_[index(surface_.edge_handle(h))] != 0) directions.push_back(direction(h));
        if (directions.size() == 2) return -directions[0].dot(directions[1]) < bend_cosine;
        return !directions.empty();
    }

    /// Sharp edges that hang together, but are few and have an open end, are not sharp.
    void drop_specks() {
        constexpr std::size_t fewest = 6;
        std::vector<char> seen(surface_.n_vertices(), 0);
        for (const auto start : surface_.vertices()) {
            if (seen[static_cast<std::size_t>(start.idx())] != 0) continue;
            std::vector<OpenMesh::VertexHandle> reached = {start};
            seen[static_cast<std::size_t>(start.idx())] = 1;
            std::set<std::size_t> edges;
            bool open = false;
            for (std::size_t i = 0; i < reached.size(); ++i) {
                std::size_t sharp_here = 0;
                for (const auto h : surface_.voh_range(reached[i])) {
                    const std::size_t e = index(surface_.edge_handle(h));
                    if (sharp_[e] == 0) continue;
                    ++sharp_here;
                    edges.insert(e);
                    const auto next = surface_.to_vertex_handle(h);
                    char& flag = seen[static_cast<std::size_t>(next.idx())];
                    if (flag == 0) reached.push_back(next);
                    flag = 1;
                }
                open = open || sharp_here == 1;
            }
            if (!open || edges.size() >= fewest) continue;
            for (const std::size_t e : edges) sharp_[e] = 0;
        }
    }

    /// Along weak edges to the next corner; without one nothing is joined.
    void follow(OpenMesh::HalfedgeHandle h) {
        std::vector<int> chain;
        for (std::size_t steps = 0; steps < surface_.n_edges(); ++steps) {
            chain.push_back(surface_.edge_handle(h).idx());
            const auto v = surface_.to_vertex_handle(h);
            if (is_corner(v)) {
                joined_.insert(chain.begin(), chain.end());
                return;
            }
            OpenMesh::HalfedgeHandle next;
            std::size_t ways = 0;
            for (const auto out : surface_.voh_range(v)) {
                const auto e = surface_.edge_handle(out);
                if (sharp_[index(e)] != 0) return;
                if (weak_[index(e)] == 0 || e == surface_.edge_handle(h)) continue;
                next = out;
                ++ways;
            }
            if (ways != 1) return;
            h = next;
        }
    }

    const hex::TriangleMesh& surface_;
    std::vector<char> sharp_, weak_;
    std::set<int> joined_;
};

}  // namespace

std::vector<VertexPair> edges_between_parts(const hex::HexMesh& mesh) {
    const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    std::vector<int> part(boundary.size());
    for (std::size_t q = 0; q < part.size(); ++q)
        part[q] = mesh.part(hex::HexMesh::cell_of(boundary.half_faces[q]));
    return edges_between(boundary, part);
}

std::vector<VertexPair> edges_between_patches(const hex::HexMesh& mesh, const hex::TriangleMesh& surface) {
    const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    const hex::ClosestPoint search(surface);
    std::vector<int> patch(boundary.size());
    hex::parallel_for(
        patch.size(),
        [&](std::size_t q) {
            const auto& quad = boundary.vertices[q];
            const auto corner = [&](std::size_t i) { return mesh.position(quad[i]); };
            std::array<int, 9> found{};
            auto next = found.begin();
            std::uint32_t hint = 0;
            for (const double s : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
                for (const double t : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
                    const Vec3 p = (1.0 - t) * ((1.0 - s) * corner(0) + s * corner(1)) +
                                   t * ((1.0 - s) * corner(3) + s * corner(2));
                    hint = search(p, hint).triangle;
                    *next++ = surface.data(OpenMesh::FaceHandle(static_cast<int>(hint))).part;
                }
            }
            std::sort(found.begin(), found.end());
            std::ptrdiff_t most = 0;
            for (const int part : found) {
                const auto votes = std::count(found.begin(), found.end(), part);
                if (votes <= most) continue;
                most = votes;
                patch[q] = part;
            }
        },
        16);
    return edges_between(boundary, patch);
}

std::vector<Segment> sharp_segments(const hex::TriangleMesh& surface, double cosine) {
    return SharpEdges(surface, cosine).segments();
}

std::vector<VertexPair> edges_along(const hex::HexMesh& mesh, std::span<const Segment> segments) {
    if (segments.empty()) return {};
    const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    const hex::ClosestOnSegments search(segments);
    constexpr double runs_along = 0.8, near = 0.25;
    return edges_where(boundary, [&](std::span<const QuadSide> sides) {
        const Vec3 a = mesh.position(hex::VertexId(static_cast<std::size_t>(sides.front().ends[0])));
        const Vec3 b = mesh.position(hex::VertexId(static_cast<std::size_t>(sides.front().ends[1])));
        const double length = (b - a).norm();
        if (!(length > 0.0)) return false;
        // Of a thin row of quads beside a sharp edge only the one side is on it.
        double width = length;
        for (const QuadSide& side : sides) {
            const auto& quad = boundary.vertices[side.quad];
            const double area = 0.5 * (mesh.position(quad[2]) - mesh.position(quad[0]))
                                          .cross(mesh.position(quad[3]) - mesh.position(quad[1]))
                                          .norm();
            width = std::min(width, area / length);
        }
        for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            const auto found = search(a + t * (b - a), near * width);
            if (!found) return false;
            if (t == 0.0 || t == 1.0) continue;
            const Vec3 along = segments[found->segment][1] - segments[found->segment][0];
            if (std::abs(along.normalized().dot(b - a)) < runs_along * length) return false;
        }
        return true;
    });
}

}  // namespace spline
