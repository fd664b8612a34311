#include "io/number_array.h"

#include "io/input_file.h"

#include <hex/base/parallel.h>
#include <hex/io/number_text.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace hex::io {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 17;
constexpr std::size_t pieces_at_once = 32;

/// The numbers of the words that start in one piece of the text, up to the first that is none.
template <class Number>
struct Piece {
    std::vector<Number> numbers;
    bool stopped = false;
};

std::size_t skip_blanks(std::string_view text, std::size_t position) {
    while (position < text.size() && is_blank(text[position])) ++position;
    return position;
}

std::size_t skip_word(std::string_view text, std::size_t position) {
    while (position < text.size() && !is_blank(text[position])) ++position;
    return position;
}

bool at_word_end(std::string_view text, std::size_t position) {
    return position == text.size() || is_blank(text[position]);
}

/// Reads the number that starts at `position` and moves behind it; false when there is none.
bool take_number(std::string_view text, std::size_t& position, double& value) {
    const char* const begin = text.data() + position;
    const auto [end, problem] = std::from_chars(begin, text.data() + text.size(), value);
    const std::size_t behind = position + static_cast<std::size_t>(end - begin);
    if (problem == std::errc() && behind > position && at_word_end(text, behind) && std::isfinite(value)) {
        position = behind;
        return true;
    }
    // Signs, numbers too small, and everything that is wrong.
    const std::size_t word_end = skip_word(text, position);
    const auto careful = parse_double(text.substr(position, word_end - position));
    value = careful.value_or(0.0);
    position = word_end;
    return careful.has_value();
}

/// At most eleven digits are looked at, which fit the wider number.
bool take_number(std::string_view text, std::size_t& position, std::uint32_t& value) {
    const std::size_t start = position;
    std::uint64_t number = 0;
    for (; position < text.size() && position - start <= 10; ++position) {
        const unsigned digit = static_cast<unsigned char>(text[position]) - unsigned{'0'};
        if (digit > 9) break;
        number = 10 * number + digit;
    }
    value = static_cast<std::uint32_t>(number);
    return position > start && number <= UINT32_MAX && at_word_end(text, position);
}

template <class Number>
void read_piece(std::string_view text, std::size_t first, std::size_t begin, std::size_t end,
                Piece<Number>& piece) {
    piece.numbers.clear();
    piece.stopped = false;
    // A word that started before belongs to the piece before.
    std::size_t position = begin;
    if (begin > first && !is_blank(text[begin - 1])) position = skip_word(text, position);
    for (position = skip_blanks(text, position); position < end; position = skip_blanks(text, position)) {
        Number value{};
        if (!take_number(text, position, value)) {
            piece.stopped = true;
            return;
        }
        piece.numbers.push_back(value);
    }
}

/// Position behind the first `count` words.
std::size_t skip_words(std::string_view text, std::size_t first, std::size_t begin, std::size_t count) {
    std::size_t position = begin;
    if (begin > first && !is_blank(text[begin - 1])) position = skip_word(text, position);
    for (std::size_t i = 0; i < count; ++i) position = skip_word(text, skip_blanks(text, position));
    return position;
}

template <class Number>
std::optional<std::size_t> parse_all(std::string_view text, std::size_t first, std::span<Number> numbers) {
    std::size_t done = 0;
    if (numbers.empty()) return first;
    std::vector<Piece<Number>> pieces;
    for (std::size_t start = first; start < text.size(); start += pieces_at_once * piece_bytes) {
        const std::size_t end = std::min(text.size(), start + pieces_at_once * piece_bytes);
        pieces.resize((end - start + piece_bytes - 1) / piece_bytes);
        parallel_for(
            pieces.size(),
            [&](std::size_t i) {
                const std::size_t begin = start + i * piece_bytes;
                read_piece(text, first, begin, std::min(end, begin + piece_bytes), pieces[i]);
            },
            1);
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const auto& found = pieces[i].numbers;
            const std::size_t taken = std::min(found.size(), numbers.size() - done);
            std::copy_n(found.begin(), taken, numbers.begin() + static_cast<std::ptrdiff_t>(done));
            done += taken;
            if (done == numbers.size()) return skip_words(text, first, start + i * piece_bytes, taken);
            if (pieces[i].stopped) return std::nullopt;
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::size_t> parse_numbers(std::string_view text, std::size_t position,
                                         std::span<double> numbers) {
    return parse_all(text, position, numbers);
}

std::optional<std::size_t> parse_numbers(std::string_view text, std::size_t position,
                                         std::span<std::uint32_t> numbers) {
    return parse_all(text, position, numbers);
}

}  // namespace hex::io
