#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/volume/hex_mesh.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

namespace hex {
namespace {

/// A half-face in the bucket of its smallest vertex: the other three vertices in winding order after it.
struct FaceRecord {
    std::array<std::uint32_t, 3> rest;
    std::uint32_t half_face;

    /// The two face-neighbours of the smallest vertex, ascending, then the opposite one: equal for all
    /// half-faces of a face.
    std::array<std::uint32_t, 3> key() const {
        return {std::min(rest[0], rest[2]), std::max(rest[0], rest[2]), rest[1]};
    }
};

std::string cells_text(std::initializer_list<std::uint32_t> half_faces) {
    std::vector<std::int64_t> cells;
    for (const std::uint32_t h : half_faces) cells.push_back(h / 6);
    std::sort(cells.begin(), cells.end());
    return "cells " + list_ids(cells);
}

/// True when some item of [0, count) is a problem. Which one is the first is then asked once more, in order:
/// problems are rare.
template <class IsProblem>
bool any_problem(std::size_t count, const IsProblem& is_problem) {
    std::atomic<bool> found = false;
    parallel_for(
        count,
        [&](std::size_t i) {
            if (is_problem(i)) found.store(true, std::memory_order_relaxed);
        },
        4096);
    return found;
}

bool is_good_cell(const HexCell& cell, std::size_t vertex_count) {
    bool good = true;
    for (std::size_t i = 0; i < 8; ++i) {
        good = good && cell[i].index() < vertex_count;
        for (std::size_t j = 0; j < i; ++j) good = good && cell[i] != cell[j];
    }
    return good;
}

[[noreturn]] void throw_problem(const HexCell& cell, std::size_t c, std::size_t vertex_count) {
    for (std::size_t i = 0; i < 8; ++i) {
        const std::string use =
            "cell " + std::to_string(c) + " uses vertex " + std::to_string(cell[i].value());
        if (cell[i].index() >= vertex_count)
            throw Error(ErrorKind::bad_input, use + " of " + std::to_string(vertex_count));
        if (std::find(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(i), cell[i]) !=
            cell.begin() + static_cast<std::ptrdiff_t>(i))
            throw Error(ErrorKind::bad_input, use + " twice");
    }
    std::abort();
}

void check_cells(const std::vector<HexCell>& cells, std::size_t vertex_count) {
    if (cells.size() > std::size_t{Id<int>::none_value} / 6)
        throw Error(ErrorKind::unsupported, "more hexahedra than 32-bit half-face ids can number");
    if (!any_problem(cells.size(), [&](std::size_t c) { return !is_good_cell(cells[c], vertex_count); }))
        return;
    for (std::size_t c = 0; c < cells.size(); ++c)
        if (!is_good_cell(cells[c], vertex_count)) throw_problem(cells[c], c, vertex_count);
}

/// The records of one face at the front of a sorted bucket.
std::span<const FaceRecord> first_face(std::span<const FaceRecord> sorted) {
    std::size_t count = 1;
    while (count < sorted.size() && sorted[count].key() == sorted[0].key()) ++count;
    return sorted.first(count);
}

void sort_faces(std::span<FaceRecord> faces) {
    std::sort(faces.begin(), faces.end(), [](const FaceRecord& a, const FaceRecord& b) {
        const auto ka = a.key(), kb = b.key();
        return ka != kb ? ka < kb : a.half_face < b.half_face;
    });
}

void pair(const FaceRecord& a, const FaceRecord& b, std::vector<HalfFaceId>& twins) {
    twins[a.half_face] = HalfFaceId(b.half_face);
    twins[b.half_face] = HalfFaceId(a.half_face);
}

/// At most two half-faces, and two of opposite orientation.
bool is_manifold(std::span<const FaceRecord> face) {
    return face.size() == 1 || (face.size() == 2 && face[0].rest[0] != face[1].rest[0]);
}

/// Pairs the half-faces of one bucket, each with the only other one of its face; false when a face is not
/// manifold. A bucket holds few faces, so every pair of them is looked at; large ones are sorted.
bool match_bucket(std::span<FaceRecord> bucket, std::vector<HalfFaceId>& twins) {
    constexpr std::size_t few = 64;
    if (bucket.size() > few) {
        sort_faces(bucket);
        for (std::span<const FaceRecord> rest = bucket; !rest.empty();) {
            const auto face = first_face(rest);
            if (!is_manifold(face)) return false;
            if (face.size() == 2) pair(face[0], face[1], twins);
            rest = rest.subspan(face.size());
        }
        return true;
    }
    std::uint64_t paired = 0;
    for (std::size_t i = 0; i < bucket.size(); ++i) {
        const FaceRecord& a = bucket[i];
        for (std::size_t j = i + 1; j < bucket.size(); ++j) {
            const FaceRecord& b = bucket[j];
            if (a.rest[1] != b.rest[1]) continue;
            const bool opposed = a.rest[0] == b.rest[2] && a.rest[2] == b.rest[0];
            const bool alike = a.rest[0] == b.rest[0] && a.rest[2] == b.rest[2];
            if (!opposed && !alike) continue;
            const std::uint64_t both = std::uint64_t{1} << i | std::uint64_t{1} << j;
            if (alike || (paired & both) != 0) return false;
            paired |= both;
            pair(a, b, twins);
        }
    }
    return true;
}

/// Throws for the first face of a bucket that is not manifold.
void throw_problem(std::span<FaceRecord> bucket) {
    sort_faces(bucket);
    std::span<const FaceRecord> sorted = bucket;
    auto face = first_face(sorted);
    while (is_manifold(face)) {
        sorted = sorted.subspan(face.size());
        face = first_face(sorted);
    }
    if (face.size() > 2)
        throw Error(ErrorKind::bad_input,
                    "a face is shared by more than two hexahedra: " +
                        cells_text({face[0].half_face, face[1].half_face, face[2].half_face}));
    throw Error(ErrorKind::bad_input,
                "two hexahedra lie on the same side of their shared face: " +
                    cells_text({face[0].half_face, face[1].half_face}),
                {}, "one of them is repeated or inside out");
}

std::vector<HalfFaceId> find_twins(const std::vector<HexCell>& cells, std::size_t vertex_count) {
    const std::size_t count = 6 * cells.size();
    const auto corner_of = [&](std::size_t h, std::size_t i) {
        return cells[h / 6][static_cast<std::size_t>(hexahedron::face_corners[h % 6][i])].value();
    };
    const auto smallest = [&](std::size_t h) {
        std::size_t first = 0;
        for (std::size_t i = 1; i < 4; ++i) {
            if (corner_of(h, i) < corner_of(h, first)) first = i;
        }
        return first;
    };

    // Bucket half-faces by their smallest vertex; a bucket is small, so matching inside it is a short search.
    // The order within a bucket depends on the threads, what is made of it does not.
    std::vector<std::uint32_t> offsets(vertex_count + 1, 0);
    const auto take = [](std::uint32_t& counter) {
        return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
    };
    parallel_for(
        count, [&](std::size_t h) { take(offsets[corner_of(h, smallest(h)) + 1]); }, 6144);
    for (std::size_t v = 0; v < vertex_count; ++v) offsets[v + 1] += offsets[v];
    std::vector<FaceRecord> records(count);
    {
        std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
        parallel_for(
            count,
            [&](std::size_t h) {
                const std::size_t first = smallest(h);
                FaceRecord record{{}, static_cast<std::uint32_t>(h)};
                for (std::size_t i = 0; i < 3; ++i) record.rest[i] = corner_of(h, (first + 1 + i) % 4);
                records[take(next[corner_of(h, first)])] = record;
            },
            6144);
    }

    std::vector<HalfFaceId> twins(count);
    std::atomic<std::size_t> first_problem = vertex_count;
    parallel_for(vertex_count, [&](std::size_t v) {
        const std::span bucket(records.data() + offsets[v], records.data() + offsets[v + 1]);
        if (match_bucket(bucket, twins)) return;
        std::size_t smallest_so_far = first_problem;
        while (v < smallest_so_far && !first_problem.compare_exchange_weak(smallest_so_far, v)) {
        }
    });
    // Reported here and not where it is found, so that the message does not depend on the threads.
    if (const std::size_t v = first_problem; v < vertex_count)
        throw_problem({records.data() + offsets[v], records.data() + offsets[v + 1]});
    return twins;
}

/// The cell after `c`, if there is one, that is glued to it on two opposite sides and has the same eight
/// vertices.
std::optional<std::size_t> repetition_of(std::size_t c, const std::vector<HexCell>& cells,
                                         const std::vector<HalfFaceId>& twins) {
    for (std::size_t f = 0; f < 6; ++f) {
        const HalfFaceId t = twins[6 * c + f];
        if (!t.valid() || t.index() / 6 <= c) continue;
        const HalfFaceId opposite = twins[6 * c + static_cast<std::size_t>(hexahedron::opposite_face[f])];
        if (!opposite.valid() || opposite.index() / 6 != t.index() / 6) continue;
        HexCell a = cells[c], b = cells[t.index() / 6];
        std::sort(a.begin(), a.end());
        std::sort(b.begin(), b.end());
        if (a == b) return t.index() / 6;
    }
    return std::nullopt;
}

/// Two cells on the same eight vertices, also when glued to each other consistently.
void check_repeated_cells(const std::vector<HexCell>& cells, const std::vector<HalfFaceId>& twins) {
    if (!any_problem(cells.size(), [&](std::size_t c) { return repetition_of(c, cells, twins).has_value(); }))
        return;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (const auto other = repetition_of(c, cells, twins))
            throw Error(ErrorKind::bad_input, "two hexahedra have the same eight vertices: cells " +
                                                  std::to_string(c) + ", " + std::to_string(*other));
    }
}

}  // namespace

