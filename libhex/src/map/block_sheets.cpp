#include <hex/map/block_sheets.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace hex {
std::size_t BlockSheets::of_axis(const EdgeTable& edges, CellId block, std::size_t axis) const {
    return sheet_of_edge[edges.cell_edges[block.index()][edges_of_axis[axis][0]].index()];
}

BlockSheets find_sheets(const HexMesh& blocks, const EdgeTable& edges) {
    // Disjoint sets; the root of a set is its smallest edge.
    std::vector<std::size_t> parent(edges.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t e) {
        while (parent[e] != e) e = parent[e] = parent[parent[e]];
        return e;
    };
    for (const CellId b : blocks.cells())
        for (const auto& parallel : edges_of_axis)
            for (std::size_t k = 1; k < 4; ++k) {
                const std::size_t a = root(edges.cell_edges[b.index()][parallel[0]].index());
                const std::size_t c = root(edges.cell_edges[b.index()][parallel[k]].index());
                parent[std::max(a, c)] = std::min(a, c);
            }
    BlockSheets sheets;
    sheets.sheet_of_edge.resize(edges.size());
    constexpr auto none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> number(edges.size(), none);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        std::size_t& of_root = number[root(e)];
        if (of_root == none) of_root = sheets.count++;
        sheets.sheet_of_edge[e] = of_root;
    }
    return sheets;
}

}  // namespace hex
