// OFF, with the colours, normals and texture coordinates of its variants passed over.
#include "io/formats.h"
#include "io/text_scanner.h"

#include <hex/base/error.h>

namespace hex::io {
namespace {

/// ST, C, N in front of OFF announce more numbers a vertex, on the same line as its coordinates.
void read_header(TextScanner& scanner) {
    const std::string word = upper_case(scanner.word("OFF"));
    if (!word.ends_with("OFF")) scanner.fail("not an OFF file: it starts with " + in_quotes(word));
    std::string_view prefix = std::string_view(word).substr(0, word.size() - 3);
    if (prefix.starts_with("ST")) prefix.remove_prefix(2);
    if (prefix.starts_with("C")) prefix.remove_prefix(1);
    if (prefix.starts_with("N")) prefix.remove_prefix(1);
    if (!prefix.empty()) scanner.unsupported(in_quotes(word) + ": only three-dimensional OFF is read");
    if (upper_case(scanner.peek()) == "BINARY") scanner.unsupported("binary OFF is not supported");
}

}  // namespace

MeshData read_off(const InputFile& file) {
    TextScanner scanner(file, '#');
    read_header(scanner);
    const std::size_t vertices = scanner.count("the number of vertices", 1);
    const std::size_t faces = scanner.count("the number of faces", 1);
    // The number of edges, which some files leave out.
    scanner.rest_of_line();
    scanner.check_count(static_cast<long long>(vertices), "the number of vertices", 6);
    scanner.check_count(static_cast<long long>(faces), "the number of faces", 2);

    MeshData data;
    data.points().reserve(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
        data.points().push_back(scanner.point());
        scanner.rest_of_line();
    }
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < faces; ++f) {
        const std::size_t count = scanner.count("the number of corners", 2);
        if (count < 3) scanner.fail("a face with " + std::to_string(count) + " corners");
        corners.clear();
        for (std::size_t i = 0; i < count; ++i) corners.push_back(scanner.point_index(vertices, 0));
        data.add_polygon(corners, 1);
        // A colour may follow.
        scanner.rest_of_line();
    }
    if (!scanner.at_end()) {
        const std::int64_t line = scanner.line();
        data.warn("extra-text", "text after the last face is skipped: " + in_quotes(scanner.rest_of_line()),
                  "line", {line});
    }
    return data;
}

void write_off(OutputFile& out, const PolygonSoup& soup) {
    out.write("OFF\n");
    std::string& text = out.buffer();
    append_number(text, soup.points.size());
    text += ' ';
    append_number(text, soup.size());
    text += " 0\n";
    append_points(out, soup.points);
    for (std::size_t f = 0; f < soup.size(); ++f) {
        append_polygon(text, soup.polygon(f));
        text += '\n';
        out.flush_if_large();
    }
}

}  // namespace hex::io
