#include <hex/base/parallel.h>
#include <hex/io/number_text.h>
#include <hex/io/output_file.h>
#include <spline/io/bext.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>

namespace spline::io {
namespace {

using hex::io::append_number;

/// Rows with more non-zeros are written dense.
constexpr std::size_t most_sparse = 20;

/// Text of doubles, remembered: extraction coefficients take few values, so most are copied, not converted.
class NumberWriter {
  public:
    void append(std::string& text, double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        Entry& entry = entries_[(bits * 0x9e3779b97f4a7c15ULL) >> (64 - bits_of_size)];
        if (entry.length == 0 || entry.bits != bits) {
            const std::size_t before = text.size();
            append_number(text, value);
            entry.bits = bits;
            entry.length = static_cast<std::uint8_t>(text.size() - before);
            std::memcpy(entry.text, text.data() + before, entry.length);
            return;
        }
        text.append(entry.text, entry.length);
    }

  private:
    static constexpr int bits_of_size = 12;
    struct Entry {
        std::uint64_t bits = 0;
        std::uint8_t length = 0;
        char text[31];
    };
    std::vector<Entry> entries_ = std::vector<Entry>(std::size_t{1} << bits_of_size);
};

void append_element(std::string& text, const ElementExtraction& extraction, NumberWriter& numbers) {
    text += "belem ";
    append_number(text, extraction.functions.size());
    text += " 3 3 3\n";
    for (std::size_t i = 0; i < extraction.functions.size(); ++i) {
        if (i > 0) text += ' ';
        append_number(text, extraction.functions[i]);
    }
    text += '\n';
    for (const auto& row : extraction.coefficients) {
        const auto non_zeros = static_cast<std::size_t>(64 - std::count(row.begin(), row.end(), 0.0));
        if (non_zeros > most_sparse) {
            text += 'd';
            for (const double value : row) {
                text += ' ';
                numbers.append(text, value);
            }
        } else {
            text += "s ";
            append_number(text, non_zeros);
            for (std::size_t column = 0; column < row.size(); ++column) {
                if (row[column] == 0.0) continue;
                text += ' ';
                append_number(text, column);
                text += ' ';
                numbers.append(text, row[column]);
            }
        }
        text += '\n';
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
        // Chunks are formatted in parallel, a wave of them at a time, and written in order.
        constexpr std::size_t chunk_size = 16, wave = 16;
        struct Chunk {
            explicit Chunk(const BezierSpline& from) : gather(from) {}
            ExtractionGatherer gather;
            NumberWriter numbers;
            std::string text;
        };
        std::vector<Chunk> chunks(wave, Chunk(spline));
        const std::size_t count = spline.element_count();
        for (std::size_t first = 0; first < count; first += wave * chunk_size) {
            context.check_cancelled();
            context.progress("writing", static_cast<double>(first) / static_cast<double>(count));
            hex::parallel_for(
                wave,
                [&](std::size_t c) {
                    chunks[c].text.clear();
                    const std::size_t begin = first + c * chunk_size;
                    for (std::size_t e = begin; e < std::min(count, begin + chunk_size); ++e)
                        append_element(chunks[c].text, chunks[c].gather(e), chunks[c].numbers);
                },
                1);
            for (const Chunk& chunk : chunks) file.write(chunk.text);
        }
        file.commit();
    });
}

}  // namespace spline::io
