#include <hex/io/number_text.h>

#include <cmath>

namespace hex::io {
namespace {

/// Drops one leading '+', which from_chars does not take; "+-1" stays wrong.
std::string_view without_plus(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    return text;
}

/// from_chars reports overflow and underflow alike; a value that underflows has a negative decimal exponent.
bool underflows(std::string_view text) {
    const auto e = text.find_first_of("eE");
    return (e != std::string_view::npos && e + 1 < text.size() && text[e + 1] == '-') ||
           text.starts_with("0.") || text.starts_with("-0.") || text.starts_with(".");
}

}  // namespace

std::optional<double> parse_double(std::string_view text) {
    text = without_plus(text);
    double value = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || text.empty()) return std::nullopt;
    if (problem == std::errc::result_out_of_range)
        return underflows(text) ? std::optional<double>(0.0) : std::nullopt;
    if (problem != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<long long> parse_integer(std::string_view text) {
    text = without_plus(text);
    long long value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return value;
}

}  // namespace hex::io
