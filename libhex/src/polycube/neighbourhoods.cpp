#include "polycube/neighbourhoods.h"

#include <hex/segment/segment.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

template <class T>
void sort_unique(std::vector<T>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

Diagnostic finding(const char* code, std::string message, std::vector<std::int64_t> patches) {
    return {Severity::error, code, std::move(message), "patch", std::move(patches)};
}

/// Twice the vector area of a patch: the direction it faces on the whole.
Vec3 facing(const TriangleMesh& mesh, const Patch& patch) {
    Vec3 sum = Vec3::Zero();
    for (const int t : patch.triangles) {
        std::array<Vec3, 3> p;
        std::size_t k = 0;
        for (const auto v : mesh.fv_range(mesh.face_handle(static_cast<unsigned>(t))))
            p[k++] = to_eigen(mesh.point(v));
        sum += (p[1] - p[0]).cross(p[2] - p[0]);
    }
    return sum;
}

bool parts_are_labels(const TriangleMesh& mesh, const PatchLayout& layout) {
    return std::all_of(layout.patches.begin(), layout.patches.end(), [&](const Patch& patch) {
        return patch.part >= 1 && patch.part <= 6 &&
               facing(mesh, patch).dot(label_axis(patch.part - 1)) > 0.0;
    });
}

void find_opposite_labels(const TriangleMesh& mesh, const PatchLayout& layout, Diagnostics& found) {
    if (!parts_are_labels(mesh, layout)) return;
    std::map<std::array<int, 2>, std::vector<std::int64_t>> opposite;  // vertices by pair of patches
    for (const auto e : mesh.edges()) {
        const auto h = mesh.halfedge_handle(e, 0);
        const auto left = mesh.face_handle(h);
        const auto right = mesh.face_handle(mesh.opposite_halfedge_handle(h));
        if (!left.is_valid() || !right.is_valid()) continue;
        const auto [a, b] =
            std::minmax(layout.patch_of_triangle[at(left.idx())], layout.patch_of_triangle[at(right.idx())]);
        const int label_a = layout.patches[at(a)].part - 1;
        const int label_b = layout.patches[at(b)].part - 1;
        if (label_a == label_b || label_a / 2 != label_b / 2) continue;
        auto& vertices = opposite[{a, b}];
        vertices.push_back(mesh.from_vertex_handle(h).idx());
        vertices.push_back(mesh.to_vertex_handle(h).idx());
    }
    for (auto& [pair, vertices] : opposite) {
        sort_unique(vertices);
        const auto name = [&](int patch) {
            return std::to_string(patch) + " (" + label_name(layout.patches[at(patch)].part - 1) + ")";
        };
        found.push_back(finding("opposite-labels-adjacent",
                                "patches " + name(pair[0]) + " and " + name(pair[1]) +
                                    " face opposite ways and share an edge: vertices " + list_ids(vertices),
                                {pair[0], pair[1]}));
    }
}

void find_equal_corners(const PatchLayout& layout, Diagnostics& found) {
    std::map<std::array<int, 4>, std::vector<std::int64_t>> patches_at;
    for (std::size_t p = 0; p < layout.patches.size(); ++p) {
        if (!layout.patches[p].four_sided) continue;
        auto corners = layout.patches[p].corners;
        std::sort(corners.begin(), corners.end());
        patches_at[corners].push_back(static_cast<std::int64_t>(p));
    }
    for (const auto& [corners, patches] : patches_at) {
        if (patches.size() > 1)
            found.push_back(finding("patches-share-all-corners",
                                    "patches " + list_ids(patches) +
                                        " have the same four corners: vertices " +
                                        list_ids({corners.begin(), corners.end()}),
                                    patches));
    }
}

void find_ambiguous_edges(const PatchLayout& layout, Diagnostics& found) {
    // A mesh edge between patches lies on one chain only, so the first edge tells chains apart.
    struct Use {
        std::int64_t patch;
        int second_vertex;
    };
    std::map<std::array<int, 2>, std::vector<Use>> uses;  // by end corners
    for (std::size_t p = 0; p < layout.patches.size(); ++p) {
        if (!layout.patches[p].four_sided) continue;
        for (const Chain& chain : layout.patches[p].loops[0]) {
            const auto [first, last] = std::minmax(chain.front(), chain.back());
            uses[{first, last}].push_back(
                {static_cast<std::int64_t>(p), chain.front() == first ? chain[1] : chain[chain.size() - 2]});
        }
    }
    for (const auto& [ends, of] : uses) {
        const int second = of.front().second_vertex;
        if (std::all_of(of.begin(), of.end(), [=](const Use& use) { return use.second_vertex == second; }))
            continue;
        std::vector<std::int64_t> patches;
        for (const Use& use : of) patches.push_back(use.patch);
        sort_unique(patches);
        found.push_back(finding("edge-not-unique",
                                "patches " + list_ids(patches) +
                                    " have different edges between the corners " + std::to_string(ends[0]) +
                                    " and " + std::to_string(ends[1]),
                                patches));
    }
}

}  // namespace

Diagnostics diagnose_neighbourhoods(const TriangleMesh& mesh, const PatchLayout& layout) {
    Diagnostics found;
    find_opposite_labels(mesh, layout, found);
    find_equal_corners(layout, found);
    find_ambiguous_edges(layout, found);
    return found;
}

}  // namespace hex
