#include "polycube/cut_mesh.h"

#include "polycube/flat_region.h"

#include <hex/base/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hex {

CutMesh::CutMesh(const CutProblem& problem) : nodes_(problem.nodes) {
    for (const Vec3& p : problem.points) mesh_.add_vertex(to_openmesh(p));
    for (const auto& t : problem.triangles)
        if (!mesh_.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])).is_valid())
            throw Error(ErrorKind::no_result, "a chart of the polycube is no manifold");
    places_.assign(mesh_.n_vertices(), Vec2::Zero());
    fixed_.assign(mesh_.n_vertices(), 0);
    node_at_.assign(mesh_.n_vertices(), -1);
    line_of_edge_.assign(mesh_.n_edges(), -1);
    region_of_.assign(mesh_.n_faces(), 0);
    for (std::size_t n = 0; n < nodes_.size(); ++n)
        if (nodes_[n].vertex >= 0) node_at_[index(Vertex(nodes_[n].vertex))] = static_cast<int>(n);
}

void CutMesh::enter(const std::vector<Face>& faces) {
    ++region_;
    for (const auto f : faces) region_of_[index(f)] = region_;
}

std::vector<CutMesh::Face> CutMesh::faces_of_region() const {
    std::vector<Face> faces;
    for (const auto f : mesh_.faces())
        if (in_region(f)) faces.push_back(f);
    return faces;
}

std::vector<CutMesh::Loop> CutMesh::rim_loops() const {
    std::vector<Loop> loops;
    std::vector<char> seen(mesh_.n_halfedges(), 0);
    for (const auto h : mesh_.halfedges()) {
        if (!in_region(mesh_.face_handle(h)) || !on_rim(h) || seen[index(h)]) continue;
        auto& loop = loops.emplace_back();
        Halfedge walk = h;
        do {
            seen[index(walk)] = 1;
            loop.push_back(walk);
            walk = mesh_.next_halfedge_handle(walk);
            while (!on_rim(walk)) walk = mesh_.next_halfedge_handle(mesh_.opposite_halfedge_handle(walk));
        } while (walk != h);
    }
    return loops;
}

void CutMesh::mark_rim(const std::vector<Loop>& loops) {
    std::fill(fixed_.begin(), fixed_.end(), 0);
    for (const auto& loop : loops)
        for (const auto h : loop) fixed_[index(mesh_.from_vertex_handle(h))] = 1;
}

void CutMesh::split_bridges() {
    const std::size_t count = mesh_.n_edges();
    for (std::size_t i = 0; i < count; ++i) {
        const Edge e(static_cast<int>(i));
        const Halfedge h = mesh_.halfedge_handle(e, 0);
        if (mesh_.is_boundary(e) || !in_region(mesh_.face_handle(h)) || on_rim(h)) continue;
        const Vertex a = mesh_.from_vertex_handle(h);
        const Vertex b = mesh_.to_vertex_handle(h);
        if (fixed_[index(a)] && fixed_[index(b)])
            split(e, 0.5 * (point(a) + point(b)), 0.5 * (place(a) + place(b)));
    }
}

bool CutMesh::is_simply_connected() const {
    std::vector<char> vertex(mesh_.n_vertices(), 0);
    std::vector<char> edge(mesh_.n_edges(), 0);
    int characteristic = 0;
    const auto count = [&](char& seen, int sign) {
        if (!seen) characteristic += sign;
        seen = 1;
    };
    for (const auto f : mesh_.faces()) {
        if (!in_region(f)) continue;
        ++characteristic;
        for (const auto h : mesh_.fh_range(f)) {
            count(vertex[index(mesh_.to_vertex_handle(h))], 1);
            count(edge[index(mesh_.edge_handle(h))], -1);
        }
    }
    return characteristic == 1;
}

void CutMesh::round_rim(const Loop& rim) {
    double total = 0.0;
    for (const auto h : rim) total += length(h);
    double sum = 0.0;
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const double share = total > 0.0 ? sum / total : double(i) / double(rim.size());
        const double angle = 2.0 * std::numbers::pi * share;
        place(mesh_.from_vertex_handle(rim[i])) = {std::cos(angle), std::sin(angle)};
        sum += length(rim[i]);
    }
}

bool CutMesh::flatten() {
    return flatten_region(mesh_, faces_of_region(), fixed_, places_);
}

void CutMesh::add_crossing_candidate(Vertex v, int line) {
    const CutLine& of = lines_[static_cast<std::size_t>(line)];
    for (std::size_t k = 1; k + 1 < of.nodes.size(); ++k) crossing_candidates_.insert({of.nodes[k], v.idx()});
}

CutMesh::Vertex CutMesh::split(Edge e, const Vec3& point, const Vec2& place) {
    const Halfedge h = mesh_.halfedge_handle(e, 0);
    const Vertex a = mesh_.from_vertex_handle(h);
    const Vertex b = mesh_.to_vertex_handle(h);
    const int line = line_of_edge_[index(e)];
    const Face left = mesh_.face_handle(h);
    const Face right = mesh_.face_handle(mesh_.opposite_halfedge_handle(h));
    const int left_region = left.is_valid() ? region_of_[index(left)] : -1;
    const int right_region = right.is_valid() ? region_of_[index(right)] : -1;
    const Vertex left_apex =
        left.is_valid() ? mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h)) : Vertex();
    const Vertex v = mesh_.add_vertex(to_openmesh(point));
    places_.push_back(place);
    fixed_.push_back(0);
    node_at_.push_back(-1);
    mesh_.split(e, v);
    line_of_edge_.resize(mesh_.n_edges(), -1);
    region_of_.resize(mesh_.n_faces(), -1);
    for (const auto out : mesh_.voh_range(v)) {
        const Vertex to = mesh_.to_vertex_handle(out);
        const bool half = to == a || to == b;
        line_of_edge_[index(mesh_.edge_handle(out))] = half ? line : -1;
        const Face f = mesh_.face_handle(out);
        if (!f.is_valid()) continue;
        // The faces at the left apex lie left of a -> b.
        const Vertex third = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(out));
        const bool is_left = left_apex.is_valid() && (to == left_apex || third == left_apex);
        region_of_[index(f)] = is_left ? left_region : right_region;
    }
    return v;
}

}  // namespace hex
