#include <spline/blending.h>

#include <algorithm>
#include <bit>

namespace spline {

using hex::CellId;
using hex::EdgeId;
using hex::HalfFaceId;
using hex::HexMesh;
using hex::VertexFeature;
using hex::VertexId;
namespace hexahedron = hex::hexahedron;

namespace {

/// Where one of the 64 Bezier points of an element lies.
struct PointPlace {
    enum class Kind : std::uint8_t { body, face, edge, corner } kind;
    std::uint8_t near;    ///< nearest corner
    std::uint8_t entity;  ///< local face or edge
};

constexpr std::array<PointPlace, 64> point_places() {
    std::array<PointPlace, 64> places{};
    for (int k = 0; k < 4; ++k) {
        for (int j = 0; j < 4; ++j) {
            for (int i = 0; i < 4; ++i) {
                const std::array<int, 3> index = {i, j, k};
                const int near = hexahedron::corner_at(i / 2, j / 2, k / 2);
                std::array<bool, 3> extreme{};
                int count = 0;
                for (std::size_t a = 0; a < 3; ++a) {
                    extreme[a] = index[a] == 0 || index[a] == 3;
                    count += extreme[a];
                }
                PointPlace place{PointPlace::Kind::body, static_cast<std::uint8_t>(near), 0};
                if (count == 1) {
                    // The face on which the one extreme coordinate is constant.
                    constexpr std::array<std::array<int, 2>, 3> faces = {{{4, 2}, {1, 3}, {0, 5}}};
                    const std::size_t axis = extreme[0] ? 0 : extreme[1] ? 1 : 2;
                    place.kind = PointPlace::Kind::face;
                    place.entity = static_cast<std::uint8_t>(faces[axis][index[axis] == 3 ? 1 : 0]);
                } else if (count == 2) {
                    // The edge along the one free coordinate.
                    std::array<int, 3> other = {i / 2, j / 2, k / 2};
                    const std::size_t axis = !extreme[0] ? 0 : !extreme[1] ? 1 : 2;
                    other[axis] = 1 - other[axis];
                    place.kind = PointPlace::Kind::edge;
                    place.entity = static_cast<std::uint8_t>(
                        hexahedron::edge_between(near, hexahedron::corner_at(other[0], other[1], other[2])));
                } else if (count == 3) {
                    place.kind = PointPlace::Kind::corner;
                }
                places[static_cast<std::size_t>(i + 4 * j + 16 * k)] = place;
            }
        }
    }
    return places;
}

constexpr std::array<PointPlace, 64> places = point_places();

/// 27 times the weight of corner b in the body point next to corner a.
constexpr std::array<std::array<std::int64_t, 8>, 8> body_weights() {
    std::array<std::array<std::int64_t, 8>, 8> weights{};
    for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t b = 0; b < 8; ++b) {
            weights[a][b] = 1;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (hexahedron::corner_uvw[a][axis] == hexahedron::corner_uvw[b][axis]) weights[a][b] *= 2;
            }
        }
    }
    return weights;
}

constexpr auto body_weight = body_weights();

template <class Corners>
std::size_t local_index(const Corners& corners, VertexId v) {
    return static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
}

}  // namespace

BlendingOperator::BlendingOperator(const LevelMesh& level)
    : level_(level),
      face_points_(8 * level.mesh.cell_count()),
      edge_points_(face_points_ + 4 * level.faces.size()),
      vertex_points_(edge_points_ + 2 * level.edges.size()) {}

std::array<std::uint32_t, 64> BlendingOperator::element_points(CellId cell) const {
    const hex::HexCell& corners = level_.mesh.cell(cell);
    std::array<std::array<VertexId, 4>, 6> face_vertices;
    std::array<std::uint32_t, 6> faces;
    for (std::size_t f = 0; f < 6; ++f) {
        const HalfFaceId h = HexMesh::half_face(cell, static_cast<int>(f));
        faces[f] = level_.faces.of_half_face[h.index()];
        face_vertices[f] = level_.mesh.face_vertices(level_.faces.half_faces[faces[f]]);
    }
    const auto& edges = level_.edges.cell_edges[cell.index()];
    std::array<std::uint32_t, 64> points;
    for (std::size_t p = 0; p < 64; ++p) {
        const PointPlace place = places[p];
        const VertexId near = corners[place.near];
        std::size_t point = 0;
        switch (place.kind) {
            case PointPlace::Kind::body:
                point = 8 * cell.index() + place.near;
                break;
            case PointPlace::Kind::face:
                point = face_points_ + 4 * std::size_t{faces[place.entity]} +
                        local_index(face_vertices[place.entity], near);
                break;
            case PointPlace::Kind::edge: {
                const EdgeId e = edges[place.entity];
                point = edge_points_ + 2 * e.index() + (level_.edges.vertices[e.index()][0] == near ? 0 : 1);
                break;
            }
            case PointPlace::Kind::corner:
                point = vertex_points_ + near.index();
                break;
        }
        points[p] = static_cast<std::uint32_t>(point);
    }
    return points;
}

