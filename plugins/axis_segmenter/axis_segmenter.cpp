/// \file axis_segmenter.cpp
/// The smallest useful plug-in: labels each triangle with the axis nearest to its normal. This is the
/// starting point of the built-in methods, without their clean-up.
///
///     hexspline segment -i part.stl -o part_segment.k --method axis --plugin axis_segmenter.so

#include <hex/base/parallel.h>
#include <hex/base/plugin.h>
#include <hex/segment/segment.h>

namespace {

/// The label whose axis makes the smallest angle with `normal`; the first of equals. The length of the normal
/// does not matter, so none has to be divided by: a triangle without area gets label 0.
int nearest_axis(const hex::Vec3& normal) {
    int nearest = 0;
    for (int label = 1; label < 6; ++label) {
        if (normal.dot(hex::label_axis(label)) > normal.dot(hex::label_axis(nearest))) nearest = label;
    }
    return nearest;
}

class AxisSegmenter : public hex::Segmenter {
  public:
    hex::SegmentResult segment(const hex::TriangleMesh& mesh, const hex::SegmentOptions&,
                               const hex::Context& context) const override {
        hex::SegmentResult result;
        auto& labels = result.segmentation.labels;
        labels.resize(mesh.n_faces());
        hex::with_threads(context, [&] {
            hex::parallel_for(mesh.n_faces(), [&](std::size_t f) {
                std::array<hex::Vec3, 3> corners;
                std::size_t i = 0;
                const auto face = mesh.face_handle(static_cast<unsigned>(f));
                for (const auto v : mesh.fv_range(face)) corners[i++] = hex::to_eigen(mesh.point(v));
                const hex::Vec3 along = corners[1] - corners[0], across = corners[2] - corners[0];
                labels[f] = nearest_axis(along.cross(across));
            });
        });
        return result;
    }
};

void register_methods() {
    hex::segmenters().add("axis", "the axis nearest to each triangle's normal, nothing more",
                          [] { return std::make_unique<AxisSegmenter>(); });
}

}  // namespace

HEX_PLUGIN("axis-segmenter", "1.0", register_methods)
