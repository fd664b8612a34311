/// \file element_size.h
/// The options of `map` and `run` that say how fine the mesh is and how blocks are filled.
#pragma once

#include "hexspline/command.h"

#include <hex/map/map.h>

namespace cli {

/// -s/--level, --edge-length, --target-hexes, --interior.
void describe_element_size(CommandLine& line);

/// Their values. Throws hex::Error{usage} when more than one of the first three is given, or out of range.
hex::MapOptions element_size(const CommandLine& line);

}  // namespace cli
