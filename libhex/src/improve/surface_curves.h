/// \file surface_curves.h
/// The sharp curves of a surface, as cleaned polylines between corners.
#pragma once

#include <hex/surface/mesh_types.h>
#include <hex/volume/topology.h>

#include <array>
#include <cstdint>
#include <vector>

namespace hex::improving {

/// A triangle surface with what is known of its edges. Triangles without area are left out.
struct GuideSurface {
    struct Edge {
        std::array<std::uint32_t, 2> vertices;
        std::array<std::int64_t, 2> triangles;  ///< -1: none
        double cosine;  ///< of the angle between the normals; -1 unless exactly two triangles meet
    };
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3> normals;  ///< unit, one a triangle
    std::vector<Edge> edges;    ///< those between two triangles of one quad are not listed as sharp: cosine 1
    double diagonal = 0.0;
};

GuideSurface make_guide_surface(const TriangleMesh& mesh);
/// The boundary of a hexahedral mesh; every quad is cut along its first diagonal, which counts as flat.
/// Normals of its edges' angles are those of the quads. With `listed` (one flag a vertex) an edge is sharp
/// when both its ends are listed, whatever its angle.
GuideSurface make_guide_surface(const HexMesh& mesh, const BoundaryQuads& boundary,
                                const std::vector<char>& listed = {});

/// From now on exactly these edges, given by their vertices, are sharp. Throws Error{bad_input} for a pair
/// that is no edge.
void set_sharp_edges(GuideSurface& surface, std::vector<std::array<std::int64_t, 2>> edges);

/// A run of sharp edges between two corners, or a closed one.
struct SurfaceCurve {
    std::vector<std::uint32_t> vertices;  ///< in order; first == last if closed
    std::vector<std::uint32_t> edges;     ///< edges[i] joins vertices[i] and vertices[i + 1]
    double mean_cosine = 1.0;             ///< of the angles along it, weighted by length
    bool closed() const { return vertices.front() == vertices.back(); }
};

/// Cosines of the angles between normals.
struct CurveOptions {
    double sharp_cosine = 0.8;  ///< below: a sharp edge
    /// Below: an edge that may close a gap between sharp ones, or join an open end to them.
    double weak_cosine = 0.94;
    /// Curves with an open end that are shorter, in shares of the diagonal, are no features.
    double shortest_open = 0.1;
    /// Nor are those with an open end whose mean cosine is not below this: creases that fade out.
    double strong_cosine = 0.5;
    /// Nor are connected curves with fewer edges in all: specks.
    std::size_t fewest_edges = 6;
    /// Cosine of the angle between consecutive edges below which a curve has a corner.
    double bend_cosine = 0.7;
};

/// Sharp edges, with gaps closed along weak edges, without short dangling pieces, cut at corners: vertices
/// where not exactly two sharp edges meet, or where a curve bends. In the order of their first edge.
std::vector<SurfaceCurve> find_surface_curves(const GuideSurface& surface, const CurveOptions& options);

}  // namespace hex::improving
