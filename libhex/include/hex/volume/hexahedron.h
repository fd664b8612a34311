/// \file hexahedron.h
/// The local numbering of a hexahedron, drawn once and used by every reader, writer and stage.
///
///            7 --------- 6          local axes: u = 0 -> 1, v = 0 -> 3, w = 0 -> 4
///           /|          /|          corner c has (u,v,w) = corner_uvw[c]
///          / |         / |          order is VTK_HEXAHEDRON's and LS-DYNA's
///         4 --------- 5  |
///      w  |  |        |  |          faces, seen from outside counter-clockwise:
///      |  |  3 -------|- 2            0: 0 3 2 1 (w=0)   1: 0 1 5 4 (v=0)   2: 1 2 6 5 (u=1)
///      | v| /         | /             3: 2 3 7 6 (v=1)   4: 0 4 7 3 (u=0)   5: 4 5 6 7 (w=1)
///      |/ |/          |/
///      +- 0 --------- 1             edges: 01 12 23 30  04 15 26 37  45 56 67 74
///        u
///
/// Bezier points of a tricubic element: index i + 4 j + 16 k for (i,j,k) along (u,v,w), u fastest.
#pragma once

#include <array>
#include <cstdint>

namespace hex::hexahedron {

/// Corners, and so vertices, of a hexahedron.
inline constexpr int corner_count = 8;
/// Quadrilaterals around it.
inline constexpr int face_count = 6;
/// Edges of it.
inline constexpr int edge_count = 12;

/// Local coordinates of corner c, each 0 or 1.
inline constexpr std::array<std::array<int, 3>, 8> corner_uvw = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// Corner with the local coordinates (u, v, w): the inverse of corner_uvw.
constexpr int corner_at(int u, int v, int w) {
    return 4 * w + 2 * v + (v == 0 ? u : 1 - u);
}

/// Corners of face f, counter-clockwise seen from outside.
inline constexpr std::array<std::array<int, 4>, 6> face_corners = {
    {{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {4, 5, 6, 7}}};

/// Face opposite to f.
inline constexpr std::array<int, 6> opposite_face = {5, 3, 4, 1, 2, 0};

/// The two corners of edge e.
inline constexpr std::array<std::array<int, 2>, 12> edge_corners = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}}};

/// The three neighbours of corner c along the edges, in the order that makes a right-handed frame for a
/// positive element.
inline constexpr std::array<std::array<int, 3>, 8> corner_neighbours = {
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};

/// The three faces that meet at corner c, ascending.
inline constexpr std::array<std::array<int, 3>, 8> corner_faces = {
    {{0, 1, 4}, {0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {1, 4, 5}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}}};

/// The two faces that share edge e, ascending.
inline constexpr std::array<std::array<int, 2>, 12> edge_faces = {
    {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 4}, {1, 2}, {2, 3}, {3, 4}, {1, 5}, {2, 5}, {3, 5}, {4, 5}}};

/// Edge between two corners, or -1.
constexpr int edge_between(int a, int b) {
    for (int e = 0; e < edge_count; ++e) {
        if ((edge_corners[e][0] == a && edge_corners[e][1] == b) ||
            (edge_corners[e][0] == b && edge_corners[e][1] == a))
            return e;
    }
    return -1;
}

/// Bezier points at corners 0..7 of a tricubic element.
inline constexpr std::array<int, 8> bezier_corner = {0, 3, 15, 12, 48, 51, 63, 60};
/// The inner (body) Bezier point next to each corner: one step from it along all three axes.
inline constexpr std::array<int, 8> bezier_body = {21, 22, 26, 25, 37, 38, 42, 41};

}  // namespace hex::hexahedron
