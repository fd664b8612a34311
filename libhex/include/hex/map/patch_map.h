/// \file patch_map.h
/// A four-sided patch flattened onto the unit square, and back.
#pragma once

#include <hex/map/chain_curve.h>
#include <hex/surface/mesh_types.h>
#include <hex/surface/patch_layout.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace hex {

class TriangleLocator;

/// Weights of the interior vertices, in the order in which they are tried.
enum class PatchWeights {
    discrete_conformal,  ///< cotangents: the discrete harmonic map; may flip triangles at obtuse angles
    mean_value,          ///< positive, so no triangle flips (Floater 2003) but for rounding
    uniform,             ///< Tutte's embedding; does not depend on the shape of any triangle
};

/// "discrete-conformal", "mean-value" or "uniform".
std::string name_of(PatchWeights weights);

/// The flattened triangles of one patch. Plain data, so that it can be drawn, tested and inverted.
///
/// Corners c0..c3 of the patch lie at (0,0), (1,0), (1,1), (0,1), so the orientation is kept: a triangle is
/// counter-clockwise in (u, v) when it is so on the surface seen from outside.
struct PatchParameterization {
    std::vector<Vec3> points;                                 ///< vertices of the patch, on the surface
    std::vector<Vec2> uv;                                     ///< their images in the unit square
    std::vector<std::array<int, 3>> triangles;                ///< of `points`
    PatchWeights weights = PatchWeights::discrete_conformal;  ///< that gave `uv`
    std::size_t flipped = 0;      ///< triangles not counter-clockwise in (u, v), by an exact predicate
    std::size_t split_edges = 0;  ///< edges cut in two; see parameterize
};

/// Flattens a patch: boundary chains by normalised chord length onto the sides of the square, inside by
/// CGAL's Surface_mesh_parameterization with cotangent weights, a fixed square border and a direct sparse
/// solver. When a triangle is flipped (exact predicate), again with mean-value weights, then with uniform
/// ones; the first map without flips wins, or else the one with fewest.
///
/// Edges inside the patch with both ends on one side of the square would flatten everything behind them to a
/// line; they are cut at their midpoints first (`split_edges`). The surface stays the same, and a map with
/// positive weights is then one-to-one for every patch (Tutte 1963, Floater 2003): with a boundary that is
/// convex but not strictly so, such edges are the only obstacle.
///
/// Throws Error{bad_input} when the patch is not four-sided, Error{no_result} when no system could be solved.
PatchParameterization parameterize(const TriangleMesh& surface, const Patch& patch);

/// The inverse of a parameterization: from the unit square to the surface.
class PatchMap {
  public:
    /// Flattens the patch; throws as parameterize does. Keeps nothing of `surface` but copies.
    PatchMap(const TriangleMesh& surface, const Patch& patch);
    ~PatchMap();
    /// The map that is moved from can only be destroyed or assigned to.
    PatchMap(PatchMap&&) noexcept;
    /// As the constructor.
    PatchMap& operator=(PatchMap&&) noexcept;

    /// The point at (u, v), both in [0, 1] (clamped). On the border of the square it lies on the chain at
    /// that chord length; inside, in the flattened triangle that contains (u, v): of all triangles near, the
    /// one in which the smallest barycentric coordinate is largest, so that a tie on an edge does not matter.
    /// Logarithmic in the number of triangles. Throws Error{no_result} when no flattened triangle has area.
    Vec3 point(double u, double v) const;

    /// The flattened patch that this map inverts.
    const PatchParameterization& parameterization() const { return flat_; }
    /// Chain from corner k to corner k + 1.
    const ChainCurve& side(int k) const { return sides_[static_cast<std::size_t>(k)]; }

  private:
    PatchParameterization flat_;
    std::array<ChainCurve, 4> sides_;
    std::unique_ptr<TriangleLocator> locator_;
};

}  // namespace hex
