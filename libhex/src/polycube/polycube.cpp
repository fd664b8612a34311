#include <hex/base/error.h>
#include <hex/base/method_call.h>
#include <hex/base/parallel.h>
#include <hex/polycube/polycube.h>

#include <algorithm>
#include <string>

namespace hex {
namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ErrorKind::bad_input, what);
}

/// Throws Error{bad_input} for patches that are not those of the surface.
void require_layout(const PatchLayout& layout, const TriangleMesh& mesh) {
    const auto triangles = static_cast<int>(mesh.n_faces()), vertices = static_cast<int>(mesh.n_vertices());
    const auto patches = static_cast<int>(layout.patches.size());
    if (patches == 0) refuse("it has no patches");
    if (layout.patch_of_triangle.size() != mesh.n_faces())
        refuse(std::to_string(layout.patch_of_triangle.size()) + " triangles have a patch, of " +
               std::to_string(triangles));
    for (const int p : layout.patch_of_triangle)
        if (p < 0 || p >= patches)
            refuse("a triangle is in patch " + std::to_string(p) + " of " + std::to_string(patches));
    const auto require_vertex = [&](int v) {
        if (v < 0 || v >= vertices)
            refuse("a patch has vertex " + std::to_string(v) + " of " + std::to_string(vertices));
    };
    for (const Patch& patch : layout.patches) {
        for (const int t : patch.triangles)
            if (t < 0 || t >= triangles)
                refuse("a patch has triangle " + std::to_string(t) + " of " + std::to_string(triangles));
        for (const auto& loop : patch.loops)
            for (const Chain& chain : loop) std::for_each(chain.begin(), chain.end(), require_vertex);
        if (patch.four_sided) std::for_each(patch.corners.begin(), patch.corners.end(), require_vertex);
    }
}

/// Throws Error{bad_input} for corners, quads and edges that do not belong together.
void require_polycube(const Polycube& cube, const TriangleMesh& mesh) {
    require_layout(cube.layout, mesh);
    const auto vertices = static_cast<int>(mesh.n_vertices());
    const auto patches = cube.layout.patches.size();
    if (cube.corner_points.size() != cube.corners.size())
        refuse(std::to_string(cube.corners.size()) + " corners with " +
               std::to_string(cube.corner_points.size()) + " points");
    for (std::size_t i = 0; i < cube.corners.size(); ++i) {
        const int corner = cube.corners[i];
        if (corner < 0 || corner >= vertices)
            refuse("corner " + std::to_string(corner) + " is no vertex of " + std::to_string(vertices));
        if (i > 0 && corner <= cube.corners[i - 1]) refuse("its corners are not in ascending order");
        if (!cube.corner_points[i].allFinite())
            refuse("corner " + std::to_string(corner) + " has a coordinate that is not finite");
    }
    if (cube.quads.size() != patches || cube.edges.size() != 4 * patches)
        refuse(std::to_string(cube.quads.size()) + " quads with " + std::to_string(cube.edges.size()) +
               " edges for " + std::to_string(patches) + " patches");
    // -1 stands for what a patch that is not four-sided does not have.
    const auto is_corner = [&](int v) {
        return v == -1 || std::binary_search(cube.corners.begin(), cube.corners.end(), v);
    };
    for (const auto& quad : cube.quads)
        if (!std::all_of(quad.begin(), quad.end(), is_corner))
            refuse("a quad has a vertex that is no corner");
    for (const auto& edge : cube.edges)
        if (!std::all_of(edge.begin(), edge.end(), is_corner))
            refuse("an edge has a vertex that is no corner");
}

}  // namespace

Registry<PolycubeBuilder>& polycube_builders() {
    static Registry<PolycubeBuilder> registry("polycube");
    return registry;
}

PolycubeResult polycube(const TriangleMesh& mesh, const PolycubeOptions& options, const Context& context) {
    const MethodCall<PolycubeBuilder> method(polycube_builders(), options.method);
    if (mesh.n_faces() == 0) throw Error(ErrorKind::bad_input, "the surface has no triangles");
    return with_threads(context, [&] {
        PolycubeResult result =
            method([&](const PolycubeBuilder& builder) { return builder.build(mesh, options, context); });
        // With violations, there need not be more than these.
        if (count_at_least(result.report.violations, Severity::error) == 0)
            method.require("polycube", [&] { require_polycube(result.polycube, mesh); });
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
