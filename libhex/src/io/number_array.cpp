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

bool parse(std::string_view word, double& value) {
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (problem == std::errc() && end == word.data() + word.size() && std::isfinite(value)) return true;
    // Signs, numbers too small, and everything that is wrong.
    const auto careful = parse_double(word);
    value = careful.value_or(0.0);
    return careful.has_value();
}

bool parse(std::string_view word, std::uint32_t& value) {
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    return problem == std::errc() && end == word.data() + word.size();
}

std::size_t skip_blanks(std::string_view text, std::size_t position) {
    while (position < text.size() && is_blank(text[position])) ++position;
    return position;
}

std::size_t skip_word(std::string_view text, std::size_t position) {
    while (position < text.size() && !is_blank(text[position])) ++position;
    return position;
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
        const std::size_t behind = skip_word(text, position);
        Number value{};
        if (!parse(text.substr(position, behind - position), value)) {
            piece.stopped = true;
            return;
        }
        piece.numbers.push_back(value);
        position = behind;
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
