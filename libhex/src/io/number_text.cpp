#include <hex/io/number_text.h>

#include <algorithm>
#include <cmath>

namespace hex::io {
namespace {

/// Drops one leading '+', which from_chars does not take; "+-1" stays wrong.
std::string_view without_plus(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    return text;
}

/// from_chars reports overflow and underflow alike. The decimal exponent of the first significant digit tells
/// them apart. `text` is a valid number.
bool underflows(std::string_view text) {
    long long exponent = 0;
    const auto e = text.find_first_of("eE");
    if (e != std::string_view::npos) {
        const std::string_view digits = text.substr(e + 1);
        // An exponent that is too long for an integer decides alone.
        const auto value = parse_integer(digits);
        if (!value || *value < -1'000'000'000 || *value > 1'000'000'000) return digits.front() == '-';
        exponent = *value;
    }
    const std::string_view mantissa = text.substr(0, e);
    const auto point = static_cast<long long>(std::min(mantissa.find('.'), mantissa.size()));
    const auto first = mantissa.find_first_of("123456789");
    if (first == std::string_view::npos) return true;
    const auto position = static_cast<long long>(first);
    exponent += position < point ? point - position - 1 : point - position;
    return exponent < 0;
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
