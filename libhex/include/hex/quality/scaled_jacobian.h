/// \file scaled_jacobian.h
/// Scaled Jacobian of hexahedra as Verdict defines it (8 corners and the centre), the metric of every
/// acceptance here. Source: Knupp, Ernst, Thompson, Stimpson, Pebay: The Verdict geometric quality library,
/// SAND2007-1751, section on hexahedra.
#pragma once

#include <hex/base/context.h>
#include <hex/volume/hex_mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hex {

/// The smallest of nine numbers det(a,b,c) / (|a||b||c|): for the three edges at each corner, and for the
/// three principal axes (the derivatives of the trilinear map) at the centre. In [-1, 1]; 1 for a cuboid,
/// <= 0 for an inverted element. A corner with an edge of no length counts as 0 (Verdict leaves that
/// undefined).
double scaled_jacobian(const std::array<Vec3, 8>& corners);
/// The same of a cell of a mesh.
double scaled_jacobian(const HexMesh& mesh, CellId cell);

/// At one corner only: det(e1,e2,e3) / (|e1||e2||e3|).
double corner_scaled_jacobian(const std::array<Vec3, 8>& corners, int corner);

/// Of every cell, in cell order. The same bits as scaled_jacobian of each. Throws Error{cancelled}.
std::vector<double> scaled_jacobians(const HexMesh& mesh, const Context& context = {});

/// What a person wants to know of a mesh.
struct QualitySummary {
    std::size_t vertices = 0;                 ///< used by a cell
    std::size_t cells = 0;                    ///< hexahedra
    double min = 0.0;                         ///< smallest scaled Jacobian of a cell
    double mean = 0.0;                        ///< over the cells, not weighted
    CellId worst;                             ///< the first cell that has the value `min`
    std::size_t inverted = 0;                 ///< cells with a scaled Jacobian <= 0
    std::array<std::size_t, 20> histogram{};  ///< counts in equal bins over [-1, 1]
};

/// All zero, and no worst cell, for a mesh without cells.
QualitySummary summarize(const HexMesh& mesh, const Context& context = {});
/// The same from values that are known already, one a cell.
QualitySummary summarize(const HexMesh& mesh, std::span<const double> scaled_jacobians,
                         const Context& context = {});

}  // namespace hex
