/// \file transfinite.h
/// Transfinite interpolation on index grids: the inside of a face from its four edge curves (Coons), the
/// inside of a block from its six faces (Gordon and Hall). Both are combinations of points with weights that
/// add up to one, so they commute with every affine map of space, and both reproduce trilinear maps exactly.
///
/// Sources: S. A. Coons, Surfaces for computer-aided design of space forms, MIT 1967; W. J. Gordon, C. A.
/// Hall, Construction of curvilinear co-ordinate systems and applications to mesh generation, Int. J. Numer.
/// Meth. Eng. 7 (1973) 461-477.
#pragma once

#include <hex/base/linear_algebra.h>

#include <cstddef>
#include <vector>

namespace hex {

/// (nu+1) x (nv+1) points over (i/nu, j/nv), i fastest. nu, nv >= 1.
class FaceGrid {
  public:
    /// All points at the origin.
    FaceGrid(int nu, int nv) : nu_(nu), nv_(nv), points_(size(nu) * size(nv), Vec3::Zero()) {}

    int nu() const { return nu_; }  ///< pieces along u
    int nv() const { return nv_; }  ///< pieces along v
    /// The point at (i/nu, j/nv), 0 <= i <= nu, 0 <= j <= nv; not checked.
    Vec3& operator()(int i, int j) { return points_[index(i, j)]; }
    /// The same, to read.
    const Vec3& operator()(int i, int j) const { return points_[index(i, j)]; }

  private:
    static std::size_t size(int n) { return static_cast<std::size_t>(n) + 1; }
    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(i) + size(nu_) * static_cast<std::size_t>(j);
    }

    int nu_;
    int nv_;
    std::vector<Vec3> points_;
};

/// (nu+1) x (nv+1) x (nw+1) points over (i/nu, j/nv, k/nw), i fastest, then j. nu, nv, nw >= 1.
class BlockGrid {
  public:
    /// All points at the origin.
    BlockGrid(int nu, int nv, int nw)
        : nu_(nu), nv_(nv), nw_(nw), points_(size(nu) * size(nv) * size(nw), Vec3::Zero()) {}

    int nu() const { return nu_; }  ///< pieces along u
    int nv() const { return nv_; }  ///< pieces along v
    int nw() const { return nw_; }  ///< pieces along w
    /// The point at (i/nu, j/nv, k/nw), 0 <= i <= nu and so on; not checked.
    Vec3& operator()(int i, int j, int k) { return points_[index(i, j, k)]; }
    /// The same, to read.
    const Vec3& operator()(int i, int j, int k) const { return points_[index(i, j, k)]; }

  private:
    static std::size_t size(int n) { return static_cast<std::size_t>(n) + 1; }
    std::size_t index(int i, int j, int k) const {
        return static_cast<std::size_t>(i) +
               size(nu_) * (static_cast<std::size_t>(j) + size(nv_) * static_cast<std::size_t>(k));
    }

    int nu_;
    int nv_;
    int nw_;
    std::vector<Vec3> points_;
};

/// Sets the inner points of a face from the points on its border.
/// X(u,v) = (1-v) E0(u) + v E1(u) + (1-u) F0(v) + u F1(v) - bilinear interpolation of the corners.
void fill_inside(FaceGrid& face);

/// Sets the inner points of a block from the points on its six faces.
/// X(u,v,w) = sum of the 3 linear blends of opposite faces - sum of the 3 bilinear blends of parallel edges
/// + trilinear interpolation of the corners.
void fill_inside(BlockGrid& block);

}  // namespace hex