std::int64_t BlendingOperator::row(std::uint32_t point, RationalRowSum& row) const {
    row.clear();
    if (point < face_points_) {
        const CellId cell(point / 8);
        add_body_point(cell, level_.mesh.corner(cell, static_cast<int>(point % 8)), 1, row);
        return 27;
    }
    if (point < edge_points_) return face_row((point - face_points_) / 4, (point - face_points_) % 4, row);
    if (point < vertex_points_) {
        const EdgeId edge((point - edge_points_) / 2);
        return edge_row(edge, level_.edges.vertices[edge.index()][(point - edge_points_) % 2], row);
    }
    return vertex_row(VertexId(point - vertex_points_), row);
}

void BlendingOperator::add_body_point(CellId cell, VertexId near, std::int64_t factor,
                                      RationalRowSum& row) const {
    const hex::HexCell& corners = level_.mesh.cell(cell);
    const auto& weights = body_weight[local_index(corners, near)];
    for (std::size_t c = 0; c < 8; ++c) row.add(corners[c].value(), factor * weights[c]);
}

void BlendingOperator::add_quad_point(const std::array<VertexId, 4>& quad, VertexId near,
                                      RationalRowSum& row) const {
    constexpr std::array<std::int64_t, 4> weights = {4, 2, 1, 2};
    const std::size_t first = local_index(quad, near);
    for (std::size_t i = 0; i < 4; ++i) row.add(quad[(first + i) % 4].value(), weights[i]);
}

std::int64_t BlendingOperator::face_row(std::size_t face, std::size_t corner, RationalRowSum& row) const {
    const HalfFaceId h = level_.faces.half_faces[face];
    const auto vertices = level_.mesh.face_vertices(h);
    const HalfFaceId twin = level_.mesh.twin(h);
    if (!twin.valid()) {
        add_quad_point(vertices, vertices[corner], row);
        return 9;
    }
    add_body_point(HexMesh::cell_of(h), vertices[corner], 1, row);
    add_body_point(HexMesh::cell_of(twin), vertices[corner], 1, row);
    return 54;
}

std::int64_t BlendingOperator::edge_row(EdgeId edge, VertexId near, RationalRowSum& row) const {
    const VertexId far = level_.edges.other(edge, near);
    if (level_.features.sharp_edge[edge.index()] != 0) {
        row.add(near.value(), 2);
        row.add(far.value(), 1);
        return 3;
    }
    if (level_.edges.boundary[edge.index()] != 0) {
        std::int64_t quads = 0;
        for (const hex::QuadId q : level_.boundary.vertex_quads[near.index()]) {
            const auto& quad = level_.boundary.vertices[q.index()];
            const std::size_t at = local_index(quad, near);
            if (quad[(at + 1) % 4] != far && quad[(at + 3) % 4] != far) continue;
            add_quad_point(quad, near, row);
            ++quads;
        }
        return 9 * quads;
    }
    const auto cells = level_.edges.cells[edge.index()];
    for (const CellId cell : cells) add_body_point(cell, near, 1, row);
    return 27 * static_cast<std::int64_t>(cells.size());
}

std::int64_t BlendingOperator::vertex_row(VertexId v, RationalRowSum& row) const {
    switch (level_.features.vertex[v.index()]) {
        case VertexFeature::corner:
            row.add(v.value(), 1);
            return 1;
        case VertexFeature::crease:
            row.add(v.value(), 4);
            for (const EdgeId e : level_.edges.vertex_edges[v.index()]) {
                if (level_.features.sharp_edge[e.index()] != 0) row.add(level_.edges.other(e, v).value(), 1);
            }
            return 6;
        case VertexFeature::smooth: {
            const auto quads = level_.boundary.vertex_quads[v.index()];
            for (const hex::QuadId q : quads) add_quad_point(level_.boundary.vertices[q.index()], v, row);
            return 9 * static_cast<std::int64_t>(quads.size());
        }
        case VertexFeature::interior:
            break;
    }
    const auto cells = level_.stars[v.index()];
    for (const CellId cell : cells) add_body_point(cell, v, 1, row);
    return 27 * static_cast<std::int64_t>(cells.size());
}

}  // namespace spline
