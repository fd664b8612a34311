#include "segment/cvt.h"

namespace hex {
namespace {

/// Classical CVT, then CVT with the harmonic boundary-enhanced distance: regions with few zigzags.
class HarmonicBoundaryEnhancedCvt final : public Segmenter {
  public:
    SegmentResult segment(const TriangleMesh& mesh, const SegmentOptions& options,
                          const Context& context) const override {
        SegmentResult result;
        CvtState state(mesh, context);
        state.sweep_classical(result.report.sweeps);
        state.sweep_boundary_enhanced(options.boundary_weight, result.report.sweeps);
        result.segmentation.labels = state.labels();
        result.report.generators = state.generators();
        return result;
    }
};

const Register<Segmenter, HarmonicBoundaryEnhancedCvt> registered(
    segmenters(), "hbecvt",
    "CVT, then CVT with the harmonic boundary-enhanced distance (the paper's method)");

}  // namespace
}  // namespace hex
