/// \file vtk_cells.h
/// Cells by VTK's type numbers, shared by the legacy and the XML format.
#pragma once

#include <hex/io/mesh_data.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hex::io {

enum VtkCellType : int {
    vtk_triangle = 5,
    vtk_polygon = 7,
    vtk_quad = 9,
    vtk_hexahedron = 12,
};

/// Cell c has the type `types[c]` and the corners `corners[offsets[c]] ..`.
struct VtkCells {
    std::vector<int> types;
    std::vector<std::size_t> offsets = {0};
    std::vector<std::uint32_t> corners;
};

/// Adds the polygons and hexahedra to `data`; points and lines are skipped with a warning. `parts` has one
/// part id a cell, or is empty. Corner indices must be valid. Throws Error{unsupported} located at `place`
/// for cells of other types, Error{bad_input} for a wrong number of corners.
void append_cells(MeshData& data, const VtkCells& cells, std::span<const int> parts,
                  const std::string& place);

/// VTK's type of a polygon with this many corners.
int polygon_type(std::size_t corners);

/// True for the names that part ids of cells go by.
bool names_part_ids(std::string_view name);

/// The name our writers give to part ids.
inline constexpr std::string_view part_field = "part_id";

/// Values of a cell field as part ids; none when one of them is no integer of 32 bits.
std::optional<std::vector<int>> to_parts(std::span<const double> values);

}  // namespace hex::io
