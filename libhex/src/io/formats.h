/// \file formats.h
/// The readers and writers of the single formats; src/io/format_table.cpp puts them into one table.
///
/// A reader throws Error{bad_input} or Error{unsupported} with a place and returns everything the file holds.
/// A writer throws Error{unsupported} for what the format cannot carry.
#pragma once

#include "io/input_file.h"

#include <hex/io/hex_file.h>
#include <hex/io/mesh_data.h>
#include <hex/io/output_file.h>

namespace hex::io {

MeshData read_ls_dyna(const InputFile& file);
PartNames ls_dyna_names(std::span<const int> parts, const PartNames& names);
void write_ls_dyna_surface(OutputFile& out, const PolygonSoup& soup, const PartNames& names);
void write_ls_dyna_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);

MeshData read_legacy_vtk(const InputFile& file);
void write_legacy_vtk_surface(OutputFile& out, const PolygonSoup& soup);
void write_legacy_vtk_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);

MeshData read_vtu(const InputFile& file);
void write_vtu_surface(OutputFile& out, const PolygonSoup& soup);
void write_vtu_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);

MeshData read_medit(const InputFile& file);
void write_medit_surface(OutputFile& out, const PolygonSoup& soup);
void write_medit_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);

MeshData read_stl(const InputFile& file);
void write_stl(OutputFile& out, const PolygonSoup& soup);

MeshData read_obj(const InputFile& file);
void write_obj(OutputFile& out, const PolygonSoup& soup);

MeshData read_off(const InputFile& file);
void write_off(OutputFile& out, const PolygonSoup& soup);

MeshData read_ply(const InputFile& file);
void write_ply(OutputFile& out, const PolygonSoup& soup);

MeshData read_abaqus(const InputFile& file);
PartNames abaqus_names(std::span<const int> parts, const PartNames& names);
void write_abaqus_surface(OutputFile& out, const PolygonSoup& soup, const PartNames& names);
void write_abaqus_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);

MeshData read_gmsh(const InputFile& file);
PartNames gmsh_names(std::span<const int> parts, const PartNames& names);
void write_gmsh_surface(OutputFile& out, const PolygonSoup& soup, const PartNames& names);
void write_gmsh_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);
void write_gmsh_2_surface(OutputFile& out, const PolygonSoup& soup, const PartNames& names);
void write_gmsh_2_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);

MeshData read_mfem(const InputFile& file);
void write_mfem_surface(OutputFile& out, const PolygonSoup& soup);
void write_mfem_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);

MeshData read_open_volume_mesh(const InputFile& file);
void write_open_volume_mesh_surface(OutputFile& out, const PolygonSoup& soup);
void write_open_volume_mesh_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields);

/// True when some part id is not 1, so that a file without part ids would lose something.
bool has_parts(std::span<const int> parts);

/// Throws Error{unsupported} when a polygon has more than `most` corners; `format` names the format.
void require_polygon_size(const PolygonSoup& soup, std::size_t most, const char* format);

/// "x y z" with the separator between.
void append_point(std::string& text, const Vec3& point, char separator = ' ');

/// One line "x y z" a point.
void append_points(OutputFile& out, std::span<const Vec3> points);

/// "3 a b c": the number of corners, then the corners.
void append_polygon(std::string& text, std::span<const std::uint32_t> polygon);

}  // namespace hex::io
