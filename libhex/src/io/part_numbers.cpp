#include "io/part_numbers.h"

#include "io/input_file.h"

#include <hex/base/diagnostics.h>
#include <hex/base/error.h>
#include <hex/io/number_text.h>

#include <algorithm>
#include <climits>
#include <optional>
#include <set>

namespace hex::io {
namespace {

constexpr std::string_view prefix = "PART_";

/// 7 of "PART_7" (any case).
std::optional<int> number_of(const std::string& name) {
    if (!upper_case(name).starts_with(prefix)) return std::nullopt;
    const auto value = parse_integer(std::string_view(name).substr(prefix.size()));
    if (!value || *value < INT_MIN || *value > INT_MAX) return std::nullopt;
    return static_cast<int>(*value);
}

}  // namespace

std::vector<int> number_parts(const std::vector<std::string>& names, PartNames& kept) {
    std::vector<int> numbers(names.size(), 0);
    std::vector<char> numbered(names.size(), 0);
    std::set<int> taken;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::optional<int> number = number_of(names[i]);
        if (!number || !taken.insert(*number).second) continue;
        numbers[i] = *number;
        numbered[i] = true;
    }
    int next = 1;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (numbered[i]) continue;
        while (taken.contains(next)) ++next;
        numbers[i] = next;
        taken.insert(next);
        kept[next] = names[i];
    }
    return numbers;
}

std::string name_of_part(int part, const PartNames& names) {
    const auto found = names.find(part);
    return found != names.end() ? found->second : std::string(prefix) + std::to_string(part);
}

PartNames names_without(std::string_view forbidden, std::span<const int> parts, const PartNames& names) {
    PartNames written;
    for (const int part : parts) {
        std::string name(trimmed(name_of_part(part, names)));
        if (name.empty()) name = name_of_part(part, {});
        for (char& c : name)
            if (static_cast<unsigned char>(c) < 32 || forbidden.find(c) != std::string_view::npos) c = '_';
        written.emplace(part, std::move(name));
    }
    return written;
}

PartNames distinct_names_without(std::string_view forbidden, std::span<const int> parts,
                                 const PartNames& names) {
    PartNames written = names_without(forbidden, parts, names);
    std::set<std::string> taken;
    for (const int part : parts) taken.insert(upper_case(name_of_part(part, {})));
    for (auto& [part, name] : written) {
        const std::string key = upper_case(name);
        if (key == name_of_part(part, {}) || (!number_of(key) && taken.insert(key).second)) continue;
        std::string other = name;
        do other.append("_").append(std::to_string(part));
        while (!taken.insert(upper_case(other)).second);
        name = std::move(other);
    }
    return written;
}

void require_part_ids(std::span<const int> parts, int least, const char* elements, const char* format) {
    std::vector<std::int64_t> wrong;
    for (std::size_t e = 0; e < parts.size(); ++e)
        if (parts[e] < least) wrong.push_back(static_cast<std::int64_t>(e));
    if (wrong.empty()) return;
    const int first = parts[static_cast<std::size_t>(wrong.front())];
    throw Error(
        ErrorKind::unsupported,
        std::string(format) + " carries no part ids below " + std::to_string(least) + ", and " + elements +
            " " + list_ids(wrong) + " have such (the first has " + std::to_string(first) + ")",
        {}, "change these part ids, or write another format: .k, .vtk, .vtu, .inp and .ovm carry them");
}

std::vector<int> distinct_parts(std::vector<int> parts) {
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    return parts;
}

}  // namespace hex::io
