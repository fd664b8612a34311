#include "segment/label_cut.h"

// GCC 12 sees edges of boost's list graph used before they are set; they are not.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <CGAL/boost/graph/alpha_expansion_graphcut.h>

#include <algorithm>

namespace hex {

std::vector<int> nearest_labels(const LabelSurface& surface) {
    std::vector<int> labels(surface.size());
    for (std::size_t t = 0; t < labels.size(); ++t) {
        int best = 0;
        for (int label = 1; label < 6; ++label) {
            if (surface.cosine(static_cast<int>(t), label) > surface.cosine(static_cast<int>(t), best))
                best = label;
        }
        labels[t] = best;
    }
    return labels;
}

std::vector<int> cut_labels(const LabelSurface& surface, double compactness) {
    const std::vector<int> start = nearest_labels(surface);
    std::vector<std::size_t> labels(start.begin(), start.end());
    std::vector<std::pair<std::size_t, std::size_t>> edges;
    std::vector<double> weights;
    edges.reserve(surface.edges.size());
    weights.reserve(surface.edges.size());
    for (const LabelEdge& edge : surface.edges) {
        edges.emplace_back(edge.triangles[0], edge.triangles[1]);
        weights.push_back(compactness * edge.weight);
    }
    std::vector<std::vector<double>> costs(6, std::vector<double>(surface.size()));
    for (std::size_t label = 0; label < 6; ++label) {
        for (std::size_t t = 0; t < surface.size(); ++t) costs[label][t] = surface.costs[t][label];
    }
    CGAL::alpha_expansion_graphcut(edges, weights, costs, labels,
                                   CGAL::Alpha_expansion_boost_adjacency_list_tag());
    return {labels.begin(), labels.end()};
}

}  // namespace hex

#pragma GCC diagnostic pop
