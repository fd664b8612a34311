// Writes legacy VTK files, version 3.0, ASCII: unstructured grids.
#include "io/formats.h"
#include "io/vtk_cells.h"

#include <hex/io/number_text.h>

namespace hex::io {
namespace {

void write_points(OutputFile& out, std::span<const Vec3> points) {
    out.write("# vtk DataFile Version 3.0\nwritten by hexspline\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS ");
    std::string& text = out.buffer();
    append_number(text, points.size());
    text += " double\n";
    append_points(out, points);
}

void write_section(OutputFile& out, const char* keyword, std::size_t first, const char* separator = "\n") {
    out.buffer() += keyword;
    append_number(out.buffer(), first);
    out.buffer() += separator;
}

template <class Value>
void write_lines(OutputFile& out, std::size_t count, const Value& value) {
    for (std::size_t i = 0; i < count; ++i) {
        append_number(out.buffer(), value(i));
        out.buffer() += '\n';
        out.flush_if_large();
    }
}

/// VTK's own escape: a field name is one word.
std::string encoded_name(std::string_view name) {
    static constexpr char digits[] = "0123456789ABCDEF";
    std::string result;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte <= 32 || byte >= 127 || c == '%' || c == '"') {
            result += '%';
            result += digits[byte / 16];
            result += digits[byte % 16];
        } else {
            result += c;
        }
    }
    return result.empty() ? "field" : result;
}

void write_scalars(OutputFile& out, const std::vector<ScalarField>& fields) {
    for (const ScalarField& field : fields) {
        out.write("SCALARS " + encoded_name(field.name) + " double 1\nLOOKUP_TABLE default\n");
        write_lines(out, field.values.size(), [&](std::size_t i) { return field.values[i]; });
    }
}

void write_parts(OutputFile& out, std::span<const int> parts) {
    out.write("SCALARS " + std::string(part_field) + " int 1\nLOOKUP_TABLE default\n");
    write_lines(out, parts.size(), [&](std::size_t i) { return parts[i]; });
}

}  // namespace

void write_legacy_vtk_surface(OutputFile& out, const PolygonSoup& soup) {
    write_points(out, soup.points);
    write_section(out, "CELLS ", soup.size(), " ");
    write_section(out, "", soup.size() + soup.corners.size());
    for (std::size_t f = 0; f < soup.size(); ++f) {
        append_polygon(out.buffer(), soup.polygon(f));
        out.buffer() += '\n';
        out.flush_if_large();
    }
    write_section(out, "CELL_TYPES ", soup.size());
    write_lines(out, soup.size(), [&](std::size_t f) { return polygon_type(soup.polygon(f).size()); });
    if (has_parts(soup.parts)) {
        write_section(out, "CELL_DATA ", soup.size());
        write_parts(out, soup.parts);
    }
}

void write_legacy_vtk_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields) {
    write_points(out, mesh.positions());
    write_section(out, "CELLS ", mesh.cell_count(), " ");
    write_section(out, "", 9 * mesh.cell_count());
    std::string& text = out.buffer();
    for (const CellId c : mesh.cells()) {
        text += '8';
        for (const VertexId v : mesh.cell(c)) {
            text += ' ';
            append_number(text, v.value());
        }
        text += '\n';
        out.flush_if_large();
    }
    write_section(out, "CELL_TYPES ", mesh.cell_count());
    write_lines(out, mesh.cell_count(), [](std::size_t) { return int{vtk_hexahedron}; });
    const bool parts = has_parts(mesh.parts());
    if (parts || !fields.cell.empty()) {
        write_section(out, "CELL_DATA ", mesh.cell_count());
        if (parts) write_parts(out, mesh.parts());
        write_scalars(out, fields.cell);
    }
    if (!fields.vertex.empty()) {
        write_section(out, "POINT_DATA ", mesh.vertex_count());
        write_scalars(out, fields.vertex);
    }
}

}  // namespace hex::io
