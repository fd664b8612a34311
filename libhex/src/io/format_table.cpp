// The one table of formats, and the public readers and writers that look into it.
#include "io/added_reader.h"
#include "io/formats.h"

#include <hex/base/error.h>
#include <hex/io/cad_file.h>
#include <hex/io/mesh_file.h>
#include <hex/io/number_text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace hex::io {
namespace {

struct Format {
    FormatInfo info;
    MeshData (*read)(const InputFile&);  ///< none: by read_cad
    void (*write_surface)(OutputFile&, const PolygonSoup&, const PartNames&);
    void (*write_hexahedra)(OutputFile&, const HexMesh&, const Fields&);
};

/// A writer of surfaces for a format without names of parts.
template <void (*Write)(OutputFile&, const PolygonSoup&)>
void without_names(OutputFile& out, const PolygonSoup& soup, const PartNames&) {
    Write(out, soup);
}

const std::vector<Format>& table() {
    static const std::vector<Format> formats = [] {
        // name, extensions, reads/writes surfaces, reads/writes hexahedra, part ids, names, corners, fields,
        // numbers
        std::vector<Format> list = {
            {{"LS-DYNA keyword",
              {".k", ".key"},
              true,
              true,
              true,
              true,
              true,
              true,
              4,
              false,
              "text, exact",
              ls_dyna_names},
             read_ls_dyna,
             write_ls_dyna_surface,
             write_ls_dyna_hexahedra},
            {{"VTK legacy", {".vtk"}, true, true, true, true, true, false, 0, true, "text, exact"},
             read_legacy_vtk,
             without_names<write_legacy_vtk_surface>,
             write_legacy_vtk_hexahedra},
            {{"VTK XML", {".vtu"}, true, true, true, true, true, false, 0, true, "binary, exact"},
             read_vtu,
             without_names<write_vtu_surface>,
             write_vtu_hexahedra},
            {{"Medit", {".mesh"}, true, true, true, true, true, false, 4, false, "text, exact"},
             read_medit,
             without_names<write_medit_surface>,
             write_medit_hexahedra},
            {{"MFEM", {".mfem"}, true, true, true, true, true, false, 4, false, "text, exact"},
             read_mfem,
             without_names<write_mfem_surface>,
             write_mfem_hexahedra},
            {{"Abaqus", {".inp"}, true, true, true, true, true, true, 4, false, "text, exact", abaqus_names},
             read_abaqus,
             write_abaqus_surface,
             write_abaqus_hexahedra},
            {{"Gmsh", {".msh"}, true, true, true, true, true, true, 4, false, "text, exact", gmsh_names},
             read_gmsh,
             write_gmsh_surface,
             write_gmsh_hexahedra},
            {{"Gmsh 2.2", {".msh2"}, true, true, true, true, true, true, 4, false, "text, exact", gmsh_names},
             read_gmsh,
             write_gmsh_2_surface,
             write_gmsh_2_hexahedra},
            {{"OpenVolumeMesh", {".ovm"}, true, true, true, true, true, false, 0, false, "text, exact"},
             read_open_volume_mesh,
             without_names<write_open_volume_mesh_surface>,
             write_open_volume_mesh_hexahedra},
            {{"STL", {".stl"}, true, true, false, false, false, false, 3, false, "text, exact"},
             read_stl,
             without_names<write_stl>,
             nullptr},
            {{"Wavefront OBJ", {".obj"}, true, true, false, false, true, false, 0, false, "text, exact"},
             read_obj,
             without_names<write_obj>,
             nullptr},
            {{"OFF", {".off"}, true, true, false, false, false, false, 0, false, "text, exact"},
             read_off,
             without_names<write_off>,
             nullptr},
            {{"PLY", {".ply"}, true, true, false, false, true, false, 0, false, "text, exact"},
             read_ply,
             without_names<write_ply>,
             nullptr},
            {{"STEP", {".step", ".stp"}, true, false, false, false, true, false, 0, false, "-"},
             nullptr,
             nullptr,
             nullptr},
            {{"IGES", {".iges", ".igs"}, true, false, false, false, true, false, 0, false, "-"},
             nullptr,
             nullptr,
             nullptr},
            {{"Open CASCADE BREP", {".brep"}, true, false, false, false, true, false, 0, false, "-"},
             nullptr,
             nullptr,
             nullptr},
        };
        return list;
    }();
    return formats;
}

const Format* lookup(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    for (const Format& format : table()) {
        const auto& known = format.info.extensions;
        if (std::find(known.begin(), known.end(), extension) != known.end()) return &format;
    }
    return nullptr;
}

const Format& format_of(const std::filesystem::path& path, bool FormatInfo::*wanted, const char* purpose) {
    const Format* format = lookup(path);
    if (format != nullptr && format->info.*wanted) return *format;
    const std::string extension = path.extension().string();
    const std::string what = format != nullptr
                                 ? "the format " + std::string(format->info.name) + " cannot carry " + purpose
                             : extension.empty() ? "a file name without extension does not tell its format"
                                                 : "unknown file extension " + in_quotes(extension);
    throw Error(ErrorKind::unsupported, what, path.string(),
                std::string("for ") + purpose + " use one of " + extensions_of(wanted));
}

/// A file that is missing or a folder is said to be so, even when its extension is unknown as well.
MeshData read_with(const Format& (*choose)(const std::filesystem::path&), const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) InputFile{path};
    if (has_added_reader(path)) return read_with_added_reader(path);
    const Format& format = choose(path);
    return format.read(InputFile(path));
}

