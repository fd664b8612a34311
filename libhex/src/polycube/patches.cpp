#include "polycube/neighbourhoods.h"

#include <hex/polycube/polycube.h>

#include <algorithm>
#include <utility>

namespace hex {
namespace {

/// Patches are the connected components of equal part id; corners are where at least three of them meet
/// (paper, polycube boundary surface construction algorithm).
class PatchPolycube final : public PolycubeBuilder {
  public:
    PolycubeResult build(const TriangleMesh& mesh, const PolycubeOptions&,
                         const Context& context) const override {
        PolycubeResult result;
        Polycube& cube = result.polycube;
        context.check_cancelled();
        context.progress("patches", 0.0);
        cube.layout = find_patches(mesh);
        cube.corners = cube.layout.corners;
        for (const int c : cube.corners)
            cube.corner_points.push_back(to_eigen(mesh.point(mesh.vertex_handle(static_cast<unsigned>(c)))));
        for (const Patch& patch : cube.layout.patches) add_quad(patch.corners, cube);

        auto& violations = result.report.violations;
        violations = diagnose_layout(cube.layout);
        for (auto& finding : diagnose_neighbourhoods(mesh, cube.layout))
            violations.push_back(std::move(finding));
        context.progress("patches", 1.0);
        return result;
    }

  private:
    static void add_quad(const std::array<int, 4>& c, Polycube& cube) {
        cube.quads.push_back(c);
        for (const auto& [a, b] :
             {std::pair(c[0], c[1]), std::pair(c[1], c[2]), std::pair(c[2], c[3]), std::pair(c[0], c[3])})
            cube.edges.push_back({std::min(a, b), std::max(a, b)});
    }
};

const Register<PolycubeBuilder, PatchPolycube> registered(
    polycube_builders(), "patches",
    "one quad for each connected patch of equal part id (the paper's method)");

}  // namespace
}  // namespace hex
