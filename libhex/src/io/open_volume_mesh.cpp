// OpenVolumeMesh files (.ovm, ASCII): vertices, edges, faces made of half-edges, cells made of half-faces.
#include "io/formats.h"
#include "io/text_scanner.h"
#include "io/vtk_cells.h"

#include <hex/base/error.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <array>
#include <map>

namespace hex::io {
namespace {

class OpenVolumeMeshReader {
  public:
    explicit OpenVolumeMeshReader(const InputFile& file) : scanner_(file, '#') {}

    MeshData read() {
        if (upper_case(scanner_.word("OVM")) != "OVM")
            scanner_.fail("not an OpenVolumeMesh file: it does not start with OVM");
        const std::string encoding = upper_case(scanner_.word("ASCII"));
        if (encoding != "ASCII") scanner_.unsupported("only ASCII OpenVolumeMesh files are read");
        section("Vertices");
        const std::size_t points = scanner_.count("the number of vertices", 6);
        data_.points().reserve(points);
        for (std::size_t i = 0; i < points; ++i) data_.points().push_back(scanner_.point());
        section("Edges");
        edges();
        section("Faces");
        faces();
        section("Polyhedra");
        const std::size_t cells = scanner_.count("the number of polyhedra", 4);
        for (std::size_t c = 0; c < cells; ++c) cell(c);
        orient_cells();
        properties(cells);
        if (cells > 0) return std::move(data_);
        for (std::size_t f = 0; f < face_count(); ++f)
            data_.add_polygon(face(f), face_parts_.empty() ? 1 : face_parts_[f]);
        return std::move(data_);
    }

  private:
    void section(const char* name) {
        const auto word = scanner_.word(name);
        if (lower_case(word) != lower_case(name))
            scanner_.fail(std::string(name) + " should be here, not " + in_quotes(word));
    }

    void edges() {
        const std::size_t count = scanner_.count("the number of edges", 4);
        edges_.reserve(count);
        for (std::size_t e = 0; e < count; ++e) {
            const std::uint32_t a = scanner_.point_index(data_.points().size(), 0);
            edges_.push_back({a, scanner_.point_index(data_.points().size(), 0)});
        }
    }

    /// The corners of a face are the starts of its half-edges: 2 e from the first vertex of edge e to the
    /// second, 2 e + 1 back.
    void faces() {
        const std::size_t count = scanner_.count("the number of faces", 6);
        for (std::size_t f = 0; f < count; ++f) {
            const std::size_t sides = scanner_.count("the number of sides", 2);
            if (sides < 3) scanner_.fail("a face with " + std::to_string(sides) + " sides");
            std::uint32_t end = 0, start = 0;
            for (std::size_t i = 0; i < sides; ++i) {
                const std::uint32_t half_edge = scanner_.point_index(2 * edges_.size(), 0);
                const auto& edge = edges_[half_edge / 2];
                const std::uint32_t from = edge[half_edge % 2], to = edge[1 - half_edge % 2];
                if (i == 0) start = from;
                if (i > 0 && from != end) scanner_.fail("the half-edges of a face do not follow each other");
                end = to;
                face_corners_.push_back(from);
            }
            if (end != start) scanner_.fail("the half-edges of a face do not close");
            face_offsets_.push_back(face_corners_.size());
        }
    }

    std::size_t face_count() const { return face_offsets_.size() - 1; }
    std::span<const std::uint32_t> face(std::size_t f) const {
        return std::span(face_corners_).subspan(face_offsets_[f], face_offsets_[f + 1] - face_offsets_[f]);
    }

    /// Half-face 2 f is face f as it is, 2 f + 1 the same from behind.
    std::array<std::uint32_t, 4> half_face(std::uint32_t h) const {
        const auto corners = face(h / 2);
        if (corners.size() != 4)
            scanner_.unsupported("a cell has a face of " + std::to_string(corners.size()) +
                                 " sides: only hexahedra are read");
        std::array<std::uint32_t, 4> result{corners[0], corners[1], corners[2], corners[3]};
        if (h % 2 == 1) std::reverse(result.begin(), result.end());
        return result;
    }

