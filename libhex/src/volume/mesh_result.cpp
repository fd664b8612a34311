#include "volume/mesh_result.h"

#include <hex/base/error.h>

#include <algorithm>
#include <string>
#include <vector>

namespace hex {

void require_mesh(const HexMesh& mesh) {
    if (mesh.empty()) throw Error(ErrorKind::bad_input, "it has no hexahedra");
    const auto positions = mesh.positions();
    const auto odd =
        std::find_if(positions.begin(), positions.end(), [](const Vec3& p) { return !p.allFinite(); });
    if (odd != positions.end())
        throw Error(ErrorKind::bad_input, "vertex " + std::to_string(odd - positions.begin()) +
                                              " has a coordinate that is not finite");
}

void require_compact(const HexMesh& mesh, std::size_t parts) {
    std::vector<char> used(mesh.vertex_count(), 0);
    for (const HexCell& cell : mesh.cell_array())
        for (const VertexId v : cell) used[v.index()] = 1;
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused != used.end())
        throw Error(ErrorKind::bad_input,
                    "no hexahedron uses vertex " + std::to_string(unused - used.begin()));
    for (const CellId c : mesh.cells()) {
        if (const int part = mesh.part(c); part < 1 || static_cast<std::size_t>(part) > parts)
            throw Error(ErrorKind::bad_input, "hexahedron " + std::to_string(c.index()) + " has part " +
                                                  std::to_string(part) + ", which is not one of 1.." +
                                                  std::to_string(parts));
    }
}

}  // namespace hex
