// VTK XML unstructured grids (.vtu), in every encoding that VTK writes with zlib or without compression.
#include "io/byte_order.h"
#include "io/formats.h"
#include "io/text_scanner.h"
#include "io/vtk_cells.h"
#include "io/vtu_arrays.h"

#include <hex/base/error.h>

#include <pugixml.hpp>

#include <array>
#include <functional>
#include <limits>

namespace hex::io {
namespace {

class VtuReader {
  public:
    explicit VtuReader(const InputFile& file) : file_(file), text_(file.bytes().substr(file.text_start())) {}

    MeshData read() {
        parse();
        const pugi::xml_node root = document_.child("VTKFile");
        if (!root) fail("not a VTK XML file: there is no VTKFile element", document_);
        const std::string_view kind = root.attribute("type").value();
        if (kind != "UnstructuredGrid")
            throw Error(ErrorKind::unsupported, "the file holds a " + in_quotes(kind), place(root),
                        "UnstructuredGrid can be read");
        read_encoding(root);
        const pugi::xml_node grid = root.child("UnstructuredGrid");
        if (!grid.child("Piece")) fail("the file has no Piece", root);
        for (const pugi::xml_node piece : grid.children("Piece")) read_piece(piece);
        if (!parts_complete_) parts_.clear();
        append_cells(data_, cells_, parts_, file_.name());
        return std::move(data_);
    }

  private:
    std::string place(const pugi::xml_node& node) const {
        const auto offset = node.offset_debug();
        return file_.line_place(file_.text_start() + static_cast<std::size_t>(offset > 0 ? offset : 0));
    }
    [[noreturn]] void fail(const std::string& what, const pugi::xml_node& node) const {
        throw Error(ErrorKind::bad_input, what, place(node));
    }

    /// Raw appended data is no XML: only what is before it is parsed.
    void parse() {
        const std::size_t tag = text_.find("<AppendedData");
        xml_ = text_.substr(0, tag);
        if (tag != std::string_view::npos) {
            const std::size_t tag_end = text_.find('>', tag);
            const std::size_t start = tag_end == std::string_view::npos ? tag_end : text_.find('_', tag_end);
            if (start == std::string_view::npos)
                throw Error(ErrorKind::bad_input, "the appended data does not start with '_'",
                            file_.line_place(file_.text_start() + tag));
            xml_ += text_.substr(tag, tag_end + 1 - tag);
            xml_ += "</AppendedData></VTKFile>";
            appended_ = text_.substr(start + 1);
        }
        const auto result = document_.load_buffer_inplace(xml_.data(), xml_.size());
        if (!result) {
            const std::size_t at = std::min<std::size_t>(
                text_.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)));
            throw Error(ErrorKind::bad_input, std::string("not well-formed XML: ") + result.description(),
                        file_.line_place(file_.text_start() + at));
        }
    }

    void read_encoding(const pugi::xml_node& root) {
        const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
        encoding_.order = order == "BigEndian" ? std::endian::big : std::endian::little;
        encoding_.wide_headers = std::string_view(root.attribute("header_type").value()) == "UInt64";
        compressor_ = root.attribute("compressor").value();
        encoding_.compressed = !compressor_.empty();
        appended_base64_ =
            std::string_view(root.child("AppendedData").attribute("encoding").as_string("base64")) != "raw";
    }

    std::size_t count(const pugi::xml_node& node, const char* name) const {
        const std::string_view text = node.attribute(name).value();
        const auto value = parse_integer(text);
        // A point or cell takes at least a bit, even when it is compressed.
        if (!value || *value < 0 ||
            static_cast<std::size_t>(*value) > std::min<std::size_t>(64 * file_.bytes().size(), 0xFFFFFFFEu))
            fail(std::string(name) + " should be a number that fits the file, not " + in_quotes(text), node);
        return static_cast<std::size_t>(*value);
    }

