#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/io/number_text.h>
#include <hex/io/output_file.h>
#include <spline/io/bext2.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace spline::io {
namespace {

using Row = std::array<double, 64>;

void append_right(std::string& text, const std::string& number, std::size_t width) {
    if (number.size() >= width) text += ' ';
    for (std::size_t i = number.size(); i < width; ++i) text += ' ';
    text += number;
}

/// Numbers in columns, so many a line.
class Columns {
  public:
    Columns(hex::io::OutputFile& file, std::size_t a_line, std::size_t width)
        : file_(file), a_line_(a_line), width_(width) {}

    template <class Number>
    void put(Number value) {
        number_.clear();
        hex::io::append_number(number_, value);
        append_right(file_.buffer(), number_, width_);
        if (++count_ == a_line_) end_line();
    }
    void end_line() {
        if (count_ == 0) return;
        file_.buffer() += '\n';
        file_.flush_if_large();
        count_ = 0;
    }

  private:
    hex::io::OutputFile& file_;
    std::size_t a_line_, width_, count_ = 0;
    std::string number_;
};

std::uint64_t hash_of(const Row& row) {
    std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
    for (const double value : row) {
        hash ^= std::bit_cast<std::uint64_t>(value);
        hash *= 0xff51afd7ed558ccdULL;
        hash ^= hash >> 32;
    }
    return hash;
}

/// Distinct rows in the order in which they came.
class VectorTable {
  public:
    std::uint32_t number_of(const Row& row, std::uint64_t hash) {
        if (2 * count_ >= slots_.size()) grow();
        std::size_t at = hash & (slots_.size() - 1);
        while (slots_[at].id != none) {
            if (slots_[at].hash == hash &&
                std::memcmp(values_.data() + std::size_t{64} * slots_[at].id, row.data(), sizeof(Row)) == 0)
                return slots_[at].id;
            at = (at + 1) & (slots_.size() - 1);
        }
        slots_[at] = {hash, static_cast<std::uint32_t>(count_)};
        values_.insert(values_.end(), row.begin(), row.end());
        return static_cast<std::uint32_t>(count_++);
    }
    std::vector<double> take() { return std::move(values_); }

  private:
    static constexpr std::uint32_t none = 0xffffffffU;
    struct Slot {
        std::uint64_t hash = 0;
        std::uint32_t id = none;
    };
    void grow() {
        std::vector<Slot> old = std::move(slots_);
        slots_.assign(2 * old.size(), {});
        for (const Slot& slot : old) {
            if (slot.id == none) continue;
            std::size_t at = slot.hash & (slots_.size() - 1);
            while (slots_[at].id != none) at = (at + 1) & (slots_.size() - 1);
            slots_[at] = slot;
        }
    }

    std::vector<Slot> slots_ = std::vector<Slot>(1024);
    std::vector<double> values_;
    std::size_t count_ = 0;
};

}  // namespace

Bext2 to_bext2(const BezierSpline& spline, const hex::Context& context) {
    return hex::with_threads(context, [&] {
        Bext2 data;
        data.points = spline.control_points;
        data.weights = spline.weights;
        VectorTable table;
        // Elements are gathered in parallel, a wave of chunks at a time; rows are numbered in order.
        constexpr std::size_t chunk_size = 16, wave = 16;
        struct Chunk {
            explicit Chunk(const BezierSpline& from) : gather(from) {}
            ExtractionGatherer gather;
            std::vector<ElementExtraction> elements;
            std::vector<std::vector<std::uint64_t>> hashes;
        };
        std::vector<Chunk> chunks(wave, Chunk(spline));
        const std::size_t count = spline.element_count();
        for (std::size_t first = 0; first < count; first += wave * chunk_size) {
            context.check_cancelled();
            context.progress("sharing coefficients", static_cast<double>(first) / static_cast<double>(count));
            hex::parallel_for(
                wave,
                [&](std::size_t c) {
                    Chunk& chunk = chunks[c];
                    const std::size_t begin = std::min(count, first + c * chunk_size);
                    const std::size_t end = std::min(count, begin + chunk_size);
                    chunk.elements.resize(end - begin);
                    chunk.hashes.resize(end - begin);
                    for (std::size_t e = begin; e < end; ++e) {
                        chunk.elements[e - begin] = chunk.gather(e);
                        auto& hashes = chunk.hashes[e - begin];
                        hashes.clear();
                        for (const Row& row : chunk.elements[e - begin].coefficients)
                            hashes.push_back(hash_of(row));
                    }
                },
                1);
            for (const Chunk& chunk : chunks) {
                for (std::size_t e = 0; e < chunk.elements.size(); ++e) {
                    const ElementExtraction& element = chunk.elements[e];
                    if (data.blocks.empty() || data.blocks.back().functions != element.functions.size()) {
                        data.blocks.emplace_back();
                        data.blocks.back().degrees = {3, 3, 3};
                        data.blocks.back().functions = element.functions.size();
                    }
                    Bext2::Block& block = data.blocks.back();
                    ++block.elements;
                    block.nodes.insert(block.nodes.end(), element.functions.begin(), element.functions.end());
                    for (std::size_t i = 0; i < element.coefficients.size(); ++i)
                        block.vectors.push_back(table.number_of(element.coefficients[i], chunk.hashes[e][i]));
                }
            }
        }
        data.groups.push_back({64, table.take()});
        return data;
    });
}

void write_bext2(const std::filesystem::path& path, const Bext2& data) {
    constexpr std::size_t largest_id = 99'999'999;
    if (data.points.size() > largest_id || data.vector_count() > largest_id)
        throw hex::Error(hex::ErrorKind::unsupported, "more ids than columns of eight digits can hold",
                         path.string());
    hex::io::OutputFile file(path);
    file.write("B E X T 2.0\n");
    Columns ids(file, 10, 8);
    const auto line = [&](std::initializer_list<std::int64_t> values) {
        for (const std::int64_t value : values) ids.put(value);
        ids.end_line();
    };
    const auto size = [](std::size_t count) { return static_cast<std::int64_t>(count); };
    line({data.patch, size(data.points.size()), size(data.element_count()), size(data.vector_count()),
          data.weight_flag});
    Columns coordinates(file, 4, 24);
    for (std::size_t i = 0; i < data.points.size(); ++i) {
        for (const double x : data.points[i]) coordinates.put(x);
        coordinates.put(data.weights[i]);
    }
    line({size(data.blocks.size())});
    for (const Bext2::Block& block : data.blocks) {
        for (const std::size_t value :
             {static_cast<std::size_t>(block.type), block.elements, block.functions, block.functions})
            ids.put(value);
        for (const int degree : block.degrees) ids.put(degree);
        ids.end_line();
        for (std::size_t e = 0; e < block.elements; ++e) {
            for (const auto* list : {&block.nodes, &block.vectors}) {
                for (std::size_t i = e * block.functions; i < (e + 1) * block.functions; ++i)
                    ids.put((*list)[i] + 1);
                ids.end_line();
            }
        }
    }
    line({size(data.groups.size()), 0});
    for (const Bext2::Group& group : data.groups) line({size(group.count()), size(group.length)});
    Columns coefficients(file, 5, 24);
    for (const Bext2::Group& group : data.groups) {
        for (std::size_t i = 0; i < group.values.size(); ++i) {
            coefficients.put(group.values[i]);
            if ((i + 1) % group.length == 0) coefficients.end_line();
        }
    }
    file.commit();
}

void write_bext2(const std::filesystem::path& path, const BezierSpline& spline, const hex::Context& context) {
    write_bext2(path, to_bext2(spline, context));
}

}  // namespace spline::io
