#include "segment/best_axes.h"
#include "segment/label_cut.h"
#include "segment/label_repair.h"

#include <hex/base/parallel.h>
#include <hex/segment/segment.h>

#include <vector>

namespace hex {
namespace {

/// A graph cut, repaired until it is the labelling of a polycube.
class Automatic final : public Segmenter {
  public:
    SegmentResult segment(const TriangleMesh& mesh, const SegmentOptions& options,
                          const Context& context) const override {
        SegmentResult result;
        LabelSurface surface = label_surface(mesh, result.rotation);
        if (options.align) {
            result.rotation = best_axes(surface.normals, surface.areas);
            surface = label_surface(mesh, result.rotation);
        }
        for (const ManualLabel& avoided : options.avoid) {
            const auto t = static_cast<std::size_t>(avoided.triangle);
            surface.costs[t][static_cast<std::size_t>(avoided.label)] += price_of_avoided * surface.areas[t];
        }
        const std::vector<double> compactness = compactness_of(options.attempt);
        std::vector<LabelRepair> found(compactness.size());
        context.progress("auto", 0.0);
        parallel_for(
            found.size(),
            [&](std::size_t i) {
                context.check_cancelled();
                found[i] = repair_labels(mesh, surface, cut_labels(surface, compactness[i]), context);
            },
            1);
        context.progress("auto", 1.0);
        // Of two, the first attempt takes the better one, the second the other.
        std::size_t chosen = 0;
        if (found.size() == 2) {
            const bool second_is_better =
                found[1].score.energy(weight_of_validity) < found[0].score.energy(weight_of_validity);
            chosen = second_is_better == (options.attempt == 0) ? 1 : 0;
        }
        take(std::move(found[chosen]), result);
        if (options.attempt == 0) {
            result.next_attempt = std::make_shared<SegmentResult>();
            result.next_attempt->rotation = result.rotation;
            take(std::move(found[1 - chosen]), *result.next_attempt);
        }
        return result;
    }

  private:
    static constexpr double weight_of_validity = 1.0;
    static constexpr double price_of_avoided = 0.5;  // 1 - cos 60 degrees

    static void take(LabelRepair&& found, SegmentResult& result) {
        result.segmentation.labels = std::move(found.labels);
        result.report.repairs = std::move(found.repairs);
    }

    /// More compactness means fewer charts and straighter boundaries, paid in faith; beyond 0.05 too much.
    static std::vector<double> compactness_of(int attempt) {
        if (attempt < 2) return {0.005, 0.02};
        return {attempt == 2 ? 0.01 : 0.035};
    }
};

const Register<Segmenter, Automatic> registered(
    segmenters(), "auto", "a graph cut, repaired until a polycube can have these labels");

}  // namespace
}  // namespace hex