    void cell(std::size_t c) {
        const std::size_t count = scanner_.count("the number of half-faces", 2);
        if (count != 6)
            scanner_.unsupported("cell " + std::to_string(c) + " has " + std::to_string(count) +
                                 " faces: only hexahedra are read");
        std::array<std::array<std::uint32_t, 4>, 6> faces{};
        for (auto& corners : faces) corners = half_face(scanner_.point_index(2 * face_count(), 0));
        // Half-faces look out of their cell, or all of them into it. The first is the bottom, and the
        // corner above a bottom corner is its neighbour that is not on the bottom.
        const auto& bottom = faces[0];
        HexCell result;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::uint32_t above = other_neighbour(faces, bottom, bottom[i]);
            result[i] = VertexId(bottom[i]);
            result[i + 4] = VertexId(above);
        }
        for (std::size_t i = 0; i < 8; ++i)
            if (std::find(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(i), result[i]) !=
                result.begin() + static_cast<std::ptrdiff_t>(i))
                scanner_.fail("the faces of cell " + std::to_string(c) + " make no hexahedron");
        require_faces(faces, result, c);
        data_.hexahedra.push_back(result);
    }

    std::uint32_t other_neighbour(const std::array<std::array<std::uint32_t, 4>, 6>& faces,
                                  const std::array<std::uint32_t, 4>& bottom, std::uint32_t corner) const {
        for (std::size_t f = 1; f < 6; ++f) {
            for (std::size_t i = 0; i < 4; ++i) {
                if (faces[f][i] != corner) continue;
                for (const std::uint32_t next : {faces[f][(i + 1) % 4], faces[f][(i + 3) % 4]})
                    if (std::find(bottom.begin(), bottom.end(), next) == bottom.end()) return next;
            }
        }
        scanner_.fail("the faces of a cell do not close");
    }

    /// The six faces are those of the hexahedron.
    void require_faces(std::array<std::array<std::uint32_t, 4>, 6> faces, const HexCell& cell,
                       std::size_t c) const {
        std::array<std::array<std::uint32_t, 4>, 6> expected{};
        for (std::size_t f = 0; f < 6; ++f) {
            for (std::size_t i = 0; i < 4; ++i)
                expected[f][i] = cell[static_cast<std::size_t>(hexahedron::face_corners[f][i])].value();
            std::sort(expected[f].begin(), expected[f].end());
            std::sort(faces[f].begin(), faces[f].end());
        }
        std::sort(expected.begin(), expected.end());
        std::sort(faces.begin(), faces.end());
        if (faces != expected)
            scanner_.fail("the faces of cell " + std::to_string(c) + " make no hexahedron");
    }

    /// The bottom of ours, seen from outside, runs 0 3 2 1. Whether the half-faces of a file look out of
    /// their cells or into them is not said in it: programs do both. The sign of the whole volume tells.
    void orient_cells() {
        double volume = 0.0;
        for (const HexCell& cell : data_.hexahedra) {
            const auto point = [&](int i) -> const Vec3& {
                return data_.surface.points[cell[static_cast<std::size_t>(i)].index()];
            };
            for (const auto& face : hexahedron::face_corners) {
                const Vec3 a = point(face[0]) - point(0), b = point(face[1]) - point(0);
                const Vec3 c = point(face[2]) - point(0), d = point(face[3]) - point(0);
                volume += a.dot(b.cross(c)) + a.dot(c.cross(d));
            }
        }
        if (volume >= 0.0) return;
        for (HexCell& cell : data_.hexahedra) {
            std::swap(cell[1], cell[3]);
            std::swap(cell[5], cell[7]);
        }
    }

    /// Properties named as part ids of cells (or of faces, in a surface) are taken, the others skipped.
    void properties(std::size_t cells) {
        while (!scanner_.at_end()) {
            const std::string kind = lower_case(scanner_.word("a kind of property"));
            const std::string type = lower_case(scanner_.word("a type"));
            std::string_view name = scanner_.rest_of_line();
            if (name.size() > 1 && name.front() == '"' && name.back() == '"')
                name = name.substr(1, name.size() - 2);
            std::size_t count = 0;
            if (kind == "vprop")
                count = data_.points().size();
            else if (kind == "eprop")
                count = edges_.size();
            else if (kind == "heprop")
                count = 2 * edges_.size();
            else if (kind == "fprop")
                count = face_count();
            else if (kind == "hfprop")
                count = 2 * face_count();
            else if (kind == "cprop")
                count = cells;
            else if (kind == "mprop")
                count = 1;
            else
                scanner_.fail("a kind of property should be here, not " + in_quotes(kind));
            const bool wanted = type == "int" && names_part_ids(name) && (kind == "cprop" || kind == "fprop");
            if (wanted) {
                auto& parts = kind == "cprop" ? data_.hexahedron_parts : face_parts_;
                parts.clear();
                for (std::size_t i = 0; i < count; ++i) parts.push_back(scanner_.small_integer("a part id"));
            } else {
                data_.warn("property-skipped", "property " + in_quotes(name) + " is skipped");
                for (std::size_t i = 0; i < count && !scanner_.at_end(); ++i) scanner_.rest_of_line();
            }
        }
    }

