// Medit .mesh files (ASCII): triangles, quadrilaterals and hexahedra with references.
#include "io/formats.h"
#include "io/text_scanner.h"

#include <hex/base/error.h>

#include <algorithm>
#include <array>
#include <span>

namespace hex::io {
namespace {

class MeditReader {
  public:
    explicit MeditReader(const InputFile& file) : scanner_(file, '#') {}

    MeshData read() {
        if (lower_case(scanner_.word("MeshVersionFormatted")) != "meshversionformatted")
            scanner_.fail("not a Medit file: it does not start with MeshVersionFormatted");
        scanner_.integer("the version");
        bool ended = false;
        while (!ended && !scanner_.at_end()) ended = !section(std::string(scanner_.word("a keyword")));
        if (!ended) data_.warn("no-end", "the file has no End: it may have been cut off");
        // Reference 0 (or a negative one) everywhere means: no references.
        drop_common_reference(data_.surface.parts);
        drop_common_reference(data_.hexahedron_parts);
        return std::move(data_);
    }

  private:
    /// Returns false at the end of the mesh.
    bool section(const std::string& name) {
        const std::string keyword = lower_case(name);
        if (keyword == "end") return false;
        if (keyword == "dimension") {
            const long long dimension = scanner_.integer("the dimension");
            if (dimension != 3)
                scanner_.unsupported("a mesh of dimension " + std::to_string(dimension) + "; only 3 is read");
        } else if (keyword == "vertices") {
            vertices();
        } else if (keyword == "triangles") {
            polygons<3>();
        } else if (keyword == "quadrilaterals") {
            polygons<4>();
        } else if (keyword == "hexahedra" || keyword == "hexaedra") {
            hexahedra();
        } else if (keyword == "tetrahedra" || keyword == "prisms" || keyword == "pentahedra" ||
                   keyword == "pyramids") {
            const std::size_t count = scanner_.count("the number of elements", 8);
            if (count > 0)
                scanner_.unsupported("the mesh holds " + std::to_string(count) + " " + name,
                                     "only triangles, quadrilaterals and hexahedra are read");
        } else if (is_letter(name.front())) {
            skip(name, keyword);
        } else {
            scanner_.fail("a keyword should be here, not " + in_quotes(name));
        }
        return true;
    }

    static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

    void vertices() {
        if (!data_.points().empty()) scanner_.fail("Vertices a second time");
        const std::size_t count = scanner_.count("the number of vertices", 8);
        data_.points().reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            data_.points().push_back(scanner_.point());
            scanner_.word("the reference of a vertex");
        }
    }

    template <std::size_t Corners>
    void polygons() {
        const std::size_t count = scanner_.count("the number of polygons", 2 * Corners + 2);
        for (std::size_t i = 0; i < count; ++i) {
            std::array<std::uint32_t, Corners> corners{};
            for (auto& v : corners) v = scanner_.point_index(data_.points().size(), 1);
            data_.add_polygon(corners, scanner_.small_integer("a reference"));
        }
    }

    void hexahedra() {
        const std::size_t count = scanner_.count("the number of hexahedra", 18);
        data_.hexahedra.reserve(count);
        data_.hexahedron_parts.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            HexCell cell;
            for (VertexId& v : cell) v = VertexId(scanner_.point_index(data_.points().size(), 1));
            data_.hexahedra.push_back(cell);
            data_.hexahedron_parts.push_back(scanner_.small_integer("a reference"));
        }
    }

    /// Everything up to the next word that is no number.
    void skip(const std::string& name, const std::string& keyword) {
        static constexpr std::array<std::string_view, 13> harmless = {"edges",
                                                                      "corners",
                                                                      "ridges",
                                                                      "requiredvertices",
                                                                      "requirededges",
                                                                      "requiredtriangles",
                                                                      "requiredquadrilaterals",
                                                                      "normals",
                                                                      "normalatvertices",
                                                                      "tangents",
                                                                      "tangentatvertices",
                                                                      "boundingbox",
                                                                      "geometry"};
        if (std::find(harmless.begin(), harmless.end(), keyword) == harmless.end())
            data_.warn("unknown-keyword",
                       "keyword " + in_quotes(name) + " is not known; its data is skipped");
        while (!scanner_.at_end() && !is_letter(scanner_.peek().front())) scanner_.word("a value");
    }

    static void drop_common_reference(std::vector<int>& parts) {
        if (!parts.empty() && parts.front() <= 0 &&
            std::all_of(parts.begin(), parts.end(), [&](int p) { return p == parts.front(); }))
            std::fill(parts.begin(), parts.end(), 1);
    }

    TextScanner scanner_;
    MeshData data_;
};

void write_vertices(OutputFile& out, std::span<const Vec3> points) {
    out.write("MeshVersionFormatted 2\nDimension 3\nVertices\n");
    std::string& text = out.buffer();
    append_number(text, points.size());
    text += '\n';
    for (const Vec3& point : points) {
        append_point(text, point);
        text += " 0\n";
        out.flush_if_large();
    }
}

}  // namespace

MeshData read_medit(const InputFile& file) {
    // MFEM uses the same extension.
    if (file.bytes().substr(file.text_start()).starts_with("MFEM")) return read_mfem(file);
    return MeditReader(file).read();
}

void write_medit_surface(OutputFile& out, const PolygonSoup& soup) {
    write_vertices(out, soup.points);
    std::string& text = out.buffer();
    for (const std::size_t corners : {std::size_t{3}, std::size_t{4}}) {
        std::size_t count = 0;
        for (std::size_t f = 0; f < soup.size(); ++f) count += soup.polygon(f).size() == corners ? 1 : 0;
        if (count == 0) continue;
        text += corners == 3 ? "Triangles\n" : "Quadrilaterals\n";
        append_number(text, count);
        text += '\n';
        for (std::size_t f = 0; f < soup.size(); ++f) {
            if (soup.polygon(f).size() != corners) continue;
            for (const std::uint32_t v : soup.polygon(f)) {
                append_number(text, v + std::size_t{1});
                text += ' ';
            }
            append_number(text, soup.parts[f]);
            text += '\n';
            out.flush_if_large();
        }
    }
    out.write("End\n");
}

void write_medit_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields&) {
    write_vertices(out, mesh.positions());
    std::string& text = out.buffer();
    text += "Hexahedra\n";
    append_number(text, mesh.cell_count());
    text += '\n';
    for (const CellId c : mesh.cells()) {
        for (const VertexId v : mesh.cell(c)) {
            append_number(text, v.index() + 1);
            text += ' ';
        }
        append_number(text, mesh.part(c));
        text += '\n';
        out.flush_if_large();
    }
    out.write("End\n");
}

}  // namespace hex::io
