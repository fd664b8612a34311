// PLY, ASCII and binary in both byte orders; elements and properties that say nothing about the surface are
// passed over.
#include "io/byte_order.h"
#include "io/formats.h"
#include "io/text_scanner.h"
#include "io/vtk_cells.h"

#include <hex/base/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace hex::io {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(Type type) {
    static constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

struct Property {
    std::string name;
    Type type = Type::float64;
    std::optional<Type> list_count;
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

class PlyReader {
  public:
    explicit PlyReader(const InputFile& file) : scanner_(file) {}

    MeshData read() {
        header();
        for (const Element& element : elements_) {
            if (element.name == "vertex")
                vertices(element);
            else if (element.name == "face")
                faces(element);
            else
                skip(element);
        }
        warn_of_rest();
        return std::move(data_);
    }

  private:
    void header() {
        if (scanner_.word("ply") != "ply") scanner_.fail("not a PLY file: it does not start with 'ply'");
        bool has_format = false;
        while (true) {
            const std::string word(scanner_.word("a line of the header"));
            if (word == "end_header") break;
            if (word == "comment" || word == "obj_info") {
                scanner_.rest_of_line();
            } else if (word == "format") {
                format();
                has_format = true;
            } else if (word == "element") {
                Element element;
                element.name = scanner_.word("the name of an element");
                element.count = scanner_.count("the number of elements", 1);
                elements_.push_back(std::move(element));
            } else if (word == "property") {
                property();
            } else {
                scanner_.fail("unknown word " + in_quotes(word) + " in the header");
            }
        }
        if (!has_format) scanner_.fail("the header has no format line");
        // Binary data starts behind the line.
        scanner_.rest_of_line();
    }

    void format() {
        const auto name = scanner_.word("the format");
        binary_ = name != "ascii";
        if (name == "binary_big_endian")
            order_ = std::endian::big;
        else if (binary_ && name != "binary_little_endian")
            scanner_.unsupported("unknown format " + in_quotes(name));
        scanner_.rest_of_line();
    }

    void property() {
        if (elements_.empty()) scanner_.fail("a property before any element");
        Property property;
        if (scanner_.peek() == "list") {
            scanner_.word("list");
            property.list_count = type();
        }
        property.type = type();
        property.name = scanner_.word("the name of a property");
        elements_.back().properties.push_back(std::move(property));
    }

    Type type() {
        static constexpr std::array<std::array<std::string_view, 2>, 8> names = {{{"char", "int8"},
                                                                                  {"uchar", "uint8"},
                                                                                  {"short", "int16"},
                                                                                  {"ushort", "uint16"},
                                                                                  {"int", "int32"},
                                                                                  {"uint", "uint32"},
                                                                                  {"float", "float32"},
                                                                                  {"double", "float64"}}};
        const auto name = scanner_.word("a type");
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (name == names[i][0] || name == names[i][1]) return static_cast<Type>(i);
        }
        scanner_.fail("unknown type " + in_quotes(name));
    }

    [[noreturn]] void fail(const std::string& what) const {
        if (binary_) throw Error(ErrorKind::bad_input, what, scanner_.file().byte_place(scanner_.position()));
        scanner_.fail(what);
    }

    template <class Number>
    double take() {
        const auto value = load<Number>(scanner_.text().data() + scanner_.position(), order_);
        scanner_.seek(scanner_.position() + sizeof(Number));
        return static_cast<double>(value);
    }

    /// Every type of the format fits into a double.
    double value(Type type) {
        if (!binary_) return scanner_.real("a value");
        if (scanner_.text().size() - scanner_.position() < size_of(type))
            fail("the file ends within its data");
        switch (type) {
            case Type::int8:
                return take<std::int8_t>();
            case Type::uint8:
                return take<std::uint8_t>();
            case Type::int16:
                return take<std::int16_t>();
            case Type::uint16:
                return take<std::uint16_t>();
            case Type::int32:
                return take<std::int32_t>();
            case Type::uint32:
                return take<std::uint32_t>();
            case Type::float32:
                return take<float>();
            case Type::float64:
                break;
        }
        return take<double>();
    }

    void skip_value(Type type) {
        if (binary_)
            value(type);
        else
            scanner_.word("a value");
    }

    std::size_t list_size(const Property& property) {
        const double size = value(*property.list_count);
        const std::size_t bytes = binary_ ? size_of(property.type) : 2;
        const auto left = static_cast<double>((scanner_.text().size() - scanner_.position() + 1) / bytes);
        if (!(size >= 0 && size <= left) || size != std::floor(size))
            fail("a list of " + short_text(size) + " values does not fit into the file");
        return static_cast<std::size_t>(size);
    }

    static std::string short_text(double number) {
        std::string text;
        append_number(text, number);
        return text;
    }

    void skip_property(const Property& property) {
        const std::size_t count = property.list_count ? list_size(property) : 1;
        for (std::size_t i = 0; i < count; ++i) skip_value(property.type);
    }

