/// \file polycube.h
/// Stage `polycube`: from a surface cut into patches to the polycube's corners, edges and quads.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/base/registry.h>
#include <hex/surface/patch_layout.h>
#include <hex/surface/polygon_soup.h>

#include <array>
#include <string>
#include <vector>

namespace hex {

/// The polycube's surface. All indices are vertices of the triangle mesh.
struct Polycube {
    PatchLayout layout;
    std::vector<int> corners;         ///< ascending
    std::vector<Vec3> corner_points;  ///< of `corners`
    std::vector<std::array<int, 4>>
        quads;  ///< one a patch, c0..c3 counter-clockwise from outside; -1 when not four-sided
    /// For each patch its four edges (min, max) in the order c0c1, c1c2, c2c3, c0c3; shared edges appear
    /// twice.
    std::vector<std::array<int, 2>> edges;
};

struct PolycubeOptions {
    /// Name of the method in the registry: `patches` (patches are the components of equal part id) or a
    /// plug-in's.
    std::string method = "patches";
};

struct PolycubeReport {
    std::string method;
    std::size_t patches = 0;
    std::size_t corners = 0;
    std::size_t invalid_patches = 0;
    /// Severity error, entity "patch", vertex ids in the message: what diagnose_layout (patch_layout.h)
    /// finds, and forbidden neighbourhoods: `opposite-labels-adjacent` (asked only when the part ids are
    /// labels: all in 1..6, and every patch faces the way of its label), `patches-share-all-corners` (two
    /// patches on the same four corners) and `edge-not-unique` (different chains between the same two
    /// corners); block faces and edges are known by their corners and could not tell these apart.
    Diagnostics violations;
};

struct PolycubeResult {
    Polycube polycube;
    PolycubeReport report;
};

class PolycubeBuilder {
  public:
    virtual ~PolycubeBuilder() = default;
    virtual PolycubeResult build(const TriangleMesh& mesh, const PolycubeOptions& options,
                                 const Context& context) const = 0;
};

Registry<PolycubeBuilder>& polycube_builders();

/// Runs `options.method`. Does not throw on an invalid layout: `report.violations` tells, and the caller
/// decides.
PolycubeResult polycube(const TriangleMesh& mesh, const PolycubeOptions& options = {},
                        const Context& context = {});

/// The polycube as a quad surface: the corners renumbered in ascending order, one quad a patch, part = patch
/// index + 1.
PolygonSoup polycube_surface(const Polycube& polycube);

}  // namespace hex
