#include <hex/surface/patch_layout.h>

#include <algorithm>
#include <string>

namespace hex {
namespace {

using Halfedge = TriangleMesh::HalfedgeHandle;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Components of equal part, numbered in the order of their first triangles.
void collect_components(const TriangleMesh& mesh, PatchLayout& layout) {
    layout.patch_of_triangle.assign(mesh.n_faces(), -1);
    std::vector<TriangleMesh::FaceHandle> open;
    for (const auto start : mesh.faces()) {
        if (layout.patch_of_triangle[at(start.idx())] >= 0) continue;
        const int patch = static_cast<int>(layout.patches.size());
        layout.patches.emplace_back().part = mesh.data(start).part;
        layout.patch_of_triangle[at(start.idx())] = patch;
        open.assign(1, start);
        while (!open.empty()) {
            const auto face = open.back();
            open.pop_back();
            for (const auto next : mesh.ff_range(face)) {
                if (layout.patch_of_triangle[at(next.idx())] >= 0 ||
                    mesh.data(next).part != mesh.data(start).part)
                    continue;
                layout.patch_of_triangle[at(next.idx())] = patch;
                open.push_back(next);
            }
        }
    }
    for (const auto f : mesh.faces())
        layout.patches[at(layout.patch_of_triangle[at(f.idx())])].triangles.push_back(f.idx());
}

void find_corners(const TriangleMesh& mesh, PatchLayout& layout) {
    layout.valence.assign(mesh.n_vertices(), 0);
    std::vector<int> around;
    for (const auto v : mesh.vertices()) {
        around.clear();
        for (const auto f : mesh.vf_range(v)) around.push_back(layout.patch_of_triangle[at(f.idx())]);
        std::sort(around.begin(), around.end());
        const auto distinct = std::unique(around.begin(), around.end()) - around.begin();
        layout.valence[at(v.idx())] = static_cast<int>(distinct);
        if (distinct >= 3) layout.corners.push_back(v.idx());
    }
}

class LoopCollector {
  public:
    LoopCollector(const TriangleMesh& mesh, const PatchLayout& layout)
        : mesh_(mesh), layout_(layout), visited_(mesh.n_halfedges(), 0) {}

    void collect(int index, Patch& patch) {
        patch_ = index;
        // A loop starts at the first corner met when scanning triangles and their vertices; loops without
        // corners come last.
        for (const bool need_corner : {true, false}) {
            for (const int t : patch.triangles) {
                for (const Halfedge h : halfedges_in_vertex_order(t)) {
                    if (need_corner && !is_corner(mesh_.from_vertex_handle(h).idx())) continue;
                    const Halfedge start = boundary_from(h);
                    if (start.is_valid() && !visited_[at(start.idx())]) patch.loops.push_back(walk(start));
                }
            }
        }
    }

  private:
    bool is_corner(int vertex) const { return layout_.valence[at(vertex)] >= 3; }

    bool in_patch(Halfedge h) const {
        const auto face = mesh_.face_handle(h);
        return face.is_valid() && layout_.patch_of_triangle[at(face.idx())] == patch_;
    }
    bool on_boundary(Halfedge h) const { return !in_patch(mesh_.opposite_halfedge_handle(h)); }

    /// The three half-edges of a triangle that start at its vertices 0, 1, 2.
    std::array<Halfedge, 3> halfedges_in_vertex_order(int triangle) const {
        std::array<Halfedge, 3> result;
        const auto face = mesh_.face_handle(static_cast<unsigned>(triangle));
        auto vertex = mesh_.cfv_iter(face);
        for (Halfedge& h : result) {
            for (const Halfedge candidate : mesh_.fh_range(face)) {
                if (mesh_.from_vertex_handle(candidate) == *vertex) h = candidate;
            }
            ++vertex;
        }
        return result;
    }

    /// Turning about the start of `h` (a half-edge inside the patch) away from its face, the half-edge of the
    /// patch that runs on its boundary; none when the whole turn stays inside.
    Halfedge boundary_from(Halfedge h) const {
        const Halfedge begin = h;
        do {
            if (on_boundary(h)) return h;
            h = mesh_.next_halfedge_handle(mesh_.opposite_halfedge_handle(h));
        } while (h != begin);
        return Halfedge();
    }

    std::vector<Chain> walk(Halfedge start) {
        std::vector<Chain> chains;
        Chain chain = {mesh_.from_vertex_handle(start).idx()};
        Halfedge h = start;
        do {
            visited_[at(h.idx())] = 1;
            const int end = mesh_.to_vertex_handle(h).idx();
            chain.push_back(end);
            if (is_corner(end)) {
                chains.push_back(std::move(chain));
                chain = {end};
            }
            h = boundary_from(mesh_.next_halfedge_handle(h));
        } while (h != start);
        if (chain.size() > 1) chains.push_back(std::move(chain));
        return chains;
    }