/// The first findings of each kind (their code), and how many more there were.
Diagnostics shortened(Diagnostics&& diagnostics) {
    constexpr std::size_t most = 20;
    std::map<std::string, std::size_t> counts;
    Diagnostics kept;
    for (Diagnostic& finding : diagnostics)
        if (++counts[finding.code] <= most) kept.push_back(std::move(finding));
    for (const auto& [code, count] : counts)
        if (count > most)
            kept.push_back({Severity::warning,
                            code,
                            std::to_string(count - most) + " more findings of this kind (" + code + ")",
                            {},
                            {}});
    return kept;
}

/// Messages of a reader stand for themselves: with the file, and the first line they are about.
Diagnostics located(Diagnostics&& all, const std::filesystem::path& path) {
    Diagnostics diagnostics = shortened(std::move(all));
    for (Diagnostic& finding : diagnostics) {
        std::string message = path.string();
        if (finding.entity == "line" && !finding.ids.empty())
            message.append(":").append(std::to_string(finding.ids.front()));
        finding.message = message.append(": ").append(finding.message);
    }
    return diagnostics;
}

std::string plural(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// The stages refuse such polygons; what only reads or converts a surface should say it, too.
void warn_of_repeated_corners(MeshData& data) {
    std::vector<std::int64_t> repeating;
    std::vector<std::uint32_t> sorted;
    for (std::size_t f = 0; f < data.surface.size(); ++f) {
        const auto polygon = data.surface.polygon(f);
        sorted.assign(polygon.begin(), polygon.end());
        std::sort(sorted.begin(), sorted.end());
        if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
            repeating.push_back(static_cast<std::int64_t>(f));
    }
    if (!repeating.empty())
        data.warn("repeated-corners",
                  plural(repeating.size(), "polygon names", "polygons name") +
                      " a point twice: " + list_ids(repeating) + " (counted from 0); --repair removes such",
                  "polygon", repeating);
}

/// Why there may be nothing in a file that has something.
std::string what_was_skipped(const MeshData& data) {
    constexpr std::size_t most = 3;
    std::string text;
    for (std::size_t i = 0; i < std::min(most, data.diagnostics.size()); ++i)
        text.append(i == 0 ? ": " : "; ").append(data.diagnostics[i].message);
    if (data.diagnostics.size() > most) text += "; ...";
    return text;
}

SurfaceFile to_surface(MeshData&& data, const std::filesystem::path& path) {
    if (data.surface.size() == 0) {
        if (!data.hexahedra.empty())
            throw Error(
                ErrorKind::bad_input,
                "holds " + plural(data.hexahedra.size(), "hexahedron", "hexahedra") + ", not a surface",
                path.string(), "a surface of triangles or polygons is needed here");
        throw Error(ErrorKind::bad_input, "holds no polygons" + what_was_skipped(data), path.string());
    }
    if (!data.hexahedra.empty())
        data.warn("hexahedra-skipped", plural(data.hexahedra.size(), "hexahedron", "hexahedra") + " skipped");
    warn_of_repeated_corners(data);
    return {std::move(data.surface), std::move(data.part_names), located(std::move(data.diagnostics), path)};
}

HexFile to_hexahedra(MeshData&& data, const std::filesystem::path& path) {
    if (data.hexahedra.empty()) {
        if (data.surface.size() > 0)
            throw Error(ErrorKind::bad_input,
                        "holds " + plural(data.surface.size(), "polygon", "polygons") + " and no hexahedra",
                        path.string(), "a mesh or block structure of hexahedra is needed here");
        throw Error(ErrorKind::bad_input, "holds no hexahedra" + what_was_skipped(data), path.string());
    }
    // Boundary quadrilaterals beside the hexahedra are the rule in Medit files: worth a note, not a warning.
    if (data.surface.size() > 0)
        data.diagnostics.push_back({Severity::note,
                                    "polygons-skipped",
                                    plural(data.surface.size(), "polygon", "polygons") + " skipped",
                                    {},
                                    {}});
    HexFile result;
    result.part_names = std::move(data.part_names);
    try {
        result.mesh =
            HexMesh(std::move(data.points()), std::move(data.hexahedra), std::move(data.hexahedron_parts));
    } catch (const Error& error) {
        throw error.located(path.string());
    }
    result.diagnostics = located(std::move(data.diagnostics), path);
    return result;
}

const Format& surface_reader(const std::filesystem::path& path) {
    return format_of(path, &FormatInfo::reads_surfaces, "surfaces");
}
const Format& hexahedra_reader(const std::filesystem::path& path) {
    return format_of(path, &FormatInfo::reads_hexahedra, "hexahedra");
}

void require_finite(std::span<const Vec3> points, const std::filesystem::path& path) {
    for (std::size_t v = 0; v < points.size(); ++v) {
        if (!points[v].allFinite())
            throw Error(
                ErrorKind::output,
                "vertex " + std::to_string(v) + " has a coordinate that is not finite; nothing written",
                path.string());
    }
}

void check_fields(const std::vector<ScalarField>& fields, std::size_t count, const char* entity) {
    for (const ScalarField& field : fields) {
        if (field.values.size() != count)
            throw Error(ErrorKind::usage, "field '" + field.name + "' has " +
                                              std::to_string(field.values.size()) + " values for " +
                                              std::to_string(count) + " " + entity);
    }
}

}  // namespace

