#include "improve/coloring.h"

namespace hex::improving {

std::vector<std::vector<VertexId>> independent_classes(const HexMesh& mesh, const std::vector<char>& wanted) {
    const CompressedRows<CellId> cells = vertex_cells(mesh);
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> color(mesh.vertex_count(), none);
    std::vector<VertexId> taken_by;  // of each colour: the last vertex that may not have it
    std::vector<std::vector<VertexId>> classes;
    for (const VertexId v : mesh.vertices()) {
        if (!wanted[v.index()] || cells[v.index()].empty()) continue;
        for (const CellId c : cells[v.index()]) {
            for (const VertexId neighbour : mesh.cell(c)) {
                if (color[neighbour.index()] != none) taken_by[color[neighbour.index()]] = v;
            }
        }
        std::uint32_t free = 0;
        while (free < taken_by.size() && taken_by[free] == v) ++free;
        if (free == taken_by.size()) {
            taken_by.emplace_back();
            classes.emplace_back();
        }
        color[v.index()] = free;
        classes[free].push_back(v);
    }
    return classes;
}

}  // namespace hex::improving
