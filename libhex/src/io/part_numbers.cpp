#include "io/part_numbers.h"

#include "io/input_file.h"

#include <hex/base/diagnostics.h>
#include <hex/base/error.h>
#include <hex/io/number_text.h>

#include <algorithm>
#include <climits>
#include <map>
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

namespace {

/// The first `longest` bytes, but no piece of a UTF-8 character.
std::string cut(std::string name, std::size_t longest) {
    if (name.size() <= longest) return name;
    std::size_t end = longest;
    while (end > 0 && longest - end < 3 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
    name.resize(end);
    return std::string(trimmed(name));
}

std::string allowed_name(const NameRules& rules, int part, const PartNames& names) {
    std::string name = cut(std::string(trimmed(name_of_part(part, names))), rules.longest);
    if (name.empty()) return name_of_part(part, {});
    for (char& c : name)
        if (static_cast<unsigned char>(c) < 32 || rules.forbidden.find(c) != std::string_view::npos) c = '_';
    if (rules.forbidden_first.find(name.front()) != std::string_view::npos) name.front() = '_';
    return name;
}

/// "name_7", or the first that is free of "name_7_2", "name_7_3", ...
std::string with_number(const NameRules& rules, const std::string& name, int part, const auto& is_free) {
    for (std::size_t count = 1;; ++count) {
        std::string number = "_";
        number += std::to_string(part);
        if (count > 1) number.append("_").append(std::to_string(count));
        const std::string wanted = cut(name, rules.longest - number.size()) + number;
        if (is_free(wanted)) return wanted;
    }
}

PartNames altered_names(const NameRules& rules, std::span<const int> parts, const PartNames& names) {
    PartNames written;
    for (const int part : parts) written.emplace(part, allowed_name(rules, part, names));
    return written;
}

}  // namespace

PartNames names_within(const NameRules& rules, std::span<const int> parts, const PartNames& names) {
    PartNames written = altered_names(rules, parts, names);
    // Of each name as it is written what it was; those that are written as they are come first.
    std::map<std::string, std::string> origins;
    for (const auto& [part, name] : written)
        if (name == name_of_part(part, names)) origins.emplace(name, name);
    for (auto& [part, name] : written) {
        const std::string original = name_of_part(part, names);
        const auto is_free = [&](const std::string& wanted) {
            return origins.emplace(wanted, original).first->second == original;
        };
        if (!is_free(name)) name = with_number(rules, name, part, is_free);
    }
    return written;
}

PartNames distinct_names_within(const NameRules& rules, std::span<const int> parts, const PartNames& names) {
    PartNames written = altered_names(rules, parts, names);
    std::set<std::string> taken;
    for (const auto& [part, name] : written) taken.insert(name_of_part(part, {}));
    const auto is_free = [&](const std::string& wanted) { return taken.insert(upper_case(wanted)).second; };
    const auto can_stay = [&](int part, const std::string& name) {
        const std::string key = upper_case(name);
        return key == name_of_part(part, {}) || (!number_of(key) && is_free(name));
    };
    // Names that fit as they are come first.
    std::vector<int> others;
    for (const auto& [part, name] : written)
        if (name != name_of_part(part, names) || !can_stay(part, name)) others.push_back(part);
    for (const int part : others) {
        std::string& name = written.at(part);
        if (!can_stay(part, name)) name = with_number(rules, name, part, is_free);
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
