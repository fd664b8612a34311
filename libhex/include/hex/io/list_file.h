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
void write_labels(const std::filesystem::path& path, std::span<const int> labels);

/// Manual overrides: lines `element label`; `base` (0 or 1) is subtracted from both. Range checks are the
/// caller's.
struct LabelOverride {
    std::int64_t triangle;
    int label;
    int line;  ///< 1-based line of the file, for messages
};
std::vector<LabelOverride> read_overrides(const std::filesystem::path& path, int base = 0);

/// sharp.txt: the last integer on each line is a 0-based vertex index (pasted from ParaView's spreadsheet).
std::vector<std::int64_t> read_sharp_vertices(const std::filesystem::path& path);

/// Lines `a b`: an edge between two 0-based vertices.
std::vector<std::array<std::int64_t, 2>> read_edge_list(const std::filesystem::path& path);

/// lev_rfid.txt: lines `level element`, both 0-based; result[level] lists the elements in file order.
std::vector<std::vector<std::int64_t>> read_refinement(const std::filesystem::path& path);

/// The paper's three text files of a polycube (REFERENCE 1.4): `v x y z ` a corner, `a,b` an edge, `a,b,c,d,`
/// a face.
void write_corner_list(const std::filesystem::path& path, std::span<const int> vertices,
                       std::span<const Vec3> points);
void write_edge_list(const std::filesystem::path& path, std::span<const std::array<int, 2>> edges);
void write_face_list(const std::filesystem::path& path, std::span<const std::array<int, 4>> faces);

/// Edges between points as an .obj file: the points they use as `v x y z`, each edge as `l a b`.
void write_feature_lines(const std::filesystem::path& path, std::span<const Vec3> points,
                         std::span<const std::array<std::uint32_t, 2>> edges);

}  // namespace hex::io
