#include "hexspline/element_size.h"

#include <hex/base/error.h>

#include <cmath>

namespace cli {

void describe_element_size(CommandLine& line) {
    const hex::MapOptions defaults;
    line.add("level,s", value<int>()->default_value(defaults.level),
             "octree level 0..7: every block becomes 2^N x 2^N x 2^N hexahedra; 0 keeps the blocks");
    line.add("edge-length", value<double>("H"),
             "instead of -s: cut each sheet of the blocks into pieces of about this length");
    line.add("target-hexes", value<double>("N"),
             "instead of -s: choose the edge length for about so many hexahedra");
    line.add("interior", value<std::string>("NAME")->default_value(hex::name_of(defaults.interior)),
             "inside of the blocks: linear, transfinite or harmonic");
}

hex::MapOptions element_size(const CommandLine& line) {
    int sizes = 0;
    for (const char* name : {"level", "edge-length", "target-hexes"}) sizes += line.given(name) ? 1 : 0;
    if (sizes > 1)
        throw hex::Error(hex::ErrorKind::usage, "-s, --edge-length and --target-hexes exclude each other", {},
                         "give one of them");
    hex::MapOptions options;
    options.level = line.get<int>("level");
    line.require_range("level", options.level, 0, hex::largest_map_level);
    options.interior = hex::interior_named(line.get<std::string>("interior"));
    if (line.given("edge-length")) {
        options.edge_length = line.get<double>("edge-length");
        if (!(options.edge_length > 0.0) || !std::isfinite(options.edge_length))
            throw hex::Error(hex::ErrorKind::usage, "--edge-length must be a positive number");
    }
    if (line.given("target-hexes")) {
        // Read as a number, so that 1e5 is understood.
        const auto target = line.get<double>("target-hexes");
        line.require_range("target-hexes", target, 1, 1e9);
        options.target_hexes = static_cast<std::size_t>(std::llround(target));
    }
    return options;
}

}  // namespace cli
