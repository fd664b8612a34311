// MFEM meshes, version 1.0: elements with attributes (the parts) and vertices.
#include "io/formats.h"
#include "io/part_numbers.h"
#include "io/text_scanner.h"

#include <hex/base/error.h>

#include <algorithm>
#include <array>

namespace hex::io {
namespace {

enum Geometry : int {
    geometry_point = 0,
    geometry_segment = 1,
    geometry_triangle = 2,
    geometry_square = 3,
    geometry_cube = 5
};

class MfemReader {
  public:
    explicit MfemReader(const InputFile& file) : scanner_(file, '#') {}

    MeshData read() {
        const std::string_view first = scanner_.rest_of_line();
        if (!first.starts_with("MFEM mesh v1."))
            throw Error(first.starts_with("MFEM") ? ErrorKind::unsupported : ErrorKind::bad_input,
                        "not a mesh of MFEM's format 1: it starts with " + in_quotes(first),
                        scanner_.file().line_place(0));
        while (!scanner_.at_end()) {
            const std::string keyword(scanner_.word("a keyword"));
            if (keyword == "dimension") {
                dimension_ = scanner_.small_integer("the dimension");
                if (dimension_ != 2 && dimension_ != 3)
                    scanner_.unsupported("a mesh of dimension " + std::to_string(dimension_));
            } else if (keyword == "elements") {
                elements(elements_);
            } else if (keyword == "boundary") {
                elements(boundary_);
            } else if (keyword == "vertices") {
                vertices();
            } else if (keyword == "nodes") {
                scanner_.unsupported("curved meshes (a section nodes) are not supported");
            } else if (keyword == "mfem_mesh_end") {
                break;
            } else {
                scanner_.fail("unknown keyword " + in_quotes(keyword));
            }
        }
        if (!has_vertices_) scanner_.fail("the file has no vertices");
        const bool solid =
            dimension_ == 3 && std::any_of(elements_.begin(), elements_.end(),
                                           [](const Element& e) { return e.geometry == geometry_cube; });
        for (const Element& element : elements_) add(element);
        // The boundary of a surface is made of lines; that of a solid repeats what the solid says.
        if (!solid)
            for (const Element& element : boundary_) add(element);
        if (skipped_ > 0)
            data_.warn("elements-skipped", std::to_string(skipped_) + " points and lines are skipped");
        return std::move(data_);
    }

  private:
    struct Element {
        int attribute;
        int geometry;
        std::array<long long, 8> corners;
        std::size_t position;
    };

    void elements(std::vector<Element>& list) {
        if (!list.empty()) scanner_.fail("this section is there a second time");
        const std::size_t count = scanner_.count("the number of elements", 6);
        list.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            Element element{};
            element.attribute = scanner_.small_integer("an attribute");
            element.geometry = scanner_.small_integer("a geometry type");
            element.position = scanner_.position();
            for (std::size_t c = 0; c < corners_of(element.geometry); ++c)
                element.corners[c] = scanner_.integer("a vertex");
            list.push_back(element);
        }
    }

    std::size_t corners_of(int geometry) const {
        switch (geometry) {
            case geometry_point:
                return 1;
            case geometry_segment:
                return 2;
            case geometry_triangle:
                return 3;
            case geometry_square:
                return 4;
            case geometry_cube:
                return 8;
            default:
                scanner_.unsupported(
                    "elements of geometry type " + std::to_string(geometry) + " are not supported",
                    "triangles, squares and cubes are read");
        }
    }

    void vertices() {
        if (has_vertices_) scanner_.fail("vertices a second time");
        has_vertices_ = true;
        const std::size_t count = scanner_.count("the number of vertices", 1);
        if (scanner_.peek() == "nodes")
            scanner_.unsupported("curved meshes (a section nodes) are not supported");
        const long long numbers = scanner_.integer("the number of coordinates");
        if (numbers != 3)
            scanner_.unsupported("vertices with " + std::to_string(numbers) +
                                 " coordinates; only 3 are read");
        scanner_.check_count(static_cast<long long>(count), "the number of vertices", 6);
        data_.points().reserve(count);
        for (std::size_t i = 0; i < count; ++i) data_.points().push_back(scanner_.point());
    }

    void add(const Element& element) {
        const std::size_t count = corners_of(element.geometry);
        std::array<std::uint32_t, 8> corners{};
        for (std::size_t i = 0; i < count; ++i) {
            const long long v = element.corners[i];
            if (v < 0 || v >= static_cast<long long>(data_.points().size()))
                throw Error(ErrorKind::bad_input, "vertex " + std::to_string(v) + " does not exist",
                            scanner_.file().line_place(element.position));
            corners[i] = static_cast<std::uint32_t>(v);
        }
        if (count < 3) {
            ++skipped_;
            return;
        }
        if (element.attribute < 1)
            throw Error(ErrorKind::bad_input,
                        "attribute " + std::to_string(element.attribute) +
                            " of an element is not positive, as MFEM demands",
                        scanner_.file().line_place(element.position));
        if (count < 8) {
            data_.add_polygon(std::span(corners).first(count), element.attribute);
        } else {
            HexCell cell;
            for (std::size_t i = 0; i < 8; ++i) cell[i] = VertexId(corners[i]);
            data_.hexahedra.push_back(cell);
            data_.hexahedron_parts.push_back(element.attribute);
        }
    }

    TextScanner scanner_;
    MeshData data_;
    int dimension_ = 3;
    bool has_vertices_ = false;
    std::size_t skipped_ = 0;
    std::vector<Element> elements_, boundary_;
};

void append_element(std::string& text, int attribute, Geometry geometry, const auto& corners) {
    append_number(text, attribute);
    text += ' ';
    append_number(text, static_cast<int>(geometry));
    for (const auto v : corners) {
        text += ' ';
        append_number(text, v);
    }
    text += '\n';
}

void write_end(OutputFile& out, std::span<const Vec3> points) {
    out.write("\nboundary\n0\n\nvertices\n");
    append_number(out.buffer(), points.size());
    out.write("\n3\n");
    append_points(out, points);
}

void write_start(OutputFile& out, int dimension, std::size_t elements) {
    out.write("MFEM mesh v1.0\n\ndimension\n");
    append_number(out.buffer(), dimension);
    out.write("\n\nelements\n");
    append_number(out.buffer(), elements);
    out.write("\n");
}

}  // namespace

MeshData read_mfem(const InputFile& file) {
    return MfemReader(file).read();
}

void write_mfem_surface(OutputFile& out, const PolygonSoup& soup) {
    require_part_ids(soup.parts, 1, "polygons", "MFEM");
    write_start(out, 2, soup.size());
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto polygon = soup.polygon(f);
        append_element(out.buffer(), soup.parts[f], polygon.size() == 3 ? geometry_triangle : geometry_square,
                       polygon);
        out.flush_if_large();
    }
    write_end(out, soup.points);
}

void write_mfem_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields&) {
    require_part_ids(mesh.parts(), 1, "hexahedra", "MFEM");
    write_start(out, 3, mesh.cell_count());
    for (const CellId c : mesh.cells()) {
        std::array<std::size_t, 8> corners{};
        for (std::size_t i = 0; i < 8; ++i) corners[i] = mesh.cell(c)[i].index();
        append_element(out.buffer(), mesh.part(c), geometry_cube, corners);
        out.flush_if_large();
    }
    write_end(out, mesh.positions());
}

}  // namespace hex::io
