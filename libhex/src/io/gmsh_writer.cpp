// Writes Gmsh meshes, ASCII: one entity with one physical group a part, part 0 without. Element tags are the
// order of the elements. Version 4.1 in .msh, 2.2 in .msh2.
#include "io/formats.h"
#include "io/part_numbers.h"

#include <hex/io/number_text.h>

#include <algorithm>
#include <functional>
#include <map>
#include <vector>

namespace hex::io {
namespace {

/// What the writer wants to know of a mesh, surface or solid.
struct Elements {
    int dimension;
    std::size_t count;
    std::function<int(std::size_t)> part;
    std::function<std::size_t(std::size_t)> corners;
    std::function<std::size_t(std::size_t, std::size_t)> corner;
};

int type_of(std::size_t corners) {
    return corners == 3 ? 2 : corners == 4 ? 3 : 5;
}

template <class... Values>
void append_row(std::string& text, const Values&... values) {
    bool first = true;
    const auto add = [&](const auto& value) {
        if (!first) text += ' ';
        first = false;
        append_number(text, value);
    };
    (add(values), ...);
    text += '\n';
}

/// 0 as the tag of a physical group is none.
std::vector<int> groups_of(std::span<const int> parts) {
    std::vector<int> groups(parts.begin(), parts.end());
    std::erase(groups, 0);
    return groups;
}

void append_header(std::string& text, const char* version, int dimension, std::span<const int> parts,
                   const PartNames& names) {
    const std::vector<int> groups = groups_of(parts);
    const PartNames written = gmsh_names(groups, names);
    text.append("$MeshFormat\n").append(version).append(" 0 8\n$EndMeshFormat\n$PhysicalNames\n");
    append_row(text, groups.size());
    for (const int part : groups) {
        append_number(text, dimension);
        text += ' ';
        append_number(text, part);
        text.append(" \"").append(written.at(part)) += "\"\n";
    }
    text += "$EndPhysicalNames\n";
}

std::vector<int> parts_of(const Elements& elements) {
    std::vector<int> parts;
    for (std::size_t e = 0; e < elements.count; ++e) parts.push_back(elements.part(e));
    require_part_ids(parts, 0, elements.dimension == 2 ? "polygons" : "hexahedra", "Gmsh");
    return distinct_parts(std::move(parts));
}

void append_corners(std::string& text, const Elements& elements, std::size_t e) {
    for (std::size_t i = 0; i < elements.corners(e); ++i) {
        text += ' ';
        append_number(text, elements.corner(e, i) + 1);
    }
    text += '\n';
}

void write_2(OutputFile& out, std::span<const Vec3> points, const Elements& elements,
             const PartNames& names) {
    std::string& text = out.buffer();
    append_header(text, "2.2", elements.dimension, parts_of(elements), names);
    text += "$Nodes\n";
    append_row(text, points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
        append_number(text, v + 1);
        text += ' ';
        append_point(text, points[v]);
        text += '\n';
        out.flush_if_large();
    }
    text += "$EndNodes\n$Elements\n";
    append_row(text, elements.count);
    for (std::size_t e = 0; e < elements.count; ++e) {
        const int part = elements.part(e);
        append_number(text, e + 1);
        text += ' ';
        append_number(text, type_of(elements.corners(e)));
        text += " 2 ";
        append_number(text, part);
        text += ' ';
        append_number(text, part);
        append_corners(text, elements, e);
        out.flush_if_large();
    }
    text += "$EndElements\n";
}

void write_4(OutputFile& out, std::span<const Vec3> points, const Elements& elements,
             const PartNames& names) {
    /// Element lists by part and type.
    std::map<std::pair<int, int>, std::vector<std::size_t>> blocks;
    for (std::size_t e = 0; e < elements.count; ++e)
        blocks[{elements.part(e), type_of(elements.corners(e))}].push_back(e);
    const std::vector<int> parts = parts_of(elements);
    std::string& text = out.buffer();
    append_header(text, "4.1", elements.dimension, parts, names);
    BoundingBox box;
    for (const Vec3& point : points) box.add(point);
    if (box.empty()) box.add(Vec3::Zero());
    text += "$Entities\n";
    const std::size_t surfaces = elements.dimension == 2 ? parts.size() : 0;
    append_row(text, 0, 0, surfaces, parts.size() - surfaces);
    for (const int part : parts) {
        append_number(text, part);
        text += ' ';
        append_point(text, box.lower);
        text += ' ';
        append_point(text, box.upper);
        text += part == 0 ? " 0" : " 1 ";
        if (part != 0) append_number(text, part);
        text += " 0\n";
    }
    text += "$EndEntities\n$Nodes\n";
    append_row(text, 1, points.size(), 1, points.size());
    append_row(text, elements.dimension, parts.empty() ? 1 : parts.front(), 0, points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
        append_row(text, v + 1);
        out.flush_if_large();
    }
    append_points(out, points);
    text += "$EndNodes\n$Elements\n";
    append_row(text, blocks.size(), elements.count, 1, elements.count);
    for (const auto& [key, list] : blocks) {
        append_row(text, elements.dimension, key.first, key.second, list.size());
        for (const std::size_t e : list) {
            append_number(text, e + 1);
            append_corners(text, elements, e);
            out.flush_if_large();
        }
    }
    text += "$EndElements\n";
}

Elements elements_of(const PolygonSoup& soup) {
    return {2, soup.size(), [&](std::size_t f) { return soup.parts[f]; },
            [&](std::size_t f) { return soup.polygon(f).size(); },
            [&](std::size_t f, std::size_t i) { return std::size_t{soup.polygon(f)[i]}; }};
}

Elements elements_of(const HexMesh& mesh) {
    return {3, mesh.cell_count(), [&](std::size_t c) { return mesh.part(CellId(c)); },
            [](std::size_t) { return std::size_t{8}; },
            [&](std::size_t c, std::size_t i) { return mesh.cell(CellId(c))[i].index(); }};
}

}  // namespace

PartNames gmsh_names(std::span<const int> parts, const PartNames& names) {
    return names_within({"\"", "", 127}, groups_of(parts), names);
}

void write_gmsh_surface(OutputFile& out, const PolygonSoup& soup, const PartNames& names) {
    write_4(out, soup.points, elements_of(soup), names);
}

void write_gmsh_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields) {
    write_4(out, mesh.positions(), elements_of(mesh), fields.part_names);
}

void write_gmsh_2_surface(OutputFile& out, const PolygonSoup& soup, const PartNames& names) {
    write_2(out, soup.points, elements_of(soup), names);
}

void write_gmsh_2_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields) {
    write_2(out, mesh.positions(), elements_of(mesh), fields.part_names);
}

}  // namespace hex::io
