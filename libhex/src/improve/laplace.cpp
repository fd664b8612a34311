/// Laplacian smoothing of the interior, guarded.

#include "improve/sweep.h"

namespace hex {
namespace {

/// Every interior vertex goes towards the mean of its edge neighbours (REFERENCE: paper, mode 0), if the
/// smallest scaled Jacobian around it does not fall. The boundary stays.
class LaplaceImprover : public Improver {
  public:
    ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                          const Context& context) const override {
        improving::Sweeper sweeper(mesh, std::vector<char>(mesh.vertex_count(), 1), context);
        const double step = options.step > 0.0 ? options.step : 1.0;
        const EdgeTable& edges = sweeper.edges();
        sweeper.run(options.count < 0 ? 50 : options.count, "laplace",
                    [&](VertexId v, improving::Workspace& workspace) {
                        Vec3 mean = Vec3::Zero();
                        const auto around = edges.vertex_edges[v.index()];
                        for (const EdgeId e : around) mean += sweeper.mesh().position(edges.other(e, v));
                        mean /= static_cast<double>(around.size());
                        const Vec3 here = sweeper.mesh().position(v);
                        const Vec3 target = here + step * (mean - here);
                        if (target == here) return false;
                        const improving::Star& star = sweeper.gather(v, workspace);
                        if (!star.allows(here, target, sweeper.star_minimum(v))) return false;
                        sweeper.move(v, target, star);
                        return true;
                    });
        return sweeper.finish();
    }
};

const Register<Improver, LaplaceImprover> registered(
    improvers(), "laplace", "interior vertices to the mean of their neighbours, where quality does not fall");

}  // namespace
}  // namespace hex
