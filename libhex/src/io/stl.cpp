// STL, ASCII and binary. The format repeats the coordinates of a vertex in each triangle; equal ones are
// welded.
#include "io/byte_order.h"
#include "io/formats.h"
#include "io/text_scanner.h"

#include <hex/base/error.h>

#include <array>
#include <bit>
#include <unordered_map>

namespace hex::io {
namespace {

constexpr std::size_t binary_header = 84;
constexpr std::size_t binary_triangle = 50;

/// Gives equal coordinates the same index, in the order of their first use.
class Welder {
  public:
    explicit Welder(MeshData& data) : data_(data) {}

    void add_triangle(const std::array<Vec3, 3>& points, int part) {
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t i = 0; i < 3; ++i) corners[i] = index(points[i]);
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
            degenerate_.push_back(count_);
        } else {
            data_.add_polygon(corners, part);
        }
        ++count_;
    }

    void finish() {
        if (degenerate_.empty()) return;
        data_.warn("degenerate-triangles",
                   "triangles with two equal corners dropped: " + list_ids(degenerate_), "triangle",
                   degenerate_);
    }

  private:
    using Key = std::array<std::uint64_t, 3>;
    struct Hash {
        std::size_t operator()(const Key& key) const {
            std::uint64_t h = 0;
            for (const std::uint64_t bits : key) {
                h = (h ^ bits) * 0x9E3779B97F4A7C15u;
                h ^= h >> 32;
            }
            return h;
        }
    };

    std::uint32_t index(const Vec3& point) {
        Key key;
        // Adding zero makes -0 and 0 the same.
        for (std::size_t k = 0; k < 3; ++k)
            key[k] = std::bit_cast<std::uint64_t>(point[static_cast<int>(k)] + 0.0);
        const auto [entry, added] =
            index_.try_emplace(key, static_cast<std::uint32_t>(data_.points().size()));
        if (added) data_.points().push_back(point);
        return entry->second;
    }

    MeshData& data_;
    std::unordered_map<Key, std::uint32_t, Hash> index_;
    std::vector<std::int64_t> degenerate_;
    std::int64_t count_ = 0;
};

MeshData read_binary(const InputFile& file, std::size_t count) {
    MeshData data;
    Welder welder(data);
    for (std::size_t t = 0; t < count; ++t) {
        const std::size_t start = binary_header + t * binary_triangle;
        std::array<Vec3, 3> points;
        for (std::size_t i = 0; i < 9; ++i)
            points[i / 3][static_cast<int>(i % 3)] = static_cast<double>(
                load<float>(file.bytes().data() + start + 12 + 4 * i, std::endian::little));
        for (const Vec3& point : points) {
            if (!point.allFinite())
                throw Error(ErrorKind::bad_input,
                            "triangle " + std::to_string(t) + " has a coordinate that is not finite",
                            file.byte_place(start));
        }
        welder.add_triangle(points, 1);
    }
    welder.finish();
    return data;
}

void expect(TextScanner& scanner, const char* word) {
    const auto found = scanner.word(word);
    if (lower_case(found) != word)
        scanner.fail(std::string(word) + " should be here, not " + in_quotes(found));
}

/// Each solid is a part: 1, 2, ... in the order of the file.
MeshData read_text(const InputFile& file) {
    MeshData data;
    Welder welder(data);
    TextScanner scanner(file);
    int part = 0;
    while (!scanner.at_end()) {
        expect(scanner, "solid");
        scanner.rest_of_line();
        ++part;
        while (true) {
            const std::string word = lower_case(scanner.word("facet or endsolid"));
            if (word == "endsolid") break;
            if (word != "facet") scanner.fail("facet or endsolid should be here, not " + in_quotes(word));
            expect(scanner, "normal");
            // Some programs write nan for the normal of a sliver; we do not use it.
            for (int k = 0; k < 3; ++k) scanner.word("a normal");
            expect(scanner, "outer");
            expect(scanner, "loop");
            std::array<Vec3, 3> points;
            for (Vec3& point : points) {
                expect(scanner, "vertex");
                point = scanner.point();
            }
            welder.add_triangle(points, part);
            expect(scanner, "endloop");
            expect(scanner, "endfacet");
        }
        scanner.rest_of_line();
    }
    welder.finish();
    return data;
}

}  // namespace

MeshData read_stl(const InputFile& file) {
    const std::string_view bytes = file.bytes();
    const bool has_solid = lower_case(trimmed(bytes.substr(file.text_start(), 256))).starts_with("solid");
    if (bytes.size() >= binary_header) {
        const std::size_t count = load<std::uint32_t>(bytes.data() + 80, std::endian::little);
        // The size decides: many binary files start with "solid" too.
        const std::size_t expected = binary_header + count * binary_triangle;
        if (bytes.size() == expected) return read_binary(file, count);
        // No text has zero bytes.
        const bool is_longer = bytes.size() > expected && bytes.substr(0, expected).find('\0') != bytes.npos;
        if (!has_solid || is_longer) {
            if (bytes.size() < expected)
                throw Error(ErrorKind::bad_input,
                            "the header tells of " + std::to_string(count) + " triangles, " +
                                std::to_string(expected) + " bytes, but the file has " +
                                std::to_string(bytes.size()),
                            file.byte_place(80), "the file is cut off or no STL file");
            MeshData data = read_binary(file, count);
            data.warn("extra-bytes",
                      std::to_string(bytes.size() - expected) + " bytes after the last triangle skipped");
            return data;
        }
    }
    if (!has_solid) throw Error(ErrorKind::bad_input, "neither an ASCII nor a binary STL file", file.name());
    return read_text(file);
}

/// As text: binary STL holds 32-bit floats only, which would move the vertices.
void write_stl(OutputFile& out, const PolygonSoup& soup) {
    out.write("solid hexspline\n");
    std::string& text = out.buffer();
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto polygon = soup.polygon(f);
        const Vec3 &a = soup.points[polygon[0]], &b = soup.points[polygon[1]], &c = soup.points[polygon[2]];
        const Vec3 u = b - a, v = c - a;
        const Vec3 normal(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                          u.x() * v.y() - u.y() * v.x());
        const double length = normal.norm();
        text += "facet normal ";
        append_point(text, std::isfinite(length) && length > 0 ? Vec3(normal / length) : Vec3(0, 0, 0));
        text += "\nouter loop\n";
        for (const std::uint32_t corner : polygon) {
            text += "vertex ";
            append_point(text, soup.points[corner]);
            text += '\n';
        }
        text += "endloop\nendfacet\n";
        out.flush_if_large();
    }
    out.write("endsolid hexspline\n");
}

}  // namespace hex::io
