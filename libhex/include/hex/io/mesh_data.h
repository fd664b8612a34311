/// \file mesh_data.h
/// What one file holds, before anybody asks for a surface or a volume: what readers return.
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/io/part_names.h>
#include <hex/surface/polygon_soup.h>
#include <hex/volume/hex_mesh.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hex::io {

/// Points (in `surface.points`) with polygons and hexahedra on them.
struct MeshData {
    PolygonSoup surface;
    std::vector<HexCell> hexahedra;
    /// One part id a hexahedron, or empty where the format has none.
    std::vector<int> hexahedron_parts;
    /// Of the part ids, where the format has names.
    PartNames part_names;
    Diagnostics diagnostics;

    std::vector<Vec3>& points() { return surface.points; }

    void add_polygon(std::span<const std::uint32_t> corners, int part) {
        surface.corners.insert(surface.corners.end(), corners.begin(), corners.end());
        surface.offsets.push_back(surface.corners.size());
        surface.parts.push_back(part);
    }
    void warn(std::string code, std::string message, std::string entity = {},
              std::vector<std::int64_t> ids = {}) {
        diagnostics.push_back(
            {Severity::warning, std::move(code), std::move(message), std::move(entity), std::move(ids)});
    }
};

}  // namespace hex::io
