/// \file fuzz_reader.h
/// What a fuzz target of a reader does: any bytes give a mesh within its ranges, or hex::Error.
#pragma once

#include "io/formats.h"

#include <hex/base/error.h>

#include <cstdint>
#include <cstdlib>

namespace hex::io {

inline void require(bool condition) {
    if (!condition) std::abort();
}

inline int fuzz_reader(MeshData (*read)(const InputFile&), const std::uint8_t* bytes, std::size_t size) {
    if (size == 0) return 0;
    const InputFile file("fuzz", {reinterpret_cast<const char*>(bytes), size});
    try {
        MeshData data = read(file);
        const std::size_t points = data.points().size();
        for (const Vec3& point : data.points()) require(point.allFinite());
        require(data.surface.offsets.back() == data.surface.corners.size());
        require(data.surface.parts.size() == data.surface.size());
        for (std::size_t f = 0; f < data.surface.size(); ++f) require(data.surface.polygon(f).size() >= 3);
        for (const std::uint32_t v : data.surface.corners) require(v < points);
        require(data.hexahedron_parts.empty() || data.hexahedron_parts.size() == data.hexahedra.size());
        for (const HexCell& cell : data.hexahedra) {
            for (const VertexId v : cell) require(v.index() < points);
        }
        HexMesh(std::move(data.points()), std::move(data.hexahedra), std::move(data.hexahedron_parts));
    } catch (const Error& error) {
        require(exit_code(error.kind()) == 3);
    }
    return 0;
}

}  // namespace hex::io

#define HEX_FUZZ_READER(read)                                                            \
    extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) { \
        return hex::io::fuzz_reader(hex::io::read, bytes, size);                         \
    }
