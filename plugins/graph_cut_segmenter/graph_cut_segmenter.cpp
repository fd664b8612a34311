/// \file graph_cut_segmenter.cpp
/// Labels by a graph cut: the axis near to each triangle's normal, and short boundaries between labels, at
/// creases rather than across flat regions. Minimizes, by alpha expansion (Boykov, Veksler, Zabih 2001, as
/// CGAL has it),
///
///     sum over triangles of area (1 - cosine between normal and axis)
///     + weight * sum over edges between different labels of length * size * exp(-(1 - cosine of the normals)
///     / 0.1)
///
/// with the areas as shares of the whole and the mean size of a triangle as the unit of length. The weight is
/// `-l`, the one of the boundary term.
///
///     hexspline segment -i part.stl -o part_segment.k --method graph-cut -l 0.5 --plugin
///     graph_cut_segmenter.so

#include <hex/base/parallel.h>
#include <hex/base/plugin.h>
#include <hex/segment/segment.h>

// GCC 12 sees edges of boost's list graph used before they are set; they are not.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <CGAL/boost/graph/alpha_expansion_graphcut.h>

#include <cmath>

namespace {

/// Twice the area times the unit normal of every triangle.
std::vector<hex::Vec3> area_vectors(const hex::TriangleMesh& mesh) {
    std::vector<hex::Vec3> vectors(mesh.n_faces());
    hex::parallel_for(mesh.n_faces(), [&](std::size_t f) {
        std::array<hex::Vec3, 3> corners;
        std::size_t i = 0;
        for (const auto v : mesh.fv_range(mesh.face_handle(static_cast<unsigned>(f))))
            corners[i++] = hex::to_eigen(mesh.point(v));
        const hex::Vec3 along = corners[1] - corners[0], across = corners[2] - corners[0];
        vectors[f] = along.cross(across);
    });
    return vectors;
}

/// Zero for a triangle without area, which then has no say.
hex::Vec3 unit(const hex::Vec3& vector) {
    const double length = vector.norm();
    if (length > 0.0) return vector / length;
    return hex::Vec3::Zero();
}

class GraphCutSegmenter : public hex::Segmenter {
  public:
    hex::SegmentResult segment(const hex::TriangleMesh& mesh, const hex::SegmentOptions& options,
                               const hex::Context& context) const override {
        return hex::with_threads(context, [&] { return label(mesh, options.boundary_weight, context); });
    }

  private:
    static hex::SegmentResult label(const hex::TriangleMesh& mesh, double weight,
                                    const hex::Context& context) {
        const std::vector<hex::Vec3> vectors = area_vectors(mesh);
        const auto count = static_cast<double>(vectors.size());
        double whole = 0.0;
        for (const hex::Vec3& vector : vectors) whole += vector.norm();
        const double size = std::sqrt(whole / 2.0 / count);

        std::vector<std::vector<double>> costs(6, std::vector<double>(vectors.size()));
        std::vector<std::size_t> labels(vectors.size());
        for (std::size_t f = 0; f < vectors.size(); ++f) {
            const hex::Vec3 normal = unit(vectors[f]);
            for (std::size_t k = 0; k < 6; ++k) {
                const double cosine = normal.dot(hex::label_axis(static_cast<int>(k)));
                costs[k][f] = count * vectors[f].norm() / whole * (1.0 - cosine);
                if (costs[k][f] < costs[labels[f]][f]) labels[f] = k;
            }
        }

        std::vector<std::pair<std::size_t, std::size_t>> edges;
        std::vector<double> weights;
        for (const auto edge : mesh.edges()) {
            const auto side = mesh.halfedge_handle(edge, 0);
            const auto here = static_cast<std::size_t>(mesh.face_handle(side).idx());
            const auto there = static_cast<std::size_t>(mesh.opposite_face_handle(side).idx());
            const double bend = 1.0 - unit(vectors[here]).dot(unit(vectors[there]));
            edges.emplace_back(here, there);
            weights.push_back(weight * mesh.calc_edge_length(edge) / size * std::exp(-bend / 0.1));
        }
        context.check_cancelled();
        CGAL::alpha_expansion_graphcut(edges, weights, costs, labels,
                                       CGAL::Alpha_expansion_boost_adjacency_list_tag());
        hex::SegmentResult result;
        result.segmentation.labels.assign(labels.begin(), labels.end());
        return result;
    }
};

void register_methods() {
    hex::segmenters().add("graph-cut", "normals against the length of boundaries, by CGAL's graph cut",
                          [] { return std::make_unique<GraphCutSegmenter>(); });
}

}  // namespace

HEX_PLUGIN("graph-cut-segmenter", "1.0", register_methods)

#pragma GCC diagnostic pop
