/// \file chain_curve.h
/// A boundary chain of a patch as a curve over [0, 1] by normalised chord length.
#pragma once

#include <hex/surface/mesh_types.h>
#include <hex/surface/patch_layout.h>

#include <vector>

namespace hex {

/// The polyline through the vertices of a chain, t = length so far / whole length (Yu, Wei, Li, Liu, He,
/// Zhang: HexGen and Hex2Spline, section on parametric mapping: t_i = L_i / L). A chain without length is
/// parameterised uniformly by its edges.
class ChainCurve {
  public:
    ChainCurve() = default;
    /// At least two points.
    explicit ChainCurve(std::vector<Vec3> points);
    /// Through the vertices of a chain of at least two.
    ChainCurve(const TriangleMesh& mesh, const Chain& chain);

    /// The point at t in [0, 1] (clamped); lies on an edge of the chain, and is exactly its first or last
    /// point at 0 and 1. Logarithmic in the number of points.
    Vec3 point(double t) const;

    /// Length of the polyline.
    double length() const { return length_; }
    /// The vertices of the polyline, as given.
    const std::vector<Vec3>& points() const { return points_; }
    /// Parameters of the points: 0 first, 1 last, not decreasing.
    const std::vector<double>& parameters() const { return parameters_; }

  private:
    std::vector<Vec3> points_;
    std::vector<double> parameters_;
    double length_ = 0.0;
};

}  // namespace hex
