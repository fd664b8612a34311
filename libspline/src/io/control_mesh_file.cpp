#include <hex/io/hex_file.h>
#include <spline/io/control_mesh_file.h>

#include <numeric>
#include <string>

namespace spline::io {

std::filesystem::path control_mesh_path(const std::filesystem::path& prefix, std::size_t level) {
    std::filesystem::path path = prefix;
    path += "_hmesh" + std::to_string(level) + "_CM.vtk";
    return path;
}

std::vector<std::filesystem::path> write_control_meshes(const std::filesystem::path& prefix,
                                                        std::span<const ControlMesh> levels) {
    std::vector<std::filesystem::path> paths;
    for (std::size_t l = 0; l < levels.size(); ++l) {
        const ControlMesh& level = levels[l];
        hex::io::Fields fields;
        fields.vertex.push_back({"pact", {level.function_active.begin(), level.function_active.end()}});
        fields.cell.push_back({"eact", {level.element_active.begin(), level.element_active.end()}});
        std::vector<double> ids(level.mesh.cell_count());
        std::iota(ids.begin(), ids.end(), 0.0);
        fields.cell.push_back({"id", std::move(ids)});
        std::filesystem::path path = control_mesh_path(prefix, l);
        hex::io::write_hex_mesh(path, level.mesh, fields);
        paths.push_back(std::move(path));
    }
    return paths;
}

}  // namespace spline::io
