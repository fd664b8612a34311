#include "improve/guide_options.h"

#include <hex/base/error.h>

#include <string>
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
    if (options.features == FeatureSource::list) {
        listed.assign(mesh.vertex_count(), 0);
        for (const std::int64_t v : options.feature_vertices) {
            if (v < 0 || v >= static_cast<std::int64_t>(mesh.vertex_count()))
                throw Error(ErrorKind::bad_input, "sharp vertex " + std::to_string(v) + " does not exist", {},
                            "the mesh has " + std::to_string(mesh.vertex_count()) +
                                " vertices, counted from 0; give the ids of this mesh");
            listed[static_cast<std::size_t>(v)] = 1;
        }
    }
    return make_guide_surface(mesh, boundary, listed);
}

}  // namespace hex::improving
