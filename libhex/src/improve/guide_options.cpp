#include "improve/guide_options.h"

#include <hex/feature/feature_set.h>

#include <vector>

namespace hex::improving {

CurveOptions curve_options(const ImproveOptions& options) {
    CurveOptions curves;
    curves.sharp_cosine = options.feature_cosine;
    if (options.feature_edges.empty()) return curves;
    // What somebody listed is no accident.
    curves.sharp_cosine = 0.0;
    curves.fewest_edges = 1;
    curves.shortest_open = 0.0;
    return curves;
}

GuideSurface make_guide_surface(const HexMesh& mesh, const BoundaryQuads& boundary,
                                const ImproveOptions& options) {
    if (!options.feature_edges.empty()) {
        GuideSurface surface = options.surface != nullptr ? make_guide_surface(*options.surface)
                                                          : make_guide_surface(mesh, boundary);
        set_sharp_edges(surface, options.feature_edges);
        return surface;
    }
    if (options.surface != nullptr) return make_guide_surface(*options.surface);
    std::vector<char> listed;
    if (options.features == FeatureSource::list) listed = flags_of_sharp(mesh, options.feature_vertices);
    return make_guide_surface(mesh, boundary, listed);
}

}  // namespace hex::improving
