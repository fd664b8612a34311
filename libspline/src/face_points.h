/// \file face_points.h
/// The Bezier points of an element's faces.
#pragma once

#include <array>
#include <cstddef>

namespace spline {

/// The 16 points (i + 4 j + 16 k) on local face f of hexahedron.h, ascending: the first parameter of the face
/// runs fastest.
constexpr std::array<std::size_t, 16> face_points(std::size_t f) {
    // The axis on which the face is constant, and where.
    constexpr std::array<std::array<std::size_t, 2>, 6> face = {
        {{2, 0}, {1, 0}, {0, 3}, {1, 3}, {0, 0}, {2, 3}}};
    std::array<std::size_t, 16> points{};
    std::size_t count = 0;
    for (std::size_t p = 0; p < 64; ++p) {
        const std::array<std::size_t, 3> at = {p % 4, p / 4 % 4, p / 16};
        if (at[face[f][0]] == face[f][1]) points[count++] = p;
    }
    return points;
}

}  // namespace spline