    static std::optional<VtuType> type_of(const pugi::xml_node& node) {
        static constexpr std::array<std::string_view, 10> names = {
            "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Float32", "Float64"};
        const auto found =
            std::find(names.begin(), names.end(), std::string_view(node.attribute("type").value()));
        if (found == names.end()) return std::nullopt;
        return static_cast<VtuType>(found - names.begin());
    }

    template <class Number>
    std::vector<Number> numbers(const pugi::xml_node& node, std::size_t count) const {
        const auto type = type_of(node);
        if (!type) fail("unknown number type " + in_quotes(node.attribute("type").value()), node);
        if (std::is_integral_v<Number> && (*type == VtuType::float32 || *type == VtuType::float64))
            fail("array " + in_quotes(node.attribute("Name").value()) + " should hold integers", node);
        const std::string_view format = node.attribute("format").as_string("ascii");
        if (format == "ascii") return text_numbers<Number>(node, count);
        const std::uint64_t expected = std::uint64_t{count} * size_of(*type);
        if (format == "binary") {
            VtuBytes bytes(trimmed(node.text().get()), true, place(node));
            return to_numbers<Number>(payload(bytes, expected), *type, encoding_.order);
        }
        if (format != "appended") fail("unknown format " + in_quotes(format), node);
        const auto offset = parse_integer(node.attribute("offset").value());
        if (!offset || *offset < 0 || static_cast<std::size_t>(*offset) > appended_.size())
            fail("the offset " + in_quotes(node.attribute("offset").value()) + " is not in the appended data",
                 node);
        VtuBytes bytes(appended_.substr(static_cast<std::size_t>(*offset)), appended_base64_, place(node));
        return to_numbers<Number>(payload(bytes, expected), *type, encoding_.order);
    }

    std::string payload(VtuBytes& bytes, std::uint64_t expected) const {
        if (encoding_.compressed && compressor_ != "vtkZLibDataCompressor")
            throw Error(ErrorKind::unsupported,
                        "compression by " + in_quotes(compressor_) + " is not supported",
                        place(document_.child("VTKFile")), "write the file with zlib or without compression");
        return take_payload(bytes, encoding_, expected);
    }

    template <class Number>
    std::vector<Number> text_numbers(const pugi::xml_node& node, std::size_t count) const {
        TextScanner scanner(file_, node.text().get(), place(node));
        scanner.check_count(static_cast<long long>(count), "the number of values", 2);
        std::vector<Number> result(count);
        for (Number& value : result) {
            if constexpr (std::is_integral_v<Number>)
                value = scanner.integer("a value");
            else
                value = scanner.real("a value");
        }
        if (!scanner.at_end()) scanner.fail("more values than the " + std::to_string(count) + " announced");
        return result;
    }

    pugi::xml_node array(const pugi::xml_node& parent, const char* name) const {
        const pugi::xml_node node = parent.find_child_by_attribute("DataArray", "Name", name);
        if (!node) fail(std::string("the array ") + name + " is missing", parent);
        return node;
    }

