/// \file cell_energies.h
/// Energies of a whole mesh that are sums over its cells, evaluated for ranges of cells.
#pragma once

#include <hex/improve/corner_energies.h>
#include <hex/volume/hex_mesh.h>

#include <span>
#include <utility>

namespace hex::improving {

class MeshEnergy {
  public:
    virtual ~MeshEnergy() = default;
    /// Values of the cells [first, last) into `values[first]` and on, and the gradients for their corners
    /// into `gradients[first]` and on unless that is null. A value may be infinite; its gradient then has no
    /// meaning. Thread-safe for different ranges; the result for a cell does not depend on the range.
    virtual void evaluate(const HexMesh& mesh, std::size_t first, std::size_t last, std::span<double> values,
                          HexCorners* gradients) const = 0;
};

/// Of a function `energy(cell, corners, gradient or null)` that returns the value and adds to the gradient.
template <class Function>
class PerCellEnergy : public MeshEnergy {
  public:
    explicit PerCellEnergy(Function energy) : energy_(std::move(energy)) {}
    void evaluate(const HexMesh& mesh, std::size_t first, std::size_t last, std::span<double> values,
                  HexCorners* gradients) const override {
        for (std::size_t c = first; c < last; ++c) {
            HexCorners* const own = gradients != nullptr ? gradients + c : nullptr;
            if (own != nullptr) own->fill(Vec3::Zero());
            values[c] = energy_(c, mesh.corner_positions(CellId(c)), own);
        }
    }

  private:
    Function energy_;
};

/// mean_weight times the defect of QualityMean (without its barrier) plus barrier_weight times the barrier of
/// QualityBarrier plus ShortEdgeEnergy: with weights 0 and 1 what raises the minimum, with 1 and 0.01 the
/// mean. Four cells at a time, with the widest instructions that the processor has and the same bits on
/// each.
class QualityMeshEnergy : public MeshEnergy {
  public:
    /// Keeps a reference to `boxes`.
    explicit QualityMeshEnergy(std::span<const Vec3> boxes) : boxes_(boxes) {}
    double floor = -1.0;
    double mean_weight = 0.0;
    double barrier_weight = 1.0;
    ShortEdgeEnergy short_edges;
    void evaluate(const HexMesh& mesh, std::size_t first, std::size_t last, std::span<double> values,
                  HexCorners* gradients) const override;

  private:
    std::span<const Vec3> boxes_;
};

}  // namespace hex::improving
