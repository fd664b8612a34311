#include "polycube/straight_cut.h"

#include "polycube/flat_region.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hex {
namespace {

using Face = CutMesh::Face;
using Halfedge = CutMesh::Halfedge;
using Edge = CutMesh::Edge;
using Vertex = CutMesh::Vertex;

/// A vertex that a line meets within this share of an edge is moved onto the line.
constexpr double snap_share = 0.12;

class StraightCut {
  public:
    StraightCut(CutMesh& cut_mesh, const CutLine& line)
        : cut_(cut_mesh),
          mesh_(cut_mesh.triangles()),
          start_(cut_mesh.vertex_of(line.nodes.front())),
          goal_(cut_mesh.vertex_of(line.nodes.back())),
          a_(cut_mesh.place(start_)),
          b_(cut_mesh.place(goal_)),
          way_(b_ - a_) {}

    std::optional<std::vector<Vertex>> walk() {
        const int number = cut_.next_line();
        std::vector<Vertex> path = {start_};
        const std::size_t limit = 4 * mesh_.n_faces() + 16;
        while (path.back() != goal_) {
            if (path.size() > limit) return std::nullopt;
            const std::optional<Halfedge> step = next_step(path.back());
            if (!step) return std::nullopt;
            cut_.put_on_line(*step, number);
            path.push_back(mesh_.to_vertex_handle(*step));
        }
        return path;
    }

  private:
    /// The half-edge along which the line goes on; makes it by splitting the edge ahead if need be.
    std::optional<Halfedge> next_step(Vertex here) {
        for (const auto h : mesh_.voh_range(here)) {
            const bool inside = cut_.in_region(mesh_.face_handle(h)) ||
                                cut_.in_region(mesh_.face_handle(mesh_.opposite_halfedge_handle(h)));
            if (!inside) continue;
            const Vertex p = mesh_.to_vertex_handle(h);
            if (p == goal_ && !cut_.on_rim(h)) return h;
            if (cut_.on_rim(p)) continue;
            if (side(p) == 0 && (cut_.place(p) - cut_.place(here)).dot(way_) > 0.0) return h;
        }
        for (const auto h : mesh_.voh_range(here)) {
            if (!cut_.in_region(mesh_.face_handle(h))) continue;
            const Halfedge opposite = mesh_.next_halfedge_handle(h);
            const Vertex p = mesh_.from_vertex_handle(opposite);
            const Vertex q = mesh_.to_vertex_handle(opposite);
            if (side(p) >= 0 || side(q) <= 0 || crosses_backwards(here, p, q)) continue;
            return cross(here, opposite);
        }
        return std::nullopt;
    }

    int side(Vertex v) const { return side_of_line(a_, b_, cut_.place(v)); }

    bool crosses_backwards(Vertex here, Vertex p, Vertex q) const {
        const Vec2& o = cut_.place(here);
        return (cut_.place(p) - o).dot(way_) <= 0.0 && (cut_.place(q) - o).dot(way_) <= 0.0;
    }

    /// Exactly on lines that are parallel to an axis.
    Vec2 on_line(Vec2 place) const {
        if (a_.x() == b_.x()) place.x() = a_.x();
        if (a_.y() == b_.y()) place.y() = a_.y();
        return place;
    }

    /// Goes on across an edge: to one of its ends, if that can be moved onto the line, or to a new vertex.
    std::optional<Halfedge> cross(Vertex here, Halfedge edge) {
        const Vertex p = mesh_.from_vertex_handle(edge);
        const Vertex q = mesh_.to_vertex_handle(edge);
        const Vec2 at_p = cut_.place(p);
        const Vec2 at_q = cut_.place(q);
        const double dp = distance_to_line(at_p);
        const double dq = distance_to_line(at_q);
        const double share = dp + dq > 0.0 ? dp / (dp + dq) : 0.5;
        Vec2 crossing = on_line((1.0 - share) * at_p + share * at_q);
        for (int c = 0; c < 2; ++c)
            if (at_p[c] == at_q[c]) crossing[c] = at_p[c];
        const Edge e = mesh_.edge_handle(edge);
        const int across = cut_.line_of(e);
        if (share < snap_share && move_onto_line(p, across, crossing)) return mesh_.find_halfedge(here, p);
        if (share > 1.0 - snap_share && move_onto_line(q, across, crossing))
            return mesh_.find_halfedge(here, q);
        if (cut_.on_rim(edge) && across < 0) return std::nullopt;
        if (across >= cut_.next_line()) return std::nullopt;
        const double bounded = std::clamp(share, 0.02, 0.98);
        const Vertex v = cut_.split(e, (1.0 - bounded) * cut_.point(p) + bounded * cut_.point(q), crossing);
        if (across >= 0) cut_.add_crossing_candidate(v, across);
        return mesh_.find_halfedge(here, v);
    }

    double distance_to_line(const Vec2& place) const {
        const Vec2 way = way_.normalized();
        const Vec2 d = place - a_;
        return std::abs(way.x() * d.y() - way.y() * d.x());
    }

    /// Moves a vertex in the plane onto the line, unless it is needed where it is or a triangle would flip.
    /// One on another line may only slide along that line, when the edge to cross is part of it (`across`).
    bool move_onto_line(Vertex v, int across, const Vec2& crossing) {
        if (cut_.on_rim(v) || cut_.node_at(v) >= 0) return false;
        bool on_other = false;
        for (const auto h : mesh_.voh_range(v)) {
            const int line = cut_.line_of(h);
            on_other = on_other || line >= 0;
            if (line >= 0 && line != across) return false;
        }
        const Vec2 before = cut_.place(v);
        const Vec2 way = way_.normalized();
        const Vec2 foot = on_line(a_ + way * way.dot(before - a_));
        for (const Vec2& target : {on_other ? crossing : foot, crossing}) {
            cut_.place(v) = target;
            bool good = true;
            for (const auto f : mesh_.vf_range(v)) good = good && keeps_its_side(f);
            if (good) return true;
        }
        cut_.place(v) = before;
        return false;
    }

    bool keeps_its_side(Face f) const {
        std::array<Vec2, 3> p;
        std::size_t k = 0;
        for (const auto v : mesh_.fv_range(f)) p[k++] = cut_.place(v);
        return counter_clockwise(p[0], p[1], p[2]);
    }

    CutMesh& cut_;
    const TriangleMesh& mesh_;
    Vertex start_;
    Vertex goal_;
    Vec2 a_;
    Vec2 b_;
    Vec2 way_;
};

}  // namespace

std::optional<std::vector<CutMesh::Vertex>> cut_straight(CutMesh& cut_mesh, const CutLine& line) {
    return StraightCut(cut_mesh, line).walk();
}

}  // namespace hex