HexMesh::HexMesh(std::vector<Vec3> positions, std::vector<HexCell> cells, std::vector<int> parts)
    : positions_(std::move(positions)), cells_(std::move(cells)), parts_(std::move(parts)) {
    if (!parts_.empty() && parts_.size() != cells_.size())
        throw Error(ErrorKind::bad_input, std::to_string(parts_.size()) + " part ids for " +
                                              std::to_string(cells_.size()) + " cells");
    for (std::size_t v = 0; v < positions_.size(); ++v) {
        if (!positions_[v].allFinite())
            throw Error(ErrorKind::bad_input,
                        "vertex " + std::to_string(v) + " has a coordinate that is not finite");
    }
    check_cells(cells_, positions_.size());
    twins_ = find_twins(cells_, positions_.size());
    check_repeated_cells(cells_, twins_);
}

void HexMesh::set_positions(std::vector<Vec3> positions) {
    if (positions.size() != positions_.size())
        throw Error(ErrorKind::usage, "set_positions: " + std::to_string(positions.size()) +
                                          " positions for " + std::to_string(positions_.size()) +
                                          " vertices");
    positions_ = std::move(positions);
}

std::array<Vec3, 8> HexMesh::corner_positions(CellId c) const {
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) corners[i] = position(cells_[c.index()][i]);
    return corners;
}

std::array<VertexId, 4> HexMesh::face_vertices(HalfFaceId h) const {
    const auto& local = hexahedron::face_corners[static_cast<std::size_t>(local_face(h))];
    const HexCell& cell = cells_[h.index() / 6];
    return {cell[static_cast<std::size_t>(local[0])], cell[static_cast<std::size_t>(local[1])],
            cell[static_cast<std::size_t>(local[2])], cell[static_cast<std::size_t>(local[3])]};
}

BoundingBox bounding_box(const HexMesh& mesh) {
    BoundingBox box;
    for (const HexCell& cell : mesh.cell_array()) {
        for (const VertexId v : cell) box.add(mesh.position(v));
    }
    return box;
}

}  // namespace hex
