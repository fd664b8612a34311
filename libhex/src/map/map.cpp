#include <hex/base/error.h>
#include <hex/map/map.h>

#include <fmt/format.h>

namespace hex {

Registry<Mapper>& mappers() {
    static Registry<Mapper> registry("map");
    return registry;
}

MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options,
              const Context& context) {
    if (options.level < 0 || options.level > largest_map_level)
        throw Error(ErrorKind::usage, fmt::format("level {} is out of range", options.level), {},
                    fmt::format("choose 0 (blocks as they are) .. {}", largest_map_level));
    if (!(options.snap_warning >= 0.0))
        throw Error(ErrorKind::usage, "the distance to warn of must be a number that is not negative");
    MapResult result = mappers().make(options.method)->map(surface, blocks, options, context);
    result.report.method = options.method;
    return result;
}

}  // namespace hex
