#include <hex/hexahedralize/hexahedralize.h>
#include <hex/surface/polygon_soup.h>
#include <hex/volume/hex_mesh.h>
#include <hex/volume/topology.h>

#include <array>
#include <iostream>

int main() {
    std::vector<hex::Vec3> points;
    for (int i = 0; i < 12; ++i) points.emplace_back(i % 2, i / 2 % 2, i / 4);
    std::vector<hex::HexCell> cells(2);
    const int square[] = {0, 1, 3, 2};
    for (std::size_t c = 0; c < 8; ++c)
        for (std::size_t k = 0; k < 2; ++k) cells[k][c] = hex::VertexId(square[c % 4] + 4 * (c / 4 + k));
    const hex::HexMesh mesh(points, cells);
    int interior = 0;
    for (const auto h : mesh.half_faces()) interior += !mesh.is_boundary(h) && mesh.twin(h) < h;
    std::cout << mesh.vertex_count() << " vertices, " << mesh.cell_count() << " hexahedra, " << interior
              << " interior face\n";

    // From its boundary to a mesh again.
    hex::PolygonSoup surface;
    surface.points = points;
    for (const auto& quad : hex::boundary_quads(mesh).vertices) {
        std::array<std::uint32_t, 4> corners{};
        for (std::size_t k = 0; k < 4; ++k) corners[k] = static_cast<std::uint32_t>(quad[k].index());
        surface.add_polygon(corners);
    }
    hex::HexahedralizeOptions options;
    options.choose_size = false;
    options.map.level = 1;
    const auto result = hex::hexahedralize(hex::make_triangle_mesh(surface), options);
    std::cout << result.model.quality->cells << " hexahedra, " << result.model.quality->inverted
              << " inverted\n";
}
