#include "hexspline/inputs.h"

#include <hex/base/error.h>
#include <hex/io/hex_file.h>
#include <hex/surface/polygon_soup.h>

namespace cli {

hex::TriangleMesh load_triangles(const CommandLine& line, const std::filesystem::path& path) {
    return triangles_of(line, hex::io::read_surface(path), path);
}

hex::TriangleMesh triangles_of(const CommandLine& line, const hex::io::SurfaceFile& file,
                               const std::filesystem::path& path) {
    line.log(file.diagnostics);
    try {
        hex::TriangleMesh mesh = hex::make_triangle_mesh(file.soup);
        line.log(hex::inspect(mesh), path.string());
        return mesh;
    } catch (const hex::Error& error) {
        throw error.located(path.string());
    }
}

hex::HexMesh load_hexahedra(const CommandLine& line, const std::filesystem::path& path) {
    auto file = hex::io::read_hex_mesh(path);
    line.log(file.diagnostics);
    return std::move(file.mesh);
}

}  // namespace cli
