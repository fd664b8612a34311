/// \file part_numbers.h
/// Part ids for formats that know parts by name.
#pragma once

#include <hex/io/part_names.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hex::io {

/// Part ids for the named parts, in their order: "PART_7" is 7, as our writers call a part without a name;
/// the other names get the smallest numbers that are left, and are added to `kept`. The names must differ.
std::vector<int> number_parts(const std::vector<std::string>& names, PartNames& kept);

/// The name of a part, or "PART_7".
std::string name_of_part(int part, const PartNames& names);

/// What a format demands of names. Blanks at the ends are left out by all of them, and control characters
/// become '_'.
struct NameRules {
    std::string_view forbidden;        ///< characters that become '_'
    std::string_view forbidden_first;  ///< those that become '_' where a name begins
    std::size_t longest;               ///< in bytes; at least 40
};

/// The names of the parts as a format writes them that keeps parts apart by their ids: one of nothing but
/// blanks is "PART_7", and two that differ go on doing so, by the part id appended. `parts` are distinct.
PartNames names_within(const NameRules& rules, std::span<const int> parts, const PartNames& names);

/// The same where parts are known by their names: no two differ only in case, and "PART_7" is part 7. Those
/// that need it get their part id appended.
PartNames distinct_names_within(const NameRules& rules, std::span<const int> parts, const PartNames& names);

/// Throws Error{unsupported} that names the elements ("polygons", "hexahedra") when part ids are smaller than
/// `least`, for a format that has no such ids.
void require_part_ids(std::span<const int> parts, int least, const char* elements, const char* format);

/// The part ids, ascending, each once.
std::vector<int> distinct_parts(std::vector<int> parts);

}  // namespace hex::io
