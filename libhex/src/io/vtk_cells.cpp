#include "io/vtk_cells.h"

#include "io/input_file.h"

#include <hex/base/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hex::io {
namespace {

/// Names of the types that we do not take.
std::string type_name(int type) {
    struct Name {
        int type;
        const char* name;
    };
    static constexpr std::array names = {Name{10, "tetrahedron"},
                                         Name{13, "wedge"},
                                         Name{14, "pyramid"},
                                         Name{15, "pentagonal prism"},
                                         Name{16, "hexagonal prism"},
                                         Name{21, "quadratic edge"},
                                         Name{22, "quadratic triangle"},
                                         Name{23, "quadratic quadrilateral"},
                                         Name{24, "quadratic tetrahedron"},
                                         Name{25, "quadratic hexahedron"},
                                         Name{29, "triquadratic hexahedron"},
                                         Name{41, "convex point set"},
                                         Name{42, "polyhedron"},
                                         Name{69, "Lagrange triangle"},
                                         Name{70, "Lagrange quadrilateral"},
                                         Name{72, "Lagrange hexahedron"},
                                         Name{76, "Bezier triangle"},
                                         Name{77, "Bezier quadrilateral"},
                                         Name{79, "Bezier hexahedron"}};
    for (const Name& known : names) {
        if (known.type == type)
            return std::string("a ") + known.name + " (VTK type " + std::to_string(type) + ")";
    }
    return "of VTK type " + std::to_string(type);
}

/// Number of corners of a type; 0 when it varies.
std::size_t fixed_size(int type) {
    switch (type) {
        case vtk_triangle:
            return 3;
        case 8:
        case vtk_quad:
            return 4;
        case 11:
        case vtk_hexahedron:
            return 8;
        default:
            return 0;
    }
}

class CellSorter {
  public:
    CellSorter(MeshData& data, const VtkCells& cells, std::span<const int> parts, const std::string& place)
        : data_(data), cells_(cells), parts_(parts), place_(place) {}

    void run() {
        std::vector<std::int64_t> skipped;
        const bool with_parts = !parts_.empty();
        data_.hexahedra.reserve(static_cast<std::size_t>(
            std::count(cells_.types.begin(), cells_.types.end(), int{vtk_hexahedron})));
        for (std::size_t c = 0; c < cells_.types.size(); ++c) {
            const auto corners = std::span(cells_.corners)
                                     .subspan(cells_.offsets[c], cells_.offsets[c + 1] - cells_.offsets[c]);
            const int type = cells_.types[c];
            const std::size_t needed = fixed_size(type);
            if (needed != 0 && corners.size() != needed)
                fail(c, "has " + std::to_string(corners.size()) + " corners, and its type needs " +
                            std::to_string(needed));
            const int part = with_parts ? parts_[c] : 1;
            switch (type) {
                case 1:  // vertex, poly-vertex, line, polyline
                case 2:
                case 3:
                case 4:
                    skipped.push_back(static_cast<std::int64_t>(c));
                    break;
                case vtk_triangle:
                case vtk_quad:
                    data_.add_polygon(corners, part);
                    break;
                case 6:
                    add_strip(c, corners, part);
                    break;
                case vtk_polygon:
                    if (corners.size() < 3)
                        fail(c, "is a polygon with " + std::to_string(corners.size()) + " corners");
                    data_.add_polygon(corners, part);
                    break;
                case 8:  // pixel: rows instead of a ring
                    data_.add_polygon(std::array{corners[0], corners[1], corners[3], corners[2]}, part);
                    break;
                case 11:  // voxel
                    add_hexahedron(corners, {0, 1, 3, 2, 4, 5, 7, 6}, part);
                    break;
                case vtk_hexahedron:
                    add_hexahedron(corners, {0, 1, 2, 3, 4, 5, 6, 7}, part);
                    break;
                default:
                    throw Error(ErrorKind::unsupported,
                                "cell " + std::to_string(c) + " is " + type_name(type), place_,
                                "only triangles, quadrilaterals, polygons and hexahedra are read");
            }
        }
        if (!skipped.empty())
            data_.warn("cells-skipped", std::to_string(skipped.size()) + " point and line cells skipped",
                       "cell", std::move(skipped));
    }

  private:
    [[noreturn]] void fail(std::size_t cell, const std::string& what) const {
        throw Error(ErrorKind::bad_input, "cell " + std::to_string(cell) + " " + what, place_);
    }

    void add_hexahedron(std::span<const std::uint32_t> corners, const std::array<std::size_t, 8>& order,
                        int part) {
        HexCell cell;
        for (std::size_t i = 0; i < 8; ++i) cell[i] = VertexId(corners[order[i]]);
        data_.hexahedra.push_back(cell);
        if (!parts_.empty()) data_.hexahedron_parts.push_back(part);
    }

    void add_strip(std::size_t c, std::span<const std::uint32_t> corners, int part) {
        if (corners.size() < 3)
            fail(c, "is a triangle strip with " + std::to_string(corners.size()) + " corners");
        for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
            // Every second triangle of a strip is turned over.
            const std::size_t odd = i % 2;
            data_.add_polygon(std::array{corners[i + odd], corners[i + 1 - odd], corners[i + 2]}, part);
        }
    }

    MeshData& data_;
    const VtkCells& cells_;
    std::span<const int> parts_;
    const std::string& place_;
};

}  // namespace

void append_cells(MeshData& data, const VtkCells& cells, std::span<const int> parts,
                  const std::string& place) {
    CellSorter(data, cells, parts, place).run();
}

int polygon_type(std::size_t corners) {
    return corners == 3 ? vtk_triangle : corners == 4 ? vtk_quad : vtk_polygon;
}

bool names_part_ids(std::string_view name) {
    const std::string lower = lower_case(name);
    return lower == part_field || lower == "part" || lower == "partid" || lower == "pid" ||
           lower == "patch" || lower == "patches";
}

std::optional<std::vector<int>> to_parts(std::span<const double> values) {
    std::vector<int> parts;
    parts.reserve(values.size());
    for (const double value : values) {
        using Limits = std::numeric_limits<int>;
        if (!(value >= Limits::min() && value <= Limits::max()) || value != std::floor(value))
            return std::nullopt;
        parts.push_back(static_cast<int>(value));
    }
    return parts;
}

}  // namespace hex::io
