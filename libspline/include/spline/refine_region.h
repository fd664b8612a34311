/// \file refine_region.h
/// Elements to refine by place or quality instead of by number.
#pragma once

#include <hex/base/linear_algebra.h>
#include <spline/level_mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace spline {

/// Which elements of a level to divide. Of the members below only those that `kind` names count, and `level`.
struct RefineRegion {
    /// How elements are chosen.
    enum class Kind : std::uint8_t {
        box,      ///< elements whose bounding box meets `box`
        sphere,   ///< elements whose bounding box comes within `radius` of `center`
        points,   ///< for each point the element whose bounding box, then its centre, is nearest to it
        patches,  ///< elements with a face on one of these patches (LevelMesh::patch_of_quad)
        worst,    ///< the `share` of the elements with the least scaled Jacobian, at least one
        /// Those whose boundary is farthest from the part: as many as the `share` of all elements of the
        /// level that are not yet divided, at least one unless none is on the boundary. Only `spline::build`
        /// can tell, by SplineOptions::fit_errors.
        worst_fit,
    };
    Kind kind = Kind::box;                  ///< how elements are chosen
    hex::BoundingBox box;                   ///< for Kind::box, in the coordinates of the mesh
    hex::Vec3 center = hex::Vec3::Zero();   ///< of the sphere
    double radius = 0.0;                    ///< of the sphere, >= 0
    std::vector<hex::Vec3> points;          ///< for Kind::points
    std::vector<std::int32_t> patches;      ///< for Kind::patches, 0-based
    std::vector<std::string> patch_places;  ///< `file:line` of each patch, for messages; may be empty
    double share = 0.0;                     ///< in (0, 1]
    int level = 1;                          ///< elements are divided until they are of this level, >= 1
};

/// The elements (0-based, ascending) of the first `domain_cells` of a level that a region asks to divide.
/// None for `worst_fit`.
std::vector<std::int64_t> elements_in(const RefineRegion& region, const LevelMesh& level,
                                      std::size_t domain_cells);

/// Throws Error{bad_input} when the region names a patch that level 0 does not have.
void require_patches(const RefineRegion& region, const LevelMesh& coarsest);

/// Parses `box:x0,y0,z0,x1,y1,z1[:level]`, `sphere:x,y,z,radius[:level]`, `near:FILE[:level]`,
/// `worst:N%[:level]`, `worst-fit:N%[:level]`. FILE has a point `x y z` or a 0-based patch number on each
/// line; '#' starts a comment. Throws Error{usage} for anything else, Error{bad_input} with `file:line` for
/// the file.
RefineRegion parse_region(const std::string& text);

}  // namespace spline
