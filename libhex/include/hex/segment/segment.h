/// \file segment.h
/// Stage `segment`: labels the triangles of a closed surface with the six axis directions.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/base/registry.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hex {

/// Labels 0..5 = +X -X +Y -Y +Z -Z, one a triangle.
struct Segmentation {
    std::vector<int> labels;  ///< 0..5, in the order of the triangles
};

/// "+X", "-X", ... of a label.
const char* label_name(int label);
/// The unit vector of a label 0..5.
Vec3 label_axis(int label);

/// Throws Error{bad_input} unless there is one label 0..5 for each of so many triangles.
void require_labels(const Segmentation& segmentation, std::size_t triangles);

/// One label set by hand.
struct ManualLabel {
    std::int64_t triangle = 0;  ///< 0-based index of the triangle
    int label = 0;              ///< 0..5
    std::string place = {};     ///< where it was set (file:line), for messages; may be empty
};

/// The method, its parameters, and the labels that a person insists on.
struct SegmentOptions {
    /// Name of the method in the registry: `auto` (a graph cut, repaired until a polycube can have these
    /// labels), `hbecvt` (CVT, then harmonic boundary-enhanced CVT), `cvt`, or a plug-in's.
    std::string method = "auto";
    /// hbecvt: weight omega of the boundary-enhanced term, >= 0 (paper, equation of HBECVT; the published
    /// runs use 0.1).
    double boundary_weight = 0.1;
    /// auto: 0 for the best labels it finds; 1, 2 and 3 for other ones, with fewer or more charts: what to
    /// try next when no polycube could be built from these.
    int attempt = 0;
    /// auto: labels that these triangles better not have, because charts there stood in the way of a
    /// polycube: each costs so much more as if its axis were 60 degrees farther from the normal.
    std::vector<ManualLabel> avoid;
    /// auto: turn the part to the axes that its normals agree with best (SegmentResult::rotation).
    bool align = false;
    /// Applied last, in order. An index or label out of range throws Error{bad_input}.
    std::vector<ManualLabel> manual;
};

/// One sweep over all triangles.
struct SweepRecord {
    std::string phase;      ///< "cvt" or "hbecvt"
    int sweep = 0;          ///< 1-based within its phase
    std::size_t moves = 0;  ///< triangles that changed their label
    double energy = 0.0;    ///< sum of squared distances after the sweep (for hbecvt: with the boundary term)
};

/// One change that the automatic method made to its first labels.
struct RepairRecord {
    std::string repair;         ///< name of the operator, such as "insert-chart" (docs/automatic.md)
    std::string reason;         ///< code of what was wrong there, such as "opposite-labels-adjacent"
    std::int64_t triangle = 0;  ///< where: the first of the triangles that changed
    std::size_t triangles = 0;  ///< how many changed their label
    /// What it took from the faith to the normals: the rise of the sum, over the triangles, of the share of
    /// the whole area times 1 - cosine between normal and axis (more below a cosine of 0.3). Less than zero
    /// when it gave some back.
    double cost = 0.0;
};

/// What a segmentation gave, and how it came about.
struct SegmentReport {
    std::string method;                         ///< that was run; "from-patches" by segment_from_patches
    std::array<std::size_t, 6> label_counts{};  ///< triangles of each label
    std::vector<SweepRecord> sweeps;            ///< of methods that iterate, in order
    /// Unit generators of the six labels after the last sweep; the axes for methods that have none.
    std::array<Vec3, 6> generators = {label_axis(0), label_axis(1), label_axis(2),
                                      label_axis(3), label_axis(4), label_axis(5)};
    std::vector<RepairRecord> repairs;  ///< of method `auto`, in order
    std::size_t manual_changes = 0;     ///< triangles whose label the manual list changed
    std::size_t charts = 0;             ///< connected regions of equal label
    std::size_t boundaries = 0;         ///< maximal runs of edges between two charts
    std::size_t corners = 0;            ///< vertices where at least three boundaries end
    /// Violations of the paper's three conditions, as validate_charts (charts.h) tells them, each with its
    /// triangle or vertex ids.
    Diagnostics violations;
};

/// Labels, and what there is to say of them.
struct SegmentResult {
    Segmentation segmentation;  ///< manual labels included
    /// The labels are directions of the part after this rotation; not the identity only with `align`. Its
    /// transpose undoes it.
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    SegmentReport report;  ///< of these labels
    /// What the same with the next SegmentOptions::attempt gives, where that came out, too; else null.
    std::shared_ptr<SegmentResult> next_attempt;
};

/// Interface of a segmentation method. Implementations fill `segmentation`, `report.sweeps` when they
/// iterate, and `next_attempt` when they know it; the stage adds the rest.
class Segmenter {
  public:
    virtual ~Segmenter() = default;
    /// Labels every triangle. The options are in range; `options.manual` is the stage's to apply. A labelling
    /// that is not one label 0..5 a triangle makes the stage throw Error{no_result}.
    virtual SegmentResult segment(const TriangleMesh& mesh, const SegmentOptions& options,
                                  const Context& context) const = 0;
};

/// The methods of the stage by name, those of plug-ins included.
Registry<Segmenter>& segmenters();

/// The mesh with all its points turned.
TriangleMesh rotated(TriangleMesh mesh, const Eigen::Matrix3d& rotation);

/// Runs `options.method`, applies the manual labels, counts and validates. The mesh must be closed and
/// manifold (make_triangle_mesh). Throws Error{usage} for an unknown method, a negative weight or an
/// attempt that is not 0..3, Error{bad_input} for manual labels out of range.
SegmentResult segment(const TriangleMesh& mesh, const SegmentOptions& options = {},
                      const Context& context = {});

/// Takes the part ids of the mesh as a person's patches (components of equal part id): labels each patch
/// with the axis nearest to its vector area and tells what is wrong with the patches: diagnose_layout
/// (patch_layout.h), and as a warning where patches that face opposite ways share a boundary. In the report
/// `charts` counts patches, and `corners` are vertices where at least three patches meet.
SegmentResult segment_from_patches(const TriangleMesh& mesh);

/// What complete_patches adds.
struct CompletedPatches {
    TriangleMesh mesh;          ///< the same triangles, each with a part id above 0
    std::size_t triangles = 0;  ///< that had no patch
    std::vector<int> parts;     ///< the new patches, ascending
};

/// Gives a patch to the triangles that have none, those with a part id of 0 or less; the others keep theirs.
/// The surface is labelled as a whole (`options`), and every connected region of such triangles with equal
/// label becomes a patch with a part id above all that are there. Throws as segment does.
CompletedPatches complete_patches(TriangleMesh mesh, const SegmentOptions& options = {},
                                  const Context& context = {});

/// The mesh with `part = label + 1` on each face: what `segment` writes.
TriangleMesh with_labels(TriangleMesh mesh, const Segmentation& segmentation);

/// The paper's three conditions for any labelling: validate_charts (charts.h) of its charts. Throws
/// Error{bad_input} when there is not one label 0..5 for each triangle.
Diagnostics validate_segmentation(const TriangleMesh& mesh, const Segmentation& segmentation);

}  // namespace hex
