/// \file list_file.h
/// The small text files of the paper: labels, manual overrides, sharp vertices, elements to refine, polycube
/// lists.
#pragma once

#include <hex/base/linear_algebra.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

namespace hex::io {

/// One integer a line. Throws Error{bad_input} with `file:line`.
std::vector<int> read_labels(const std::filesystem::path& path);
/// One integer a line, in the order given. Throws Error{output}.
void write_labels(const std::filesystem::path& path, std::span<const int> labels);

/// A label set by hand, as a file of overrides has it.
struct LabelOverride {
    std::int64_t triangle;  ///< 0-based, not negative
    int label;              ///< 0-based, not negative: 0..5 = +X -X +Y -Y +Z -Z
    int line;               ///< 1-based line of the file, for messages
};
/// Manual overrides: lines `element label`, in the order of the file; `base` (0 or 1) is subtracted from
/// both. Whether there are such an element and such a label is the caller's to check. Throws Error{bad_input}
/// with `file:line` for other lines, and for numbers below `base`.
std::vector<LabelOverride> read_overrides(const std::filesystem::path& path, int base = 0);

/// sharp.txt: the last integer on each line is a 0-based vertex index (pasted from ParaView's spreadsheet).
std::vector<std::int64_t> read_sharp_vertices(const std::filesystem::path& path);

/// Lines `a b`: an edge between two 0-based vertices.
std::vector<std::array<std::int64_t, 2>> read_edge_list(const std::filesystem::path& path);

/// lev_rfid.txt: lines `level element`, both 0-based; result[level] lists the elements in file order.
std::vector<std::vector<std::int64_t>> read_refinement(const std::filesystem::path& path);

/// The first of the paper's three text files of a polycube (REFERENCE 1.4): a line `v x y z ` a corner, v its
/// vertex in the triangle mesh, 0-based. Throws Error{usage} unless there is one point a vertex,
/// Error{output} when the file cannot be written.
void write_corner_list(const std::filesystem::path& path, std::span<const int> vertices,
                       std::span<const Vec3> points);
/// The second one: a line `a,b` an edge, between vertices as in write_corner_list. Throws Error{output}.
void write_edge_list(const std::filesystem::path& path, std::span<const std::array<int, 2>> edges);
/// The third one: a line `a,b,c,d,` a face, its four corners in their order. Throws Error{output}.
void write_face_list(const std::filesystem::path& path, std::span<const std::array<int, 4>> faces);

/// Edges between points as an .obj file: the points they use as `v x y z`, each edge as `l a b`.
void write_feature_lines(const std::filesystem::path& path, std::span<const Vec3> points,
                         std::span<const std::array<std::uint32_t, 2>> edges);

}  // namespace hex::io
