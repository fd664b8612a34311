#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/polycube/polycube.h>

#include <algorithm>
#include <string>

namespace hex {

Registry<PolycubeBuilder>& polycube_builders() {
    static Registry<PolycubeBuilder> registry("polycube");
    return registry;
}

PolycubeResult polycube(const TriangleMesh& mesh, const PolycubeOptions& options, const Context& context) {
    const auto method = polycube_builders().make(options.method);
    if (mesh.n_faces() == 0) throw Error(ErrorKind::bad_input, "the surface has no triangles");
    return with_threads(context, [&] {
        PolycubeResult result = method->build(mesh, options, context);
        result.report.method = options.method;
        const auto& patches = result.polycube.layout.patches;
        result.report.patches = patches.size();
        result.report.corners = result.polycube.corners.size();
        result.report.invalid_patches = static_cast<std::size_t>(std::count_if(
            patches.begin(), patches.end(), [](const Patch& patch) { return !patch.four_sided; }));
        return result;
    });
}

PolygonSoup polycube_surface(const Polycube& polycube) {
    PolygonSoup soup;
    soup.points = polycube.corner_points;
    for (std::size_t p = 0; p < polycube.quads.size(); ++p) {
        std::array<std::uint32_t, 4> quad{};
        for (std::size_t k = 0; k < 4; ++k) {
            const int corner = polycube.quads[p][k];
            const auto found = std::lower_bound(polycube.corners.begin(), polycube.corners.end(), corner);
            if (found == polycube.corners.end() || *found != corner)
                throw Error(ErrorKind::no_result, "patch " + std::to_string(p) + " is not four-sided", {},
                            "cut the surface into patches with four corners each");
            quad[k] = static_cast<std::uint32_t>(found - polycube.corners.begin());
        }
        soup.add_polygon(quad, static_cast<int>(p) + 1);
    }
    return soup;
}

}  // namespace hex
