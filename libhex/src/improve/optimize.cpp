/// Optimisation of the worst scaled Jacobians (paper, section on quality improvement).

#include "improve/ascent.h"

namespace hex {
namespace {

/// Each sweep visits the vertices around which something is worse than the mesh's mean, and moves each to
/// raise the smallest scaled Jacobian around it.
class OptimizeImprover : public Improver {
  public:
    ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                          const Context& context) const override {
        improving::Sweeper sweeper(mesh, options, context);
        const double step = options.step > 0.0 ? options.step : 0.01;
        double mean = 0.0;
        sweeper.run(
            options.count < 0 ? 50 : options.count, "optimize",
            [&](VertexId v, improving::Workspace& workspace) {
                return sweeper.star_minimum(v) < mean &&
                       improving::raise_star_minimum(sweeper, v, step, workspace);
            },
            [&] { mean = improving::record_of(sweeper.values()).mean; });
        return sweeper.finish();
    }
};

const Register<Improver, OptimizeImprover> registered(
    improvers(), "optimize", "raises the smallest scaled Jacobian around each vertex by line search");

}  // namespace
}  // namespace hex
