#include <hex/base/error.h>
#include <hex/base/method_call.h>
#include <hex/base/parallel.h>
#include <hex/segment/charts.h>
#include <hex/segment/segment.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace hex {
namespace {

/// Throws Error{bad_input} for an index or label out of range, with its place.
void require_in_range(const std::vector<ManualLabel>& list, const char* name, std::size_t triangles) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        const ManualLabel& manual = list[i];
        const std::string where =
            manual.place.empty() ? std::string(name) + " " + std::to_string(i + 1) : manual.place;
        if (manual.triangle < 0 || manual.triangle >= static_cast<std::int64_t>(triangles))
            throw Error(ErrorKind::bad_input,
                        "triangle " + std::to_string(manual.triangle) + " is not one of 0.." +
                            std::to_string(static_cast<std::int64_t>(triangles) - 1),
                        where, "check whether the list counts from 0 or from 1");
        if (manual.label < 0 || manual.label > 5)
            throw Error(ErrorKind::bad_input, "label " + std::to_string(manual.label) + " is not one of 0..5",
                        where,
                        "labels 0..5 are +X -X +Y -Y +Z -Z; check whether the list counts from 0 or from 1");
    }
}

void apply_manual(const SegmentOptions& options, SegmentResult& result) {
    auto& labels = result.segmentation.labels;
    const auto before = labels;
    for (const ManualLabel& manual : options.manual)
        labels[static_cast<std::size_t>(manual.triangle)] = manual.label;
    for (std::size_t t = 0; t < labels.size(); ++t) {
        if (labels[t] != before[t]) ++result.report.manual_changes;
    }
}

/// Throws Error{bad_input} for a matrix that does more than turn, but for rounding.
void require_rotation(const Eigen::Matrix3d& matrix) {
    constexpr double rounding = 1e-6;
    const double off = (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!matrix.allFinite() || off > rounding || matrix.determinant() < 0.0)
        throw Error(ErrorKind::bad_input, "its rotation is none");
}

/// Checks what a method gives, and adds what it leaves to the stage.
void complete(const TriangleMesh& mesh, const SegmentOptions& options, const MethodCall<Segmenter>& method,
              SegmentResult& result) {
    result.report.method = options.method;
    method.require("labelling", [&] {
        require_labels(result.segmentation, mesh.n_faces());
        require_rotation(result.rotation);
    });
    apply_manual(options, result);
    for (const int label : result.segmentation.labels)
        ++result.report.label_counts[static_cast<std::size_t>(label)];
    const LabelCharts charts = find_charts(mesh, result.segmentation);
    result.report.charts = charts.charts.size();
    result.report.boundaries = charts.boundaries.size();
    result.report.corners = charts.corners.size();
    result.report.violations = validate_charts(charts);
}

}  // namespace

const char* label_name(int label) {
    static constexpr std::array names = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};
    return label >= 0 && label < 6 ? names[static_cast<std::size_t>(label)] : "none";
}

Vec3 label_axis(int label) {
    Vec3 axis = Vec3::Zero();
    axis[label / 2] = label % 2 == 0 ? 1.0 : -1.0;
    return axis;
}

void require_labels(const Segmentation& segmentation, std::size_t triangles) {
    const auto& labels = segmentation.labels;
    if (labels.size() != triangles)
        throw Error(ErrorKind::bad_input, std::to_string(labels.size()) + " labels for " +
                                              std::to_string(triangles) + " triangles");
    const auto odd = std::find_if(labels.begin(), labels.end(), [](int l) { return l < 0 || l > 5; });
    if (odd != labels.end())
        throw Error(ErrorKind::bad_input, "label " + std::to_string(*odd) + " is not one of 0..5",
                    "triangle " + std::to_string(odd - labels.begin()));
}

Registry<Segmenter>& segmenters() {
    static Registry<Segmenter> registry("segment");
    return registry;
}

SegmentResult segment(const TriangleMesh& mesh, const SegmentOptions& options, const Context& context) {
    if (!(options.boundary_weight >= 0.0) || !std::isfinite(options.boundary_weight))
        throw Error(ErrorKind::usage, "the weight of the boundary-enhanced term must be a number >= 0");
    if (options.attempt < 0 || options.attempt > 3)
        throw Error(ErrorKind::usage, "the attempt must be 0, 1, 2 or 3");
    const MethodCall<Segmenter> method(segmenters(), options.method);
    if (mesh.n_faces() == 0) throw Error(ErrorKind::bad_input, "the surface has no triangles");
    require_in_range(options.manual, "manual label", mesh.n_faces());
    require_in_range(options.avoid, "label to avoid", mesh.n_faces());
    return with_threads(context, [&] {
        SegmentResult result =
            method([&](const Segmenter& segmenter) { return segmenter.segment(mesh, options, context); });
        complete(mesh, options, method, result);
        if (result.next_attempt) complete(mesh, options, method, *result.next_attempt);
        return result;
    });
}

TriangleMesh rotated(TriangleMesh mesh, const Eigen::Matrix3d& rotation) {
    for (const auto v : mesh.vertices()) mesh.set_point(v, to_openmesh(rotation * to_eigen(mesh.point(v))));
    return mesh;
}

TriangleMesh with_labels(TriangleMesh mesh, const Segmentation& segmentation) {
    require_labels(segmentation, mesh.n_faces());
    for (const auto f : mesh.faces())
        mesh.data(f).part = segmentation.labels[static_cast<std::size_t>(f.idx())] + 1;
    return mesh;
}

Diagnostics validate_segmentation(const TriangleMesh& mesh, const Segmentation& segmentation) {
    return validate_charts(find_charts(mesh, segmentation));
}

}  // namespace hex
