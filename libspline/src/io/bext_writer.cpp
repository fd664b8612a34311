#include <hex/base/parallel.h>
#include <hex/base/parallel_ordered.h>
#include <hex/io/number_text.h>
#include <hex/io/output_file.h>
#include <spline/io/bext.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

namespace spline::io {
namespace {

using hex::io::append_number;

/// Rows with more non-zeros are written dense.
constexpr std::size_t most_sparse = 20;

/// A text that grows at its end. Room is made for a line at once, so that numbers need no checks.
class LineBuffer {
  public:
    void clear() { end_ = 0; }
    std::string_view text() const { return {bytes_.data(), end_}; }
    /// Makes room for so many more bytes.
    void reserve(std::size_t more) {
        if (bytes_.size() < end_ + more) bytes_.resize(std::max(2 * bytes_.size(), end_ + more));
    }
    void put(char c) { bytes_[end_++] = c; }
    void put(std::string_view text) {
        std::memcpy(bytes_.data() + end_, text.data(), text.size());
        end_ += text.size();
    }
    void put(std::size_t value) {
        end_ = static_cast<std::size_t>(
            std::to_chars(bytes_.data() + end_, bytes_.data() + bytes_.size(), value).ptr - bytes_.data());
    }
    /// Copies all of `block`, of which `length` bytes count.
    template <std::size_t size>
    void put_block(const char (&block)[size], std::size_t length) {
        std::memcpy(bytes_.data() + end_, block, size);
        end_ += length;
    }

  private:
    std::vector<char> bytes_;
    std::size_t end_ = 0;
};

/// No number and no index of a column, with a blank before it, is longer.
constexpr std::size_t most_digits = 32;

/// Text of doubles, remembered: extraction coefficients take few values, so most are copied, not converted.
class NumberWriter {
  public:
    NumberWriter() {
        for (std::size_t column = 0; column < columns_.size(); ++column) {
            std::string text(1, ' ');
            append_number(text, column);
            std::memcpy(columns_[column].text, text.data(), text.size());
            columns_[column].length = static_cast<char>(text.size());
        }
    }
    /// The number of a column, 0 .. 63, with a blank before it.
    void put_column(LineBuffer& line, std::size_t column) const {
        line.put_block(columns_[column].text, static_cast<std::size_t>(columns_[column].length));
    }
    /// A value with a blank before it.
    void put(LineBuffer& line, double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        Entry& entry = entries_[(bits * 0x9e3779b97f4a7c15ULL) >> (64 - bits_of_size)];
        if (entry.length == 0 || entry.bits != bits) {
            std::string& text = scratch_;
            text.assign(1, ' ');
            append_number(text, value);
            // The longest text of a double has 24 characters, but no coefficient is negative.
            if (text.size() > sizeof entry.text) return line.put(text);
            entry.bits = bits;
            entry.length = static_cast<std::uint8_t>(text.size());
            std::memcpy(entry.text, text.data(), text.size());
        }
        line.put_block(entry.text, entry.length);
    }

  private:
    static constexpr int bits_of_size = 12;
    struct Entry {
        std::uint64_t bits = 0;
        char text[24] = {};
        std::uint8_t length = 0;
    };
    struct Column {
        char text[3] = {};
        char length = 0;
    };
    std::vector<Entry> entries_ = std::vector<Entry>(std::size_t{1} << bits_of_size);
    std::array<Column, 64> columns_;
    std::string scratch_;
};

void put_element(LineBuffer& line, const ElementExtraction& extraction, NumberWriter& numbers) {
    line.reserve((extraction.functions.size() + 2) * most_digits);
    line.put("belem ");
    line.put(extraction.functions.size());
    line.put(" 3 3 3\n");
    for (std::size_t i = 0; i < extraction.functions.size(); ++i) {
        if (i > 0) line.put(' ');
        line.put(std::size_t{extraction.functions[i]});
    }
    line.put('\n');
    for (const auto& row : extraction.coefficients) {
        const auto non_zeros = static_cast<std::size_t>(64 - std::count(row.begin(), row.end(), 0.0));
        if (non_zeros > most_sparse) {
            line.reserve((row.size() + 1) * most_digits);
            line.put('d');
            for (const double value : row) numbers.put(line, value);
        } else {
            line.reserve((2 * non_zeros + 2) * most_digits);
            line.put("s ");
            line.put(non_zeros);
            for (std::size_t column = 0; column < row.size(); ++column) {
                if (row[column] == 0.0) continue;
                numbers.put_column(line, column);
                numbers.put(line, row[column]);
            }
        }
        line.put('\n');
    }
}

void write_head(hex::io::OutputFile& file, const BezierSpline& spline) {
    std::string& text = file.buffer();
    text += "B E X T\ntype hex\nnodeN ";
    append_number(text, spline.function_count());
    text += "\nelemN ";
    append_number(text, spline.element_count());
    text += '\n';
    for (std::size_t i = 0; i < spline.function_count(); ++i) {
        text += "gnode";
        for (const double x : spline.control_points[i]) {
            text += ' ';
            append_number(text, x);
        }
        text += ' ';
        append_number(text, spline.weights[i]);
        text += '\n';
        file.flush_if_large();
    }
}

}  // namespace

void write_bext(const std::filesystem::path& path, const BezierSpline& spline, const hex::Context& context) {
    hex::with_threads(context, [&] {
        hex::io::OutputFile file(path);
        write_head(file, spline);
        // Pieces are formatted in parallel and written in order, a wave between two looks at the context.
        constexpr std::size_t piece_size = 16, wave = 64 * piece_size;
        struct Piece {
            explicit Piece(const BezierSpline& from) : gather(from) {}
            ExtractionGatherer gather;
            NumberWriter numbers;
            LineBuffer text;
        };
        std::vector<Piece> pieces(4, Piece(spline));
        const std::size_t count = spline.element_count();
        for (std::size_t first = 0; first < count; first += wave) {
            context.check_cancelled();
            context.progress("writing", static_cast<double>(first) / static_cast<double>(count));
            const std::size_t last = std::min(count, first + wave);
            hex::parallel_ordered((last - first + piece_size - 1) / piece_size, pieces,
                                  [&](std::size_t i, Piece& piece) {
                                      piece.text.clear();
                                      const std::size_t begin = first + i * piece_size;
                                      for (std::size_t e = begin; e < std::min(last, begin + piece_size); ++e)
                                          put_element(piece.text, piece.gather(e), piece.numbers);
                                  },
                                  [&](std::size_t, const Piece& piece) { file.write(piece.text.text()); });
        }
        file.commit();
    });
}

}  // namespace spline::io
