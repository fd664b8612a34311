#include <hex/base/error.h>
#include <hex/segment/charts.h>
#include <hex/segment/segment.h>
#include <hex/surface/patch_layout.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace hex {
namespace {

/// The axis nearest to the vector area of a patch; the first of the nearest.
int facing_label(const TriangleMesh& mesh, const Patch& patch) {
    Vec3 area = Vec3::Zero();
    for (const int t : patch.triangles) {
        std::array<Vec3, 3> p;
        std::size_t k = 0;
        for (const auto v : mesh.fv_range(mesh.face_handle(static_cast<unsigned>(t))))
            p[k++] = to_eigen(mesh.point(v));
        area += (p[1] - p[0]).cross(p[2] - p[0]);
    }
    int best = 0;
    for (int label = 1; label < 6; ++label) {
        if (area.dot(label_axis(label)) > area.dot(label_axis(best))) best = label;
    }
    return best;
}

}  // namespace

SegmentResult segment_from_patches(const TriangleMesh& mesh) {
    if (mesh.n_faces() == 0) throw Error(ErrorKind::bad_input, "the surface has no triangles");
    const PatchLayout layout = find_patches(mesh);
    SegmentResult result;
    SegmentReport& report = result.report;
    report.method = "from-patches";
    report.charts = layout.patches.size();
    report.corners = layout.corners.size();

    auto& labels = result.segmentation.labels;
    labels.assign(mesh.n_faces(), 0);
    std::size_t sides = 0;
    for (const Patch& patch : layout.patches) {
        const int label = facing_label(mesh, patch);
        for (const int t : patch.triangles) labels[static_cast<std::size_t>(t)] = label;
        report.label_counts[static_cast<std::size_t>(label)] += patch.triangles.size();
        for (const auto& loop : patch.loops) sides += loop.size();
    }
    report.boundaries = sides / 2;  // each boundary of a closed surface is met from both sides

    report.violations = diagnose_layout(layout);
    for (Diagnostic& finding : validate_segmentation(mesh, result.segmentation)) {
        if (finding.code != "opposite-labels-adjacent") continue;
        // A curved patch may face elsewhere on the whole than along this boundary.
        finding.severity = Severity::warning;
        report.violations.push_back(std::move(finding));
    }
    return result;
}

CompletedPatches complete_patches(TriangleMesh mesh, const SegmentOptions& options, const Context& context) {
    CompletedPatches result;
    int last = 0;
    for (const auto f : mesh.faces()) {
        last = std::max(last, mesh.data(f).part);
        if (mesh.data(f).part <= 0) ++result.triangles;
    }
    if (result.triangles > 0) {
        const std::vector<int> labels = segment(mesh, options, context).segmentation.labels;
        const auto label = [&](TriangleMesh::FaceHandle f) {
            return labels[static_cast<std::size_t>(f.idx())];
        };
        std::vector<TriangleMesh::FaceHandle> front;
        for (const auto seed : mesh.faces()) {
            if (mesh.data(seed).part > 0) continue;
            if (last == std::numeric_limits<int>::max())
                throw Error(ErrorKind::unsupported, "there is no part id left for a new patch");
            result.parts.push_back(++last);
            mesh.data(seed).part = last;
            front.push_back(seed);
            while (!front.empty()) {
                const TriangleMesh::FaceHandle f = front.back();
                front.pop_back();
                for (const auto next : mesh.ff_range(f)) {
                    if (mesh.data(next).part > 0 || label(next) != label(seed)) continue;
                    mesh.data(next).part = last;
                    front.push_back(next);
                }
            }
        }
    }
    result.mesh = std::move(mesh);
    return result;
}

}  // namespace hex
