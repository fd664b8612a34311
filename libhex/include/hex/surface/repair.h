/// \file repair.h
/// Makes a polygon soup fit to be a closed surface, and says what it changed.
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/surface/polygon_soup.h>

#include <cstddef>

namespace hex {

/// How far repair() may go.
struct RepairOptions {
    /// Holes whose border is not longer than this, in diagonals of the bounding box, are filled.
    double longest_hole = 1.0;
};

/// What repair() did; all zero when there was nothing to do.
struct RepairReport {
    std::size_t merged_points = 0;        ///< points in the place of another
    std::size_t degenerate_polygons = 0;  ///< removed: fewer than three corners, or one of them twice
    std::size_t duplicate_polygons = 0;   ///< removed: on the same corners as another
    std::size_t unused_points = 0;        ///< removed
    std::size_t turned_polygons = 0;      ///< oriented against the rest, or all when inside out
    std::size_t split_points = 0;         ///< copies made where the surface was not manifold
    std::size_t filled_holes = 0;         ///< closed with new triangles
    std::size_t filling_triangles = 0;    ///< in all of these holes
    std::size_t removed_points = 0;       ///< inner points of two polygons only
    std::size_t holes_left = 0;           ///< too long, or impossible to fill

    /// The surface is not what it was; holes that are left alone are no change.
    bool changed() const {
        return merged_points + degenerate_polygons + duplicate_polygons + unused_points + turned_polygons +
                   split_points + filled_holes + removed_points >
               0;
    }
};

/// One note a kind of change, in words ("3 points merged"); a warning for holes that are left.
Diagnostics describe(const RepairReport& report);

/// Repairs in place with CGAL's Polygon_mesh_processing: merges equal points, removes degenerate and
/// duplicate polygons, orients neighbours alike, splits edges and points where the surface is not manifold,
/// fills small holes, removes inner points of two polygons only (which could not be split into triangles
/// that fit), and, when no hole is left, turns the surface outwards (its volume as a whole, not each
/// component). Polygons keep their part; the triangles of a hole get that of a neighbour. The surface may
/// still be open afterwards: `holes_left`.
///
/// Throws Error{no_result} when CGAL cannot make a surface of the polygons.
RepairReport repair(PolygonSoup& soup, const RepairOptions& options = {});

}  // namespace hex
