/// \file cvt.h
/// State and sweeps that CVT and HBECVT share (paper, surface segmentation algorithm; Hu and Zhang, CMAME
/// 305, 2016).
#pragma once

#include "segment/triangle_rings.h"

#include <hex/segment/segment.h>

namespace hex {

/// Labels of the triangles with everything a sweep needs, kept up to date move by move: label histograms of
/// the two-rings and the generators.
class CvtState {
  public:
    using Histogram = std::array<int, 6>;

    /// Labels each triangle with the axis nearest to its normal and makes the generators the means of the
    /// members' normals. Call inside with_threads.
    CvtState(const TriangleMesh& mesh, const Context& context);

    /// Sweeps with the classical distance until a sweep makes fewer than 3 moves, at most 51 times; the
    /// generators follow each move.
    void sweep_classical(std::vector<SweepRecord>& records);

    /// Sweeps with the boundary-enhanced distance until a sweep makes fewer than 3 moves, at most 201 times;
    /// the generators stay as they are.
    void sweep_boundary_enhanced(double weight, std::vector<SweepRecord>& records);

    const std::vector<int>& labels() const { return labels_; }
    const std::array<Vec3, 6>& generators() const { return generators_; }

    /// Sum over the triangles of the squared classical distance to their own generator, plus, for a positive
    /// weight, of the boundary term.
    double energy(double boundary_weight) const;

  private:
    double squared_distance(std::size_t triangle, int label) const;
    /// 2 w (N - m) / N: what a triangle pays when m of the N triangles of its two-ring share its label.
    double boundary_term(std::size_t triangle, int members, double weight) const;
    bool on_label_boundary(std::size_t triangle) const;
    void initial_labels();
    void initial_generators();
    void initial_histograms();
    void relabel(std::size_t triangle, int label);
    void move_generators(std::size_t triangle, int from, int to);

    /// One Gauss-Seidel sweep in the order of the triangles. `distance(t, label)` decides; a triangle moves
    /// to the first label that is strictly nearest. `moved(t, from, to)` is called after each move. Returns
    /// the number of moves.
    template <class Distance, class Moved>
    std::size_t sweep(const Distance& distance, const Moved& moved);

    const Context& context_;
    TriangleArrays arrays_;
    std::vector<Vec3> normals_;
    std::vector<int> labels_;
    std::vector<Histogram> histograms_;  ///< of the two-ring of each triangle, the triangle included
    std::vector<int> ring_sizes_;
    std::array<Vec3, 6> generators_;
    std::array<double, 6> counts_{};
    TwoRing ring_;
};

}  // namespace hex
