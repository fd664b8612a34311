#include "io/added_reader.h"

#include "io/input_file.h"

#include <hex/base/error.h>
#include <hex/base/method_call.h>
#include <hex/io/mesh_file.h>
#include <hex/io/reader.h>

#include <algorithm>

namespace hex::io {
namespace {

Registry<Reader>& registry() {
    static Registry<Reader> readers("read");
    return readers;
}

/// What foreign code returns must not break anything behind it.
void require_mesh(const MeshData& data, const std::filesystem::path& path) {
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::bad_input,
                    "the plug-in that reads '" + extension_of(path) + "' files returned " + what,
                    path.string());
    };
    const PolygonSoup& surface = data.surface;
    const std::size_t points = surface.points.size();
    for (const Vec3& point : surface.points)
        if (!point.allFinite()) refuse("a coordinate that is not finite");
    if (surface.offsets.empty() || surface.offsets.front() != 0 ||
        surface.offsets.back() != surface.corners.size() || surface.parts.size() != surface.size())
        refuse("polygons that do not fit their lists");
    for (std::size_t f = 0; f < surface.size(); ++f)
        if (surface.offsets[f + 1] < surface.offsets[f] + 3) refuse("a polygon with less than three corners");
    const auto out_of_range = [&](std::size_t v) { return v >= points; };
    if (std::any_of(surface.corners.begin(), surface.corners.end(), out_of_range))
        refuse("a polygon with a point that is not there");
    if (!data.hexahedron_parts.empty() && data.hexahedron_parts.size() != data.hexahedra.size())
        refuse("part ids that are not one a hexahedron");
    for (const HexCell& cell : data.hexahedra)
        if (std::any_of(cell.begin(), cell.end(),
                        [&](VertexId v) { return !v.valid() || out_of_range(v.index()); }))
            refuse("a hexahedron with a point that is not there");
}

}  // namespace

const Registry<Reader>& readers() {
    return registry();
}

void add_reader(const std::string& extension, const std::string& description,
                Registry<Reader>::Factory factory) {
    if (extension.size() < 2 || extension_of("file" + extension) != extension)
        throw Error(ErrorKind::usage,
                    in_quotes(extension) + " is no extension in lower case with a dot in front");
    if (const FormatInfo* known = find_format("file" + extension))
        throw Error(ErrorKind::usage,
                    "the format " + std::string(known->name) + " has the extension '" + extension + "'");
    registry().add(extension, description, std::move(factory));
}

bool has_added_reader(const std::filesystem::path& path) {
    return registry().contains(extension_of(path));
}

MeshData read_with_added_reader(const std::filesystem::path& path) {
    const InputFile file(path);
    const MethodCall<Reader> method(registry(), extension_of(path));
    MeshData data = method([&](const Reader& reader) { return reader.read(file.name(), file.bytes()); });
    require_mesh(data, path);
    return data;
}

std::string added_extensions() {
    std::string list;
    for (const MethodInfo& reader : registry().list()) list.append(" ").append(reader.name);
    return list;
}

}  // namespace hex::io