    void read_piece(const pugi::xml_node& piece) {
        const std::size_t points = count(piece, "NumberOfPoints");
        const std::size_t cells = count(piece, "NumberOfCells");
        const std::size_t first_point = data_.points().size();
        if (points > 0) {
            const pugi::xml_node node = piece.child("Points").child("DataArray");
            if (!node) fail("the piece has no Points", piece);
            if (node.attribute("NumberOfComponents").as_int() != 3)
                fail("points need three components", node);
            const std::vector<double> values = numbers<double>(node, 3 * points);
            for (std::size_t i = 0; i < points; ++i) {
                const Vec3 point(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
                if (!point.allFinite())
                    fail("point " + std::to_string(i) + " has a coordinate that is not finite", node);
                data_.points().push_back(point);
            }
        }
        if (cells == 0) return;
        read_cells(piece, cells, points, first_point);
        read_parts(piece.child("CellData"), cells);
    }

    void read_cells(const pugi::xml_node& piece, std::size_t count, std::size_t points,
                    std::size_t first_point) {
        const pugi::xml_node parent = piece.child("Cells");
        const pugi::xml_node offsets_node = array(parent, "offsets");
        const auto offsets = numbers<std::int64_t>(offsets_node, count);
        std::int64_t before = 0;
        const auto most = static_cast<std::int64_t>(64 * file_.bytes().size());
        for (std::size_t c = 0; c < count; ++c) {
            if (offsets[c] < before || offsets[c] > most)
                fail("offset " + std::to_string(offsets[c]) + " of cell " + std::to_string(c) +
                         " does not follow " + std::to_string(before),
                     offsets_node);
            before = offsets[c];
            cells_.offsets.push_back(cells_.corners.size() + static_cast<std::size_t>(before));
        }
        const pugi::xml_node corners_node = array(parent, "connectivity");
        const auto corners = numbers<std::int64_t>(corners_node, static_cast<std::size_t>(before));
        cells_.corners.reserve(cells_.corners.size() + corners.size());
        for (const std::int64_t v : corners) {
            if (v < 0 || v >= static_cast<std::int64_t>(points))
                fail("point index " + std::to_string(v) + " is not in 0.." +
                         std::to_string(static_cast<std::int64_t>(points) - 1),
                     corners_node);
            cells_.corners.push_back(static_cast<std::uint32_t>(first_point + static_cast<std::size_t>(v)));
        }
        const pugi::xml_node types_node = array(parent, "types");
        for (const std::int64_t type : numbers<std::int64_t>(types_node, count)) {
            if (type < 0 || type > 255)
                fail("cell type " + std::to_string(type) + " does not exist", types_node);
            cells_.types.push_back(static_cast<int>(type));
        }
    }

    void read_parts(const pugi::xml_node& parent, std::size_t count) {
        for (const pugi::xml_node node : parent.children("DataArray")) {
            const std::string_view name = node.attribute("Name").value();
            if (!names_part_ids(name) || node.attribute("NumberOfComponents").as_int(1) > 1 || !type_of(node))
                continue;
            if (const auto parts = to_parts(numbers<double>(node, count))) {
                parts_.insert(parts_.end(), parts->begin(), parts->end());
                return;
            }
            data_.warn("part-ids-skipped",
                       "cell field " + in_quotes(name) +
                           " holds values that are no integers of 32 bits: part ids skipped");
        }
        parts_complete_ = false;
    }

    const InputFile& file_;
    std::string_view text_;
    std::string xml_;
    std::string_view appended_;
    bool appended_base64_ = false;
    pugi::xml_document document_;
    VtuEncoding encoding_;
    std::string compressor_;
    MeshData data_;
    VtkCells cells_;
    std::vector<int> parts_;
    bool parts_complete_ = true;
};

/// An array to write: how many bytes it has, and what writes them.
struct Array {
    std::string name;
    const char* type;
    int components;
    std::uint64_t bytes;
    std::function<void(OutputFile&)> write;
};

template <class Number, class Value>
Array make_array(std::string name, const char* type, std::size_t count, Value value, int components = 1) {
    return {std::move(name), type, components, count * sizeof(Number), [=](OutputFile& out) {
                for (std::size_t i = 0; i < count; ++i) {
                    append_little_endian<Number>(out.buffer(), static_cast<Number>(value(i)));
                    out.flush_if_large();
                }
            }};
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

/// The numbers go behind the XML as raw bytes: exact, compact and quick to read.
struct GridWriter {
    std::size_t points;
    std::size_t cells;
    std::vector<Array> point_data, cell_data, point_arrays, cell_arrays;

    void write(OutputFile& out) const {
        std::string& text = out.buffer();
        text +=
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"";
        append_number(text, points);
        text += "\" NumberOfCells=\"";
        append_number(text, cells);
        text += "\">\n";
        std::uint64_t offset = 0;
        declare(text, "PointData", point_data, offset);
        declare(text, "CellData", cell_data, offset);
        declare(text, "Points", point_arrays, offset);
        declare(text, "Cells", cell_arrays, offset);
        text += "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
        for (const auto* group : {&point_data, &cell_data, &point_arrays, &cell_arrays}) {
            for (const Array& array : *group) {
                append_little_endian<std::uint64_t>(text, array.bytes);
                array.write(out);
            }
        }
        text += "\n</AppendedData>\n</VTKFile>\n";
    }

    static void declare(std::string& text, const char* element, const std::vector<Array>& arrays,
                        std::uint64_t& offset) {
        text.append("<").append(element).append(">\n");
        for (const Array& array : arrays) {
            text.append("<DataArray type=\"")
                .append(array.type)
                .append("\" Name=\"")
                .append(escaped(array.name));
            text += "\" NumberOfComponents=\"";
            append_number(text, array.components);
            text += "\" format=\"appended\" offset=\"";
            append_number(text, offset);
            text += "\"/>\n";
            offset += array.bytes + sizeof(std::uint64_t);
        }
        text.append("</").append(element).append(">\n");
    }
};

Array coordinates(std::span<const Vec3> points) {
    const auto value = [=](std::size_t i) { return points[i / 3][static_cast<int>(i % 3)]; };
    return make_array<double>("Points", "Float64", 3 * points.size(), value, 3);
}

Array part_array(std::span<const int> parts) {
    return make_array<std::int32_t>(std::string(part_field), "Int32", parts.size(),
                                    [=](std::size_t i) { return parts[i]; });
}

void add_fields(std::vector<Array>& arrays, const std::vector<ScalarField>& fields) {
    for (const ScalarField& field : fields) {
        const std::span<const double> values = field.values;
        arrays.push_back(make_array<double>(field.name, "Float64", values.size(),
                                            [=](std::size_t i) { return values[i]; }));
    }
}

}  // namespace

MeshData read_vtu(const InputFile& file) {
    return VtuReader(file).read();
}

void write_vtu_surface(OutputFile& out, const PolygonSoup& soup) {
    GridWriter grid{soup.points.size(), soup.size(), {}, {}, {}, {}};
    grid.point_arrays = {coordinates(soup.points)};
    if (has_parts(soup.parts)) grid.cell_data = {part_array(soup.parts)};
    grid.cell_arrays = {make_array<std::int64_t>("connectivity", "Int64", soup.corners.size(),
                                                 [&](std::size_t i) { return soup.corners[i]; }),
                        make_array<std::int64_t>("offsets", "Int64", soup.size(),
                                                 [&](std::size_t f) { return soup.offsets[f + 1]; }),
                        make_array<std::uint8_t>("types", "UInt8", soup.size(), [&](std::size_t f) {
                            return polygon_type(soup.polygon(f).size());
                        })};
    grid.write(out);
}

void write_vtu_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields) {
    GridWriter grid{mesh.vertex_count(), mesh.cell_count(), {}, {}, {}, {}};
    grid.point_arrays = {coordinates(mesh.positions())};
    if (has_parts(mesh.parts())) grid.cell_data.push_back(part_array(mesh.parts()));
    add_fields(grid.cell_data, fields.cell);
    add_fields(grid.point_data, fields.vertex);
    grid.cell_arrays = {
        make_array<std::int64_t>("connectivity", "Int64", 8 * mesh.cell_count(),
                                 [&](std::size_t i) { return mesh.cell_array()[i / 8][i % 8].index(); }),
        make_array<std::int64_t>("offsets", "Int64", mesh.cell_count(),
                                 [](std::size_t c) { return 8 * (c + 1); }),
        make_array<std::uint8_t>("types", "UInt8", mesh.cell_count(),
                                 [](std::size_t) { return int{vtk_hexahedron}; })};
    grid.write(out);
}

}  // namespace hex::io
