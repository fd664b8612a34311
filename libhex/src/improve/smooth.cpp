/// Smoothing of interior, boundary and crease vertices, guarded (paper, section on quality improvement).

#include "improve/sweep.h"

namespace hex {
namespace {

/// Interior vertices go towards the volume centre of their cells, boundary vertices towards the area centre
/// of their quads, crease vertices towards the middle of their neighbours; each by a share of the way, and
/// only if the smallest scaled Jacobian around the vertex does not fall.
class SmoothImprover : public Improver {
  public:
    ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options,
                          const Context& context) const override {
        improving::Sweeper sweeper(mesh, options, context);
        const double step = options.step > 0.0 ? options.step : 0.01;
        sweeper.run(options.count < 0 ? 50 : options.count, "smooth",
                    [&](VertexId v, improving::Workspace& workspace) {
                        const Vec3 here = sweeper.mesh().position(v);
                        const improving::Star& star = sweeper.gather(v, workspace);
                        Vec3 target;
                        if (sweeper.on_boundary(v)) {
                            target = here + step * sweeper.motion().smoothing_displacement(v);
                            target = sweeper.motion().constrained(v, target);
                        } else {
                            target = here + step * (star.volume_centre(here) - here);
                        }
                        if (target == here) return false;
                        if (!star.allows(here, target, sweeper.star_minimum(v))) return false;
                        sweeper.move(v, target, star);
                        return true;
                    });
        return sweeper.finish();
    }
};

const Register<Improver, SmoothImprover> registered(
    improvers(), "smooth",
    "vertices a small step to the centre of their cells, quads or edges, where quality does not fall");

}  // namespace
}  // namespace hex
