/// \file cut_mesh.h
/// The triangles of a chart while they are being cut: flat places, the region at work, the edges of cuts.
#pragma once

#include "polycube/chart_cutter.h"

#include <hex/surface/mesh_types.h>

#include <set>
#include <utility>
#include <vector>

namespace hex {

/// A manifold triangle mesh whose vertices have a place in the plane and may be nodes of lines, whose edges
/// may lie on a line that has been cut, and of whose faces one region is at work. The rim of the region are
/// its edges that lie on a line or beside another region.
class CutMesh {
  public:
    using Face = TriangleMesh::FaceHandle;
    using Halfedge = TriangleMesh::HalfedgeHandle;
    using Edge = TriangleMesh::EdgeHandle;
    using Vertex = TriangleMesh::VertexHandle;
    /// Half-edges one behind the other, the region on their left.
    using Loop = std::vector<Halfedge>;

    /// Throws Error{no_result} when the triangles are no manifold.
    explicit CutMesh(const CutProblem& problem);

    const TriangleMesh& triangles() const { return mesh_; }
    Vec3 point(Vertex v) const { return to_eigen(mesh_.point(v)); }
    double length(Halfedge h) const {
        return (point(mesh_.to_vertex_handle(h)) - point(mesh_.from_vertex_handle(h))).norm();
    }
    /// In the plane.
    Vec2& place(Vertex v) { return places_[index(v)]; }
    const Vec2& place(Vertex v) const { return places_[index(v)]; }
    /// The node at a vertex, or -1.
    int node_at(Vertex v) const { return node_at_[index(v)]; }
    int node_from(Halfedge h) const { return node_at(mesh_.from_vertex_handle(h)); }
    const CutNode& node(int n) const { return nodes_[static_cast<std::size_t>(n)]; }
    const std::vector<CutNode>& nodes() const { return nodes_; }
    Vertex vertex_of(int node) const { return Vertex(this->node(node).vertex); }
    void set_node(int node, Vertex v) {
        nodes_[static_cast<std::size_t>(node)].vertex = v.idx();
        node_at_[index(v)] = node;
    }

    // --- the region at work
    void enter(const std::vector<Face>& faces);
    bool in_region(Face f) const { return f.is_valid() && region_of_[index(f)] == region_; }
    bool on_rim(Halfedge h) const {
        return line_of(h) >= 0 || !in_region(mesh_.face_handle(mesh_.opposite_halfedge_handle(h)));
    }
    /// Of the rim that mark_rim() was told.
    bool on_rim(Vertex v) const { return fixed_[index(v)] != 0; }
    std::vector<Face> faces_of_region() const;
    std::vector<Loop> rim_loops() const;
    void mark_rim(const std::vector<Loop>& loops);
    /// Inner edges that join two vertices of the rim are cut in two.
    void split_bridges();
    bool is_simply_connected() const;
    /// The rim of a disk on a circle, by length.
    void round_rim(const Loop& rim);
    /// Places the inner vertices, the rim as it is; false when a triangle comes out flipped.
    bool flatten();

    // --- lines
    /// The number of the line that an edge was cut for, or -1.
    int line_of(Edge e) const { return line_of_edge_[index(e)]; }
    int line_of(Halfedge h) const { return line_of(mesh_.edge_handle(h)); }
    int next_line() const { return static_cast<int>(lines_.size()); }
    void put_on_line(Halfedge h, int line) { line_of_edge_[index(mesh_.edge_handle(h))] = line; }
    /// Ends the line next_line().
    void finish_line(const CutLine& line) { lines_.push_back(line); }
    /// A vertex of a finished line may be any of the crossings on it.
    void add_crossing_candidate(Vertex v, int line);
    bool is_crossing_candidate(int node, Vertex v) const {
        return crossing_candidates_.contains({node, v.idx()});
    }

    /// Splits an edge; its halves keep its line, the two faces beside it their region.
    Vertex split(Edge e, const Vec3& point, const Vec2& place);

  private:
    template <class Handle>
    static std::size_t index(Handle handle) {
        return static_cast<std::size_t>(handle.idx());
    }

    TriangleMesh mesh_;
    std::vector<CutNode> nodes_;
    std::vector<Vec2> places_;
    std::vector<char> fixed_;  ///< on the rim of the region at work
    std::vector<int> node_at_;
    std::vector<int> line_of_edge_;
    std::vector<int> region_of_;
    int region_ = 0;
    std::vector<CutLine> lines_;
    std::set<std::pair<int, int>> crossing_candidates_;  ///< node, vertex
};

}  // namespace hex
