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
    PolygonSoup surface;             ///< all points of the file, and its polygons; there may be none
    std::vector<HexCell> hexahedra;  ///< on the same points, corners in VTK's order; there may be none
    /// One part id a hexahedron, or empty where the format has none.
    std::vector<int> hexahedron_parts;
    /// Of the part ids, where the format has names.
    PartNames part_names;
    Diagnostics diagnostics;  ///< what the reader noticed, without the file's name

    /// The points of polygons and hexahedra alike.
    std::vector<Vec3>& points() { return surface.points; }

    /// Appends a polygon: 0-based points, counter-clockwise seen from outside. Nothing is checked here.
    void add_polygon(std::span<const std::uint32_t> corners, int part) {
        surface.corners.insert(surface.corners.end(), corners.begin(), corners.end());
        surface.offsets.push_back(surface.corners.size());
        surface.parts.push_back(part);
    }
    /// Appends a warning; the arguments are the fields of Diagnostic (diagnostics.h).
    void warn(std::string code, std::string message, std::string entity = {},
              std::vector<std::int64_t> ids = {}) {
        diagnostics.push_back(
            {Severity::warning, std::move(code), std::move(message), std::move(entity), std::move(ids)});
    }
};

}  // namespace hex::io
