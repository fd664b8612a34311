#include "polycube/patch_triangles.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

void sort_once(std::vector<int>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// Sorts the edges and goes through the runs of equal ones: use(edge, how often).
template <class Use>
void for_each_edge(std::vector<std::array<int, 2>>& edges, const Use& use) {
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i;
        while (end < edges.size() && edges[end] == edges[i]) ++end;
        use(edges[i], end - i);
        i = end;
    }
}

}  // namespace

PatchTriangles::PatchTriangles(const Triangles& triangles, const std::vector<int>& patch) {
    int count = 0;
    for (const int p : patch) count = std::max(count, p + 1);
    std::vector<std::vector<int>> of_patch(at(count));
    for (std::size_t t = 0; t < triangles.size(); ++t) of_patch[at(patch[t])].push_back(static_cast<int>(t));
    patches_.resize(at(count));
    for (int p = 0; p < count; ++p) replace(p, std::move(of_patch[at(p)]), triangles);
}

const std::vector<int>& PatchTriangles::triangles(int patch) const {
    return patches_[at(patch)].triangles;
}

std::vector<int> PatchTriangles::inner_vertices(const std::vector<int>& patches) const {
    std::vector<int> vertices;
    std::vector<Edge> edges;
    for (const int p : patches) {
        const Patch& patch = patches_[at(p)];
        std::vector<int> both;
        std::set_union(vertices.begin(), vertices.end(), patch.vertices.begin(), patch.vertices.end(),
                       std::back_inserter(both));
        vertices.swap(both);
        edges.insert(edges.end(), patch.rim.begin(), patch.rim.end());
    }
    std::vector<int> rim;
    for_each_edge(edges, [&](const Edge& edge, std::size_t count) {
        if (count != 2) rim.insert(rim.end(), edge.begin(), edge.end());
    });
    sort_once(rim);
    std::vector<int> inner;
    std::set_difference(vertices.begin(), vertices.end(), rim.begin(), rim.end(), std::back_inserter(inner));
    return inner;
}

void PatchTriangles::replace(int patch, std::vector<int> triangles, const Triangles& all) {
    Patch& made = patches_[at(patch)];
    made = {std::move(triangles), {}, {}};
    std::vector<Edge> edges;
    for (const int t : made.triangles) {
        const auto& c = all[at(t)];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(c[k], c[(k + 1) % 3]);
            edges.push_back({a, b});
            made.vertices.push_back(c[k]);
        }
    }
    sort_once(made.vertices);
    for_each_edge(edges, [&](const Edge& edge, std::size_t count) {
        if (count != 2) made.rim.insert(made.rim.end(), count, edge);
    });
}

}  // namespace hex
