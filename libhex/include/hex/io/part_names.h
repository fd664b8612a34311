/// \file part_names.h
/// Names of parts, where a format has them.
#pragma once

#include <map>
#include <string>

namespace hex::io {

/// Part id -> name. Parts without an entry have no name but their number.
using PartNames = std::map<int, std::string>;

}  // namespace hex::io