const std::vector<FormatInfo>& formats() {
    static const std::vector<FormatInfo> infos = [] {
        std::vector<FormatInfo> list;
        for (const Format& format : table()) list.push_back(format.info);
        return list;
    }();
    return infos;
}

std::string extension_of(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

const FormatInfo* find_format(const std::filesystem::path& path) {
    const Format* format = lookup(path);
    return format == nullptr ? nullptr : &format->info;
}

std::string extensions_of(bool FormatInfo::*flag) {
    std::string list;
    for (const FormatInfo& info : formats()) {
        if (!(info.*flag)) continue;
        for (const auto extension : info.extensions) {
            if (!list.empty()) list += ' ';
            list += extension;
        }
    }
    if (flag == &FormatInfo::reads_surfaces || flag == &FormatInfo::reads_hexahedra)
        list += added_extensions();
    return list;
}

SurfaceFile read_surface(const std::filesystem::path& path) {
    if (is_cad_file(path)) return read_cad(path);
    return to_surface(read_with(surface_reader, path), path);
}

HexFile read_hex_mesh(const std::filesystem::path& path) {
    return to_hexahedra(read_with(hexahedra_reader, path), path);
}

MeshFile read_mesh_file(const std::filesystem::path& path) {
    if (is_cad_file(path)) return read_cad(path);
    MeshData data = read_with(surface_reader, path);
    if (data.hexahedra.empty()) return to_surface(std::move(data), path);
    return to_hexahedra(std::move(data), path);
}

void write_surface(const std::filesystem::path& path, const PolygonSoup& soup, const PartNames& part_names) {
    const Format& format = format_of(path, &FormatInfo::writes_surfaces, "surfaces");
    require_finite(soup.points, path);
    try {
        if (format.info.most_corners > 0)
            require_polygon_size(soup, static_cast<std::size_t>(format.info.most_corners),
                                 format.info.name.data());
        OutputFile out(path);
        format.write_surface(out, soup, part_names);
        out.commit();
    } catch (const Error& error) {
        throw error.located(path.string());
    }
}

void write_hex_mesh(const std::filesystem::path& path, const HexMesh& mesh, const Fields& fields) {
    const Format& format = format_of(path, &FormatInfo::writes_hexahedra, "hexahedra");
    require_finite(mesh.positions(), path);
    if (!format.info.fields && (!fields.cell.empty() || !fields.vertex.empty()))
        throw Error(ErrorKind::unsupported,
                    "the format " + std::string(format.info.name) + " cannot carry fields", path.string(),
                    "use one of " + extensions_of(&FormatInfo::fields));
    check_fields(fields.cell, mesh.cell_count(), "cells");
    check_fields(fields.vertex, mesh.vertex_count(), "vertices");
    try {
        OutputFile out(path);
        format.write_hexahedra(out, mesh, fields);
        out.commit();
    } catch (const Error& error) {
        throw error.located(path.string());
    }
}

bool has_parts(std::span<const int> parts) {
    return std::any_of(parts.begin(), parts.end(), [](int part) { return part != 1; });
}

void require_polygon_size(const PolygonSoup& soup, std::size_t most, const char* format) {
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const std::size_t corners = soup.offsets[f + 1] - soup.offsets[f];
        if (corners > most)
            throw Error(ErrorKind::unsupported,
                        "polygon " + std::to_string(f) + " has " + std::to_string(corners) +
                            " corners, and " + format + " carries no more than " + std::to_string(most),
                        {}, "write another format, or triangles");
    }
}

void append_point(std::string& text, const Vec3& point, char separator) {
    append_number(text, point.x());
    text += separator;
    append_number(text, point.y());
    text += separator;
    append_number(text, point.z());
}

void append_points(OutputFile& out, std::span<const Vec3> points) {
    for (const Vec3& point : points) {
        append_point(out.buffer(), point);
        out.buffer() += '\n';
        out.flush_if_large();
    }
}

void append_polygon(std::string& text, std::span<const std::uint32_t> polygon) {
    append_number(text, polygon.size());
    for (const std::uint32_t v : polygon) {
        text += ' ';
        append_number(text, v);
    }
}

}  // namespace hex::io