    const TriangleMesh& mesh_;
    const PatchLayout& layout_;
    std::vector<char> visited_;
    int patch_ = -1;
};

int euler_characteristic(const TriangleMesh& mesh, const Patch& patch) {
    std::vector<int> vertices, edges;
    for (const int t : patch.triangles) {
        const auto face = mesh.face_handle(static_cast<unsigned>(t));
        for (const auto v : mesh.fv_range(face)) vertices.push_back(v.idx());
        for (const auto e : mesh.fe_range(face)) edges.push_back(e.idx());
    }
    const auto distinct = [](std::vector<int>& ids) {
        std::sort(ids.begin(), ids.end());
        return static_cast<int>(std::unique(ids.begin(), ids.end()) - ids.begin());
    };
    return distinct(vertices) - distinct(edges) + static_cast<int>(patch.triangles.size());
}

/// Vertices that the boundary of the patch passes more than once, ascending.
std::vector<std::int64_t> vertices_passed_twice(const Patch& patch) {
    std::vector<std::int64_t> visits, twice;
    for (const auto& loop : patch.loops) {
        for (const Chain& chain : loop) visits.insert(visits.end(), chain.begin(), chain.end() - 1);
    }
    std::sort(visits.begin(), visits.end());
    for (std::size_t i = 1; i < visits.size(); ++i) {
        if (visits[i] == visits[i - 1] && (twice.empty() || twice.back() != visits[i]))
            twice.push_back(visits[i]);
    }
    return twice;
}

std::vector<std::int64_t> loop_corners(const PatchLayout& layout, const std::vector<Chain>& loop) {
    std::vector<std::int64_t> corners;
    for (const Chain& chain : loop) {
        if (layout.valence[at(chain.front())] >= 3) corners.push_back(chain.front());
    }
    return corners;
}

}  // namespace

PatchLayout find_patches(const TriangleMesh& mesh) {
    PatchLayout layout;
    collect_components(mesh, layout);
    find_corners(mesh, layout);
    LoopCollector collector(mesh, layout);
    for (std::size_t p = 0; p < layout.patches.size(); ++p) {
        Patch& patch = layout.patches[p];
        collector.collect(static_cast<int>(p), patch);
        patch.euler_characteristic = euler_characteristic(mesh, patch);
        patch.four_sided = patch.euler_characteristic == 1 && patch.loops.size() == 1 &&
                           patch.loops[0].size() == 4 && loop_corners(layout, patch.loops[0]).size() == 4 &&
                           vertices_passed_twice(patch).empty();
        if (!patch.four_sided) continue;
        for (std::size_t c = 0; c < 4; ++c) patch.corners[c] = patch.loops[0][c].front();
    }
    return layout;
}

Diagnostics diagnose_layout(const PatchLayout& layout) {
    Diagnostics diagnostics;
    for (std::size_t p = 0; p < layout.patches.size(); ++p) {
        const Patch& patch = layout.patches[p];
        if (patch.four_sided) continue;
        const auto report = [&](const char* code, const std::string& what) {
            diagnostics.push_back({Severity::error,
                                   code,
                                   "patch " + std::to_string(p) + " (part " + std::to_string(patch.part) +
                                       ", " + std::to_string(patch.triangles.size()) +
                                       " triangles from triangle " + std::to_string(patch.triangles.front()) +
                                       ") " + what,
                                   "patch",
                                   {static_cast<std::int64_t>(p)}});
        };
        if (patch.loops.empty()) {
            report("patch-closed", "is a closed surface without boundary");
            continue;
        }
        if (patch.loops.size() > 1) {
            std::vector<std::int64_t> starts;
            for (const auto& loop : patch.loops) starts.push_back(loop.front().front());
            report("patch-loops", "has " + std::to_string(patch.loops.size()) +
                                      " boundary loops instead of one, through vertices " + list_ids(starts));
        } else if (const auto corners = loop_corners(layout, patch.loops[0]); corners.size() != 4) {
            report("patch-corners",
                   "has " + std::to_string(corners.size()) + " corners instead of four" +
                       (corners.empty() ? std::string() : ": vertices " + list_ids(corners)));
        }
        if (const auto twice = vertices_passed_twice(patch); !twice.empty())
            report("patch-boundary", "has a boundary that passes vertices twice: " + list_ids(twice));
        if (patch.loops.size() == 1 && patch.euler_characteristic != 1)
            report("patch-not-a-disk",
                   "is not a disk (Euler characteristic " + std::to_string(patch.euler_characteristic) + ")");
    }
    return diagnostics;
}

}  // namespace hex
