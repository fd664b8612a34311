#include "volume/mesh_result.h"

#include <hex/base/error.h>
#include <hex/base/method_call.h>
#include <hex/map/map.h>

#include <fmt/format.h>

#include <cmath>

namespace hex {

Registry<Mapper>& mappers() {
    static Registry<Mapper> registry("map");
    return registry;
}

std::string name_of(Interior interior) {
    switch (interior) {
        case Interior::linear:
            return "linear";
        case Interior::transfinite:
            return "transfinite";
        case Interior::harmonic:
            return "harmonic";
    }
    return {};
}

Interior interior_named(const std::string& name) {
    for (const Interior interior : {Interior::linear, Interior::transfinite, Interior::harmonic})
        if (name_of(interior) == name) return interior;
    throw Error(ErrorKind::usage, fmt::format("'{}' is no way to fill blocks", name), {},
                "choose linear, transfinite or harmonic");
}

MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options,
              const Context& context) {
    if (options.level < 0 || options.level > largest_map_level)
        throw Error(ErrorKind::usage, fmt::format("level {} is out of range", options.level), {},
                    fmt::format("choose 0 (blocks as they are) .. {}", largest_map_level));
    if (!(options.edge_length >= 0.0) || !std::isfinite(options.edge_length))
        throw Error(ErrorKind::usage, fmt::format("{} is no edge length", options.edge_length), {},
                    "give a positive number");
    if (options.edge_length > 0.0 && options.target_hexes > 0)
        throw Error(ErrorKind::usage, "an edge length and a number of hexahedra exclude each other");
    if (!(options.snap_warning >= 0.0))
        throw Error(ErrorKind::usage, "the distance to warn of must be a number that is not negative");
    const MethodCall<Mapper> method(mappers(), options.method);
    MapResult result =
        method([&](const Mapper& mapper) { return mapper.map(surface, blocks, options, context); });
    method.require("mesh", [&] {
        require_mesh(result.mesh);
        require_compact(result.mesh, blocks.cell_count());
    });
    result.report.method = options.method;
    return result;
}

}  // namespace hex
