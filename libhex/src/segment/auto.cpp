#include "segment/label_cut.h"
#include "segment/label_repair.h"

#include <hex/segment/segment.h>

#include <algorithm>
#include <optional>

namespace hex {
namespace {

/// A graph cut, repaired until it is the labelling of a polycube.
class Automatic final : public Segmenter {
  public:
    SegmentResult segment(const TriangleMesh& mesh, const SegmentOptions&,
                          const Context& context) const override {
        const LabelSurface surface = label_surface(mesh, Eigen::Matrix3d::Identity());
        // More compactness means fewer charts and straighter boundaries, paid in faith.
        std::optional<LabelRepair> best;
        double share = 0.0;
        for (const double compactness : {0.005, 0.02}) {
            context.check_cancelled();
            context.progress("auto", share);
            share += 0.5;
            LabelRepair repair = repair_labels(mesh, surface, cut_labels(surface, compactness), context);
            if (!best || better(repair.score, best->score)) best = std::move(repair);
        }
        context.progress("auto", 1.0);
        SegmentResult result;
        result.segmentation.labels = std::move(best->labels);
        result.report.repairs = std::move(best->repairs);
        return result;
    }

  private:
    static bool better(const LabelScore& a, const LabelScore& b) {
        constexpr double weight_of_validity = 1.0;
        return a.energy(weight_of_validity) < b.energy(weight_of_validity);
    }
};

const Register<Segmenter, Automatic> registered(
    segmenters(), "auto", "a graph cut, repaired until a polycube can have these labels");

}  // namespace
}  // namespace hex
