#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/map/block_numbering.h>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace hex {
namespace {

/// Local edge of a block between the two ends of its axis 0, 1, 2, starting at corner 0.
constexpr std::array<int, 3> axis_edge = {0, 3, 4};

using Lattice = std::array<int, 3>;

Lattice corner_lattice(int corner, const Lattice& segments) {
    const auto& uvw = hexahedron::corner_uvw[static_cast<std::size_t>(corner)];
    return {uvw[0] * segments[0], uvw[1] * segments[1], uvw[2] * segments[2]};
}

/// Unit step on the lattice from one corner towards a neighbouring one.
Lattice step_between(int from, int to) {
    const auto& a = hexahedron::corner_uvw[static_cast<std::size_t>(from)];
    const auto& b = hexahedron::corner_uvw[static_cast<std::size_t>(to)];
    return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

int local_corner(const HexCell& cell, VertexId v) {
    int corner = 0;
    while (cell[static_cast<std::size_t>(corner)] != v) ++corner;
    return corner;
}

}  // namespace

BlockNumbering::BlockNumbering(const HexMesh& blocks, const EdgeTable& edges, std::vector<int> segments)
    : blocks_(&blocks), edges_(&edges), segments_(std::move(segments)) {
    for (const CellId b : blocks.cells()) {
        for (std::size_t e = 0; e < 12; ++e) {
            const auto& uv = hexahedron::edge_corners[e];
            const Lattice step = step_between(uv[0], uv[1]);
            const std::size_t axis = step[0] != 0 ? 0 : step[1] != 0 ? 1 : 2;
            const EdgeId along = edges.cell_edges[b.index()][static_cast<std::size_t>(axis_edge[axis])];
            const EdgeId here = edges.cell_edges[b.index()][e];
            if (segments_[here.index()] != segments_[along.index()] || segments_[here.index()] < 1)
                throw Error(ErrorKind::bad_input,
                            fmt::format("parallel edges of block {} are cut into unequal numbers of pieces",
                                        b.index()));
        }
    }

    // Faces: a half-face stands for its face when it is the smaller of the two.
    face_of_half_face_.resize(blocks.half_face_count());
    for (const HalfFaceId h : blocks.half_faces()) {
        const HalfFaceId twin = blocks.twin(h);
        if (twin.valid() && twin < h) {
            face_of_half_face_[h.index()] = face_of_half_face_[twin.index()];
            continue;
        }
        const std::array<VertexId, 4> v = blocks.face_vertices(h);
        face_of_half_face_[h.index()] = faces_.size();
        faces_.push_back(
            {h, segments_[edges.find(v[0], v[1]).index()], segments_[edges.find(v[0], v[3]).index()]});
    }

    corner_nodes_.resize(blocks.vertex_count());
    std::vector<char> used(blocks.vertex_count(), 0);
    for (const HexCell& cell : blocks.cell_array())
        for (const VertexId v : cell) used[v.index()] = 1;
    for (const VertexId v : blocks.vertices())
        if (used[v.index()] != 0) corner_nodes_[v.index()] = VertexId(node_count_++);

    for (const int n : segments_) {
        first_edge_node_.push_back(node_count_);
        node_count_ += static_cast<std::size_t>(n - 1);
    }
    for (const Face& face : faces_) {
        first_face_node_.push_back(node_count_);
        node_count_ +=
            static_cast<std::size_t>(face.segments_s - 1) * static_cast<std::size_t>(face.segments_t - 1);
    }
    first_cell_.push_back(0);
    for (const CellId b : blocks.cells()) {
        first_block_node_.push_back(node_count_);
        std::size_t inside = 1;
        std::size_t cell_total = 1;
        for (const int n : this->segments(b)) {
            inside *= static_cast<std::size_t>(n - 1);
            cell_total *= static_cast<std::size_t>(n);
        }
        node_count_ += inside;
        first_cell_.push_back(first_cell_.back() + cell_total);
    }
    // A half-face id is 6 * cell + face, so cells run out of ids before nodes do in most meshes, not in all.
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() - 1;
    if (6 * first_cell_.back() > most || node_count_ > most)
        throw Error(
            ErrorKind::unsupported,
            fmt::format("the mesh would have {} hexahedra, more than {}", first_cell_.back(), most / 6), {},
            "choose a lower level or longer edges");
}

std::array<int, 3> BlockNumbering::segments(CellId block) const {
    const auto& edges = edges_->cell_edges[block.index()];
    std::array<int, 3> n{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        n[axis] = segments_[edges[static_cast<std::size_t>(axis_edge[axis])].index()];
    return n;
}

std::vector<VertexId> BlockNumbering::edge_nodes(EdgeId e) const {
    const int n = segments(e);
    std::vector<VertexId> nodes;
    nodes.reserve(static_cast<std::size_t>(n) + 1);
    nodes.push_back(corner_node(edges_->vertices[e.index()][0]));
    for (int i = 1; i < n; ++i)
        nodes.emplace_back(first_edge_node_[e.index()] + static_cast<std::size_t>(i - 1));
    nodes.push_back(corner_node(edges_->vertices[e.index()][1]));
    return nodes;
}

std::vector<VertexId> BlockNumbering::face_nodes(std::size_t f) const {
    const int m = faces_[f].segments_s;
    const int n = faces_[f].segments_t;
    const std::array<VertexId, 4> v = blocks_->face_vertices(faces_[f].half_face);
    std::vector<VertexId> nodes(static_cast<std::size_t>(m + 1) * static_cast<std::size_t>(n + 1));
    const auto at = [&](int s, int t) -> VertexId& {
        return nodes[static_cast<std::size_t>(s) +
                     static_cast<std::size_t>(m + 1) * static_cast<std::size_t>(t)];
    };
    // Each border edge is written along the face, whatever its own direction is.
    const auto write_edge = [&](VertexId from, VertexId to, int s, int t, int ds, int dt) {
        std::vector<VertexId> along = edge_nodes(edges_->find(from, to));
        if (from > to) std::reverse(along.begin(), along.end());
        for (std::size_t i = 0; i < along.size(); ++i) {
            const int k = static_cast<int>(i);
            at(s + k * ds, t + k * dt) = along[i];
        }
    };
    write_edge(v[0], v[1], 0, 0, 1, 0);
    write_edge(v[3], v[2], 0, n, 1, 0);
    write_edge(v[0], v[3], 0, 0, 0, 1);
    write_edge(v[1], v[2], m, 0, 0, 1);
    std::size_t next = first_face_node_[f];
    for (int t = 1; t < n; ++t)
        for (int s = 1; s < m; ++s) at(s, t) = VertexId(next++);
    return nodes;
}

std::vector<VertexId> BlockNumbering::block_nodes(CellId block) const {
    const Lattice n = segments(block);
    const HexCell& cell = blocks_->cell(block);
    std::vector<VertexId> nodes(static_cast<std::size_t>(n[0] + 1) * static_cast<std::size_t>(n[1] + 1) *
                                static_cast<std::size_t>(n[2] + 1));
    const auto at = [&](int i, int j, int k) -> VertexId& {
        return nodes[static_cast<std::size_t>(i) +
                     static_cast<std::size_t>(n[0] + 1) *
                         (static_cast<std::size_t>(j) +
                          static_cast<std::size_t>(n[1] + 1) * static_cast<std::size_t>(k))];
    };
    // The six faces bring the edges and corners with them; a face of the neighbour's is turned by finding the
    // corners of its frame in this block.
    for (int local = 0; local < hexahedron::face_count; ++local) {
        const std::size_t f = face_of_half_face_[HexMesh::half_face(block, local).index()];
        const Face& face = faces_[f];
        const std::array<VertexId, 4> v = blocks_->face_vertices(face.half_face);
        const int origin = local_corner(cell, v[0]);
        const Lattice start = corner_lattice(origin, n);
        const Lattice ds = step_between(origin, local_corner(cell, v[1]));
        const Lattice dt = step_between(origin, local_corner(cell, v[3]));
        const std::vector<VertexId> on_face = face_nodes(f);
        std::size_t next = 0;
        for (int t = 0; t <= face.segments_t; ++t)
            for (int s = 0; s <= face.segments_s; ++s)
                at(start[0] + s * ds[0] + t * dt[0], start[1] + s * ds[1] + t * dt[1],
                   start[2] + s * ds[2] + t * dt[2]) = on_face[next++];
    }
    std::size_t next = first_block_node_[block.index()];
    for (int k = 1; k < n[2]; ++k)
        for (int j = 1; j < n[1]; ++j)
            for (int i = 1; i < n[0]; ++i) at(i, j, k) = VertexId(next++);
    return nodes;
}

std::vector<HexCell> BlockNumbering::cells() const {
    std::vector<HexCell> all(cell_count());
    parallel_for(
        blocks_->cell_count(),
        [&](std::size_t b) {
            const std::vector<VertexId> nodes = block_nodes(CellId(b));
            const Lattice n = segments(CellId(b));
            std::size_t next = first_cell_[b];
            for (int k = 0; k < n[2]; ++k)
                for (int j = 0; j < n[1]; ++j)
                    for (int i = 0; i < n[0]; ++i, ++next)
                        for (std::size_t c = 0; c < 8; ++c) {
                            const auto& uvw = hexahedron::corner_uvw[c];
                            const auto x = static_cast<std::size_t>(i + uvw[0]);
                            const auto y = static_cast<std::size_t>(j + uvw[1]);
                            const auto z = static_cast<std::size_t>(k + uvw[2]);
                            all[next][c] = nodes[x + static_cast<std::size_t>(n[0] + 1) *
                                                         (y + static_cast<std::size_t>(n[1] + 1) * z)];
                        }
        },
        1);
    return all;
}

}  // namespace hex
