#include "hexspline/report_text.h"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

namespace cli {
namespace {

/// The character that starts at the front of `text` and its length in bytes; 0 bytes when it is no UTF-8
/// (RFC 3629).
struct Character {
    std::uint32_t code = 0;
    std::size_t length = 0;
};

Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
    };
    const std::uint32_t lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC0 || lead >= 0xF8 || text.size() < length) return {};
    std::uint32_t code = lead & (0xFFu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3F);
    }
    constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code < 0xE000;
    if (code < smallest[length] || code > 0x10FFFF || surrogate) return {};
    return {code, length};
}

bool allowed_in_xml(std::uint32_t code) {
    return code >= 0x20 ? code != 0xFFFE && code != 0xFFFF : code == '\t' || code == '\n' || code == '\r';
}

}  // namespace

std::string clean_text(const std::string& text) {
    std::string result;
    for (std::string_view rest = text; !rest.empty();) {
        const Character character = first_character(rest);
        if (character.length > 0 && allowed_in_xml(character.code))
            result += rest.substr(0, character.length);
        else
            result += "\xEF\xBF\xBD";
        rest.remove_prefix(character.length > 0 ? character.length : 1);
    }
    return result;
}

std::string xml_text(const std::string& text) {
    std::string result;
    for (const char c : clean_text(text)) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            // An attribute would turn them into blanks.
            case '\t':
            case '\n':
            case '\r':
                result += fmt::format("&#{};", static_cast<int>(c));
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string markdown_cell(const std::string& text) {
    static constexpr std::string_view marks = "|*_`<\\[]";
    std::string result;
    for (const char c : clean_text(text)) {
        if (marks.find(c) != std::string_view::npos) result += '\\';
        result += c == '\n' || c == '\r' || c == '\t' ? ' ' : c;
    }
    return result;
}

std::string uri_of(const std::string& path) {
    static constexpr std::string_view plain = "-._~/";
    std::string result = path.starts_with('/') ? "file://" : "";
    for (const char c : path) {
        const auto byte = static_cast<unsigned char>(c);
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (letter || plain.find(c) != std::string_view::npos)
            result += c;
        else
            result += fmt::format("%{:02X}", byte);
    }
    return result;
}

}  // namespace cli
