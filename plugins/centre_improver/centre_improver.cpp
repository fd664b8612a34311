/// \file centre_improver.cpp
/// Smooths the interior: each vertex goes towards the mean of the centres of its cells, weighted by their
/// volumes, where the smallest scaled Jacobian around it does not fall. So no result is worse than the input.
///
///     hexspline improve -i part.vtk -o better.vtk -m centre -n 20 --plugin centre_improver.so

#include <hex/base/plugin.h>
#include <hex/improve/improve.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <cmath>

namespace {

struct Cell {
    hex::Vec3 centre;
    double volume;
};

/// The volume is that of the parallelepiped of the principal axes, near enough for a weight.
Cell measure(const std::array<hex::Vec3, 8>& corner) {
    hex::Vec3 centre = hex::Vec3::Zero(), x = centre, y = centre, z = centre;
    for (std::size_t i = 0; i < 8; ++i) {
        centre += corner[i] / 8.0;
        x += (i % 4 == 1 || i % 4 == 2 ? 0.25 : -0.25) * corner[i];
        y += (i % 4 >= 2 ? 0.25 : -0.25) * corner[i];
        z += (i >= 4 ? 0.25 : -0.25) * corner[i];
    }
    return {centre, std::abs(x.cross(y).dot(z))};
}

double smallest_around(const hex::HexMesh& mesh, std::span<const hex::CellId> cells) {
    double smallest = 1.0;
    for (const hex::CellId c : cells) smallest = std::min(smallest, hex::scaled_jacobian(mesh, c));
    return smallest;
}

class CentreImprover : public hex::Improver {
  public:
    hex::ImproveResult improve(const hex::HexMesh& mesh, const hex::ImproveOptions& options,
                               const hex::Context& context) const override {
        hex::ImproveResult result;
        result.mesh = mesh;
        const auto cells_of = hex::vertex_cells(mesh);
        const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
        const double step = options.step > 0.0 ? options.step : 1.0;
        const int sweeps = options.count < 0 ? 50 : options.count;
        for (int sweep = 1; sweep <= sweeps; ++sweep) {
            std::size_t moved = 0;
            // One vertex after the other: simple, and the same for any number of threads.
            for (const hex::VertexId v : mesh.vertices()) {
                const auto cells = cells_of[v.index()];
                if (!cells.empty() && !boundary.contains(v)) moved += move(result.mesh, v, cells, step);
            }
            context.check_cancelled();
            context.progress("centre", static_cast<double>(sweep) / sweeps);
            const hex::QualitySummary quality = hex::summarize(result.mesh, context);
            result.report.history.push_back(
                {sweep, "centre", moved, quality.min, quality.mean, quality.inverted});
            if (moved == 0) break;
        }
        return result;
    }

  private:
    static bool move(hex::HexMesh& mesh, hex::VertexId v, std::span<const hex::CellId> cells, double step) {
        hex::Vec3 sum = hex::Vec3::Zero();
        double volume = 0.0;
        for (const hex::CellId c : cells) {
            const Cell cell = measure(mesh.corner_positions(c));
            sum += cell.volume * cell.centre;
            volume += cell.volume;
        }
        if (volume == 0.0) return false;
        const hex::Vec3 here = mesh.position(v);
        const hex::Vec3 there = here + step * (sum / volume - here);
        if (there == here || !there.allFinite()) return false;
        const double before = smallest_around(mesh, cells);
        mesh.set_position(v, there);
        if (smallest_around(mesh, cells) >= before) return true;
        mesh.set_position(v, here);
        return false;
    }
};

void register_methods() {
    hex::improvers().add("centre",
                         "interior vertices to the centres of their cells, where quality does not fall",
                         [] { return std::make_unique<CentreImprover>(); });
}

}  // namespace

HEX_PLUGIN("centre-improver", "1.0", register_methods)
