/// \file cad_shape.h
/// Open CASCADE behind a plain interface: cad_shape.cpp is the only file that includes its headers.
#pragma once

#include <hex/io/cad_file.h>
#include <hex/io/mesh_data.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hex::io {

enum class CadFormat { step, iges, brep };

struct CadTriangles {
    MeshData data;  ///< only polygons
    std::vector<std::array<std::uint32_t, 2>> sharp_edges;
};

/// `path` is what IGES is read from; the others are read from `bytes`.
CadTriangles tessellate_cad(CadFormat format, const std::string& path, std::string_view bytes,
                            const CadOptions& options);

}  // namespace hex::io