    TextScanner scanner_;
    MeshData data_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<std::uint32_t> face_corners_;
    std::vector<std::size_t> face_offsets_ = {0};
    std::vector<int> face_parts_;
};

void write_start(OutputFile& out, std::span<const Vec3> points) {
    out.write("OVM ASCII\nVertices\n");
    append_number(out.buffer(), points.size());
    out.buffer() += '\n';
    append_points(out, points);
}

void append_line(std::string& text, std::initializer_list<std::size_t> numbers) {
    bool first = true;
    for (const std::size_t number : numbers) {
        if (!first) text += ' ';
        first = false;
        append_number(text, number);
    }
    text += '\n';
}

void write_parts(OutputFile& out, const char* kind, std::span<const int> parts) {
    out.write(std::string(kind).append(" int \"").append(part_field) + "\"\n");
    for (const int part : parts) {
        append_number(out.buffer(), part);
        out.buffer() += '\n';
        out.flush_if_large();
    }
}

}  // namespace

MeshData read_open_volume_mesh(const InputFile& file) {
    return OpenVolumeMeshReader(file).read();
}

void write_open_volume_mesh_surface(OutputFile& out, const PolygonSoup& soup) {
    write_start(out, soup.points);
    std::map<std::array<std::uint32_t, 2>, std::size_t> edge_of;
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<std::size_t> half_edges;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto polygon = soup.polygon(f);
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const std::uint32_t a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            const std::array key = {std::min(a, b), std::max(a, b)};
            const auto [found, added] = edge_of.emplace(key, edges.size());
            if (added) edges.push_back(key);
            half_edges.push_back(2 * found->second + (a == key[0] ? 0 : 1));
        }
    }
    std::string& text = out.buffer();
    text += "Edges\n";
    append_line(text, {edges.size()});
    for (const auto& edge : edges) {
        append_line(text, {edge[0], edge[1]});
        out.flush_if_large();
    }
    text += "Faces\n";
    append_line(text, {soup.size()});
    for (std::size_t f = 0; f < soup.size(); ++f) {
        append_number(text, soup.polygon(f).size());
        for (std::size_t i = soup.offsets[f]; i < soup.offsets[f + 1]; ++i) {
            text += ' ';
            append_number(text, half_edges[i]);
        }
        text += '\n';
        out.flush_if_large();
    }
    text += "Polyhedra\n0\n";
    if (has_parts(soup.parts)) write_parts(out, "FProp", soup.parts);
}

void write_open_volume_mesh_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields&) {
    write_start(out, mesh.positions());
    const EdgeTable edges = edge_table(mesh);
    std::string& text = out.buffer();
    text += "Edges\n";
    append_line(text, {edges.size()});
    for (const auto& ends : edges.vertices) {
        append_line(text, {ends[0].index(), ends[1].index()});
        out.flush_if_large();
    }
    // A face is listed once, as its first cell sees it from outside.
    std::vector<std::size_t> face_of(mesh.half_face_count());
    std::vector<HalfFaceId> faces;
    for (const HalfFaceId h : mesh.half_faces()) {
        const bool second = !mesh.is_boundary(h) && mesh.twin(h) < h;
        face_of[h.index()] = second ? face_of[mesh.twin(h).index()] : faces.size();
        if (!second) faces.push_back(h);
    }
    text += "Faces\n";
    append_line(text, {faces.size()});
    for (const HalfFaceId h : faces) {
        const auto corners = mesh.face_vertices(h);
        text += '4';
        for (std::size_t i = 0; i < 4; ++i) {
            const EdgeId e = edges.find(corners[i], corners[(i + 1) % 4]);
            text += ' ';
            append_number(text, 2 * e.index() + (edges.vertices[e.index()][0] == corners[i] ? 0U : 1U));
        }
        text += '\n';
        out.flush_if_large();
    }
    text += "Polyhedra\n";
    append_line(text, {mesh.cell_count()});
    for (const CellId c : mesh.cells()) {
        text += '6';
        for (int f = 0; f < 6; ++f) {
            const HalfFaceId h = HexMesh::half_face(c, f);
            const std::size_t face = face_of[h.index()];
            text += ' ';
            append_number(text, 2 * face + (faces[face] == h ? 0U : 1U));
        }
        text += '\n';
        out.flush_if_large();
    }
    if (has_parts(mesh.parts())) write_parts(out, "CProp", mesh.parts());
}

}  // namespace hex::io
