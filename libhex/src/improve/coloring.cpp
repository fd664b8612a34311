#include "improve/coloring.h"

#include "volume/counting_rows.h"

namespace hex::improving {
namespace {

/// Greedy colouring in vertex order; `visit_neighbours(v, avoid)` calls `avoid` for all whose colour v may
/// not have.
template <class Visit>
std::vector<std::vector<VertexId>> greedy_classes(const std::vector<char>& wanted,
                                                  const Visit& visit_neighbours) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> color(wanted.size(), none);
    std::vector<VertexId> taken_by;  // of each colour: the last vertex that may not have it
    std::vector<std::vector<VertexId>> classes;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (!wanted[i]) continue;
        const VertexId v(i);
        visit_neighbours(v, [&](VertexId neighbour) {
            if (color[neighbour.index()] != none) taken_by[color[neighbour.index()]] = v;
        });
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

}  // namespace

std::vector<std::vector<VertexId>> independent_classes(const HexMesh& mesh, const std::vector<char>& wanted) {
    CompressedRows<VertexId> nothing;
    nothing.offsets.assign(mesh.vertex_count() + 1, 0);
    return independent_classes(mesh, vertex_cells(mesh), wanted, nothing);
}

std::vector<std::vector<VertexId>> independent_classes(const HexMesh& mesh,
                                                       const CompressedRows<CellId>& cells,
                                                       const std::vector<char>& wanted,
                                                       const CompressedRows<VertexId>& reads) {
    const auto read_by = rows_by_counting<VertexId>(mesh.vertex_count(), [&](const auto& emit) {
        for (const VertexId v : mesh.vertices())
            for (const VertexId other : reads[v.index()]) emit(other.index(), v);
    });
    std::vector<char> movable = wanted;
    for (const VertexId v : mesh.vertices())
        if (cells[v.index()].empty()) movable[v.index()] = 0;
    return greedy_classes(movable, [&](VertexId v, const auto& avoid) {
        for (const CellId c : cells[v.index()])
            for (const VertexId neighbour : mesh.cell(c)) avoid(neighbour);
        for (const VertexId other : reads[v.index()]) avoid(other);
        for (const VertexId other : read_by[v.index()]) avoid(other);
    });
}

}  // namespace hex::improving
