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
    PatchLayout layout;               ///< the patches themselves
    std::vector<int> corners;         ///< ascending
    std::vector<Vec3> corner_points;  ///< of `corners`
    std::vector<std::array<int, 4>>
        quads;  ///< one a patch, c0..c3 counter-clockwise from outside; -1 when not four-sided
    /// For each patch its four edges (min, max) in the order c0c1, c1c2, c2c3, c0c3; shared edges appear
    /// twice.
    std::vector<std::array<int, 2>> edges;
};

/// By which method the patches are found.
struct PolycubeOptions {
    /// Name of the method in the registry: `patches` (patches are the components of equal part id) or a
    /// plug-in's.
    std::string method = "patches";
};

/// Counts of a polycube, and what is wrong with it.
struct PolycubeReport {
    std::string method;               ///< that was run
    std::size_t patches = 0;          ///< all of them
    std::size_t corners = 0;          ///< vertices that are corners of the polycube
    std::size_t invalid_patches = 0;  ///< patches that are not four-sided
    /// Severity error, entity "patch", vertex ids in the message: what diagnose_layout (patch_layout.h)
    /// finds, and forbidden neighbourhoods: `opposite-labels-adjacent` (asked only when the part ids are
    /// labels: all in 1..6, and every patch faces the way of its label), `patches-share-all-corners` (two
    /// patches on the same four corners) and `edge-not-unique` (different chains between the same two
    /// corners); block faces and edges are known by their corners and could not tell these apart.
    Diagnostics violations;
};

/// A polycube, and what there is to say of it.
struct PolycubeResult {
    Polycube polycube;      ///< may have quads of -1 when the report has violations
    PolycubeReport report;  ///< of it
};

/// Interface of a polycube method.
class PolycubeBuilder {
  public:
    virtual ~PolycubeBuilder() = default;
    /// Fills `polycube` and `report.violations`; the stage adds the rest of the report. Without an error
    /// among the violations, a polycube whose lists do not fit makes the stage throw Error{no_result}.
    virtual PolycubeResult build(const TriangleMesh& mesh, const PolycubeOptions& options,
                                 const Context& context) const = 0;
};

/// The methods of the stage by name, those of plug-ins included.
Registry<PolycubeBuilder>& polycube_builders();

/// Runs `options.method`. Does not throw on an invalid layout: `report.violations` tells, and the caller
/// decides. Throws Error{usage} for an unknown method, Error{bad_input} for a surface without triangles.
PolycubeResult polycube(const TriangleMesh& mesh, const PolycubeOptions& options = {},
                        const Context& context = {});

/// The polycube as a quad surface: the corners renumbered in ascending order, one quad a patch, part = patch
/// index + 1. Throws Error{no_result} when a patch is not four-sided.
PolygonSoup polycube_surface(const Polycube& polycube);

}  // namespace hex
