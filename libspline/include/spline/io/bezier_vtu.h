/// \file bezier_vtu.h
/// Bezier elements for ParaView: VTK XML unstructured grid.
#pragma once

#include <spline/bezier.h>

#include <filesystem>

namespace spline::io {

/// Writes every element as a VTK_BEZIER_HEXAHEDRON (cell type 79) of degree 3, with `HigherOrderDegrees` as
/// attribute of the cells and `RationalWeights` of the points; cell data `level` and `element` say where a
/// cell comes from. Bezier points that elements share are one point of the file. Appended binary, packed
/// by zlib.
///
/// File version 2.1: readers of VTK permute points 28 to 31 of a cell in older versions.
/// Throws Error{output}.
void write_bezier_vtu(const std::filesystem::path& path, const BezierSpline& spline);

}  // namespace spline::io
