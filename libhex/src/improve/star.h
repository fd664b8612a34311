/// \file star.h
/// The cells around one vertex, gathered so that a new position of the vertex can be judged fast.
#pragma once

#include "quality/scaled_jacobian_kernel.h"

#include <hex/volume/topology.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace hex::improving {

/// A cell at a vertex, and which of its corners the vertex is.
struct StarCell {
    std::uint32_t cell;
    std::uint32_t corner;
};

/// Cells around each vertex, ascending.
CompressedRows<StarCell> vertex_stars(const HexMesh& mesh);

/// The same scaled Jacobian computed from another corner of the cell differs by rounding, in units of 1e-16.
/// A value counts as larger, or as positive, only by more than this, so that what is promised here holds for
/// the numbers that anybody computes afterwards.
inline constexpr double rounding = 4e-15;

/// How good the cells of a star are.
struct StarQuality {
    std::size_t inverted = 0;
    double min = 1.0;

    /// Fewer inverted cells, or as many and a larger minimum.
    bool better_than(const StarQuality& other) const {
        return inverted != other.inverted ? inverted < other.inverted : min > other.min + rounding;
    }
};

/// One of the numbers whose minimum is a scaled Jacobian, and its gradient with respect to the vertex.
struct Term {
    double value;
    Vec3 gradient;
};

/// The star of one vertex, with the vertex as corner 0 of every cell (the cells are turned). Moving the
/// vertex changes five of the nine numbers whose minimum is a cell's scaled Jacobian: those of corners 0, 1,
/// 3, 4 and of the centre. The other four are computed at most once.
///
/// Reuse one object for many vertices: it keeps its memory.
class Star {
  public:
    void gather(const HexMesh& mesh, std::span<const StarCell> cells);

    std::size_t size() const { return cells_.size(); }

    /// Whether the vertex may go from `here` to `there`: the star's minimum, now `minimum`, does not fall,
    /// and the number of inverted cells does not grow.
    bool allows(const Vec3& here, const Vec3& there, double minimum) const;

    /// Quality of the whole star with the vertex at p.
    StarQuality quality(const Vec3& p) const;

    /// Scaled Jacobians of the cells with the vertex at p, written to `values[cell]`.
    void store(const Vec3& p, std::span<double> values) const;

    /// Values and gradients, with the vertex at p, of all numbers that depend on it, for the two functions
    /// below.
    void compute_terms(const Vec3& p);

    /// Direction in which the bad ones of these numbers grow together: the sum of their gradients, with
    /// weights that fall off above the smallest one. `softness` > 0 is the rise of a scaled Jacobian above
    /// the minimum at which its weight has fallen to 1/e. Units: 1 / length.
    Vec3 weighted_ascent(double softness) const;

    /// Direction in which the smallest one grows fastest, when all within `range` of it count as smallest.
    /// `allowed` takes from a gradient what the vertex cannot follow. Zero where no direction raises them
    /// all.
    Vec3 steepest_ascent(double range, const std::function<Vec3(const Vec3&)>& allowed);

    /// Volume-weighted mean of the cells' centres (paper, smoothing of interior vertices); the
    /// volumes are those of the trilinear maps. The plain mean where the volumes cancel out.
    Vec3 volume_centre(const Vec3& p) const;

  private:
    using Lanes = quality::Lanes;
    struct Block {
        std::array<quality::Vector<Lanes>, 8> corners;
        int count = 0;
    };

    /// The smallest of the five numbers of each cell that depend on the vertex.
    static Lanes moving(const Block& block, const quality::Vector<Lanes>& p);
    /// The smallest of the four that do not.
    void compute_fixed() const;

    std::span<const StarCell> cells_;
    std::vector<Block> blocks_;
    std::size_t block_count_ = 0;
    mutable std::vector<Lanes> fixed_;
    mutable bool fixed_known_ = false;
    mutable std::vector<Lanes> allowed_;  ///< what `moving` gave where `allows` last said yes
    mutable std::optional<Vec3> allowed_place_;
    std::vector<Term> terms_;
    double lowest_term_ = 1.0;
    std::vector<Vec3> gradients_;
};

}  // namespace hex::improving
