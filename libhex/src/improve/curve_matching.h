/// \file curve_matching.h
/// Which boundary edges of a hexahedral mesh follow which sharp curves of a surface.
#pragma once

#include "improve/surface_curves.h"
#include "surface/search_set.h"

#include <memory>

namespace hex::improving {

/// For each curve the vertices of the mesh that follow it.
struct CurveMatches {
    /// From its first to its last point (first == last for a closed one); empty where no path of boundary
    /// edges stays close to the curve and is about as long.
    std::vector<std::vector<VertexId>> whole;
    /// Of a curve that is not followed as a whole: runs of edges that lie on it.
    std::vector<std::vector<std::vector<VertexId>>> parts;
};

/// No two paths share a vertex but at the ends of whole open curves.
CurveMatches match_curves(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                          const GuideSurface& surface, const std::vector<SurfaceCurve>& curves,
                          const std::vector<std::unique_ptr<SegmentSearch>>& searches);

}  // namespace hex::improving