    /// An element takes at least this much room in the file.
    void check_count(const Element& element) const {
        std::size_t bytes = 0;
        for (const Property& property : element.properties)
            bytes += binary_ ? size_of(property.list_count.value_or(property.type)) : 2;
        if (bytes == 0 && element.count > 0)
            fail("element " + in_quotes(element.name) + " has no properties");
        scanner_.check_count(static_cast<long long>(element.count), "the number of elements",
                             std::max<std::size_t>(bytes, 1));
    }

    void skip(const Element& element) {
        check_count(element);
        if (element.count > 0 && element.name == "tristrips")
            scanner_.unsupported("triangle strips are not supported", "write the file with faces");
        for (std::size_t i = 0; i < element.count; ++i) {
            for (const Property& property : element.properties) skip_property(property);
        }
    }

    void vertices(const Element& element) {
        check_count(element);
        if (!data_.points().empty()) fail("vertices a second time");
        std::array<bool, 3> found{};
        std::vector<int> axis;
        for (const Property& property : element.properties) {
            const bool coordinate = property.name.size() == 1 && property.name[0] >= 'x' &&
                                    property.name[0] <= 'z' && !property.list_count;
            axis.push_back(coordinate ? property.name[0] - 'x' : -1);
            if (coordinate) found[static_cast<std::size_t>(axis.back())] = true;
        }
        if (!found[0] || !found[1] || !found[2]) fail("the vertices have no x, y and z");
        data_.points().reserve(element.count);
        for (std::size_t i = 0; i < element.count; ++i) {
            Vec3 point;
            for (std::size_t p = 0; p < axis.size(); ++p) {
                if (axis[p] < 0)
                    skip_property(element.properties[p]);
                else
                    point[axis[p]] = value(element.properties[p].type);
            }
            if (!point.allFinite())
                fail("vertex " + std::to_string(i) + " has a coordinate that is not finite");
            data_.points().push_back(point);
        }
    }

    void faces(const Element& element) {
        check_count(element);
        if (data_.surface.size() > 0) fail("faces a second time");
        const bool has_corners =
            std::any_of(element.properties.begin(), element.properties.end(), is_corner_list);
        if (element.count > 0 && !has_corners) fail("the faces have no vertex_indices");
        std::vector<std::uint32_t> corners;
        std::vector<double> parts;
        for (std::size_t f = 0; f < element.count; ++f) {
            double part = 1;
            for (const Property& property : element.properties) {
                if (is_corner_list(property))
                    read_corners(property, corners);
                else if (!property.list_count && names_part_ids(property.name))
                    part = value(property.type);
                else
                    skip_property(property);
            }
            data_.add_polygon(corners, 1);
            parts.push_back(part);
        }
        if (auto ids = to_parts(parts))
            data_.surface.parts = std::move(*ids);
        else
            data_.warn("part-ids-skipped", "the part ids of the faces are no integers of 32 bits: skipped");
    }

    static bool is_corner_list(const Property& property) {
        return property.list_count && (property.name == "vertex_indices" || property.name == "vertex_index");
    }

    void read_corners(const Property& property, std::vector<std::uint32_t>& corners) {
        const std::size_t count = list_size(property);
        if (count < 3) fail("a face with " + std::to_string(count) + " corners");
        corners.clear();
        for (std::size_t i = 0; i < count; ++i) {
            const double v = value(property.type);
            if (!(v >= 0 && v < static_cast<double>(data_.points().size())) || v != std::floor(v))
                fail("point index " + short_text(v) + " is not in 0.." +
                     std::to_string(static_cast<long long>(data_.points().size()) - 1));
            corners.push_back(static_cast<std::uint32_t>(v));
        }
    }

    /// The header may count less than there is.
    void warn_of_rest() {
        if (scanner_.at_end()) return;
        if (binary_)
            data_.warn("extra-bytes", "bytes after the last element are skipped");
        else
            data_.warn("extra-text", "text after the last element is skipped", "line", {scanner_.line()});
    }

    TextScanner scanner_;
    MeshData data_;
    bool binary_ = false;
    std::endian order_ = std::endian::little;
    std::vector<Element> elements_;
};

}  // namespace

MeshData read_ply(const InputFile& file) {
    return PlyReader(file).read();
}

void write_ply(OutputFile& out, const PolygonSoup& soup) {
    const bool parts = has_parts(soup.parts);
    std::size_t most = 0;
    for (std::size_t f = 0; f < soup.size(); ++f) most = std::max(most, soup.polygon(f).size());
    std::string& text = out.buffer();
    text += "ply\nformat ascii 1.0\ncomment written by hexspline\nelement vertex ";
    append_number(text, soup.points.size());
    text += "\nproperty double x\nproperty double y\nproperty double z\nelement face ";
    append_number(text, soup.size());
    text += most < 256 ? "\nproperty list uchar int vertex_indices\n"
                       : "\nproperty list uint int vertex_indices\n";
    if (parts) text.append("property int ").append(part_field) += '\n';
    text += "end_header\n";
    append_points(out, soup.points);
    for (std::size_t f = 0; f < soup.size(); ++f) {
        append_polygon(text, soup.polygon(f));
        if (parts) {
            text += ' ';
            append_number(text, soup.parts[f]);
        }
        text += '\n';
        out.flush_if_large();
    }
}

}  // namespace hex::io
