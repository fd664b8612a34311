/// \file boundary_guide.h
/// The one projection service: what part of the surface each boundary vertex belongs to, and the closest
/// point on exactly that part.
#pragma once

#include "improve/surface_curves.h"
#include "surface/search_set.h"

#include <memory>
#include <optional>

namespace hex::improving {

/// How a vertex may move.
enum class Freedom : std::uint8_t {
    interior,  ///< anywhere
    region,    ///< on a smooth region of the surface
    curve,     ///< along a sharp curve
    corner,    ///< not at all: on a corner of the sharp curves
};

/// Sharp curves of the surface (surface_curves.h) are matched with paths of boundary edges of the mesh: a
/// path of least length, along which distance to the curve costs, between the vertices nearest to the curve's
/// ends. A curve that no path follows closely is no constraint. Matched paths cut the boundary quads, and
/// matched curves the triangles, into regions; each piece of the boundary belongs to the region where most of
/// its quads are. Vertices slide across everything else: patch borders that are not sharp hold nobody back.
///
/// Guarantee: every boundary vertex has exactly one part; queries are thread-safe and do not depend on the
/// number of threads. Closest points come from a CGAL AABB tree per part.
class BoundaryGuide {
  public:
    BoundaryGuide(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                  GuideSurface surface, const CurveOptions& options);
    ~BoundaryGuide();
    BoundaryGuide(const BoundaryGuide&) = delete;
    BoundaryGuide& operator=(const BoundaryGuide&) = delete;

    Freedom freedom(VertexId v) const { return freedom_[v.index()]; }
    /// Number of the region, curve or corner that a boundary vertex belongs to.
    std::uint32_t part(VertexId v) const { return part_[v.index()]; }

    /// A point of a part.
    struct Place {
        Vec3 point;
        Vec3 axis;           ///< unit normal of a region, unit direction of a curve; zero for a corner
        std::uint32_t item;  ///< triangle or segment of the part: where the next search may start
    };

    /// Closest point on the part of a boundary vertex. \param hint `item` of an earlier answer for it.
    Place nearest(VertexId v, const Vec3& p, std::optional<std::uint32_t> hint = {},
                  TriangleSearch::Memory* memory = nullptr) const;
    /// The same, but curves are finer polylines through smooth stand-ins of the surface's: three vertices on
    /// one segment, where a corner of an element has no volume, are a trap for a minimiser. A point of a
    /// segment is moved halfway to its mean projection onto the tangents at the segment's ends, as in Phong
    /// tessellation (Boubekeur and Alexa 2008; the factor 1/2 is the one that reproduces circles). Hints are
    /// not those of `nearest`.
    Place nearest_smooth(VertexId v, const Vec3& p, std::optional<std::uint32_t> hint = {},
                         TriangleSearch::Memory* memory = nullptr) const;
    /// The two ends of the segment of a curve that `item` of `nearest` numbers: where the curve has its
    /// kinks.
    std::array<Vec3, 2> segment(VertexId v, std::uint32_t item) const;

    const GuideSurface& surface() const;
    /// Vertices of the surface at the ends of each edge of its sharp curves, ascending.
    std::vector<std::array<std::int64_t, 2>> curve_edges() const;
    /// Length of the surface's diagonal.
    double diagonal() const;
    std::size_t curve_count() const { return curve_count_; }
    std::size_t matched_curve_count() const { return matched_count_; }
    /// Edges of the mesh that stand for sharp curves; one flag an edge of the EdgeTable.
    const std::vector<char>& feature_edges() const { return feature_edge_; }

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
    std::vector<Freedom> freedom_;
    std::vector<std::uint32_t> part_;  // region, curve or corner of each vertex
    std::vector<char> feature_edge_;
    std::size_t curve_count_ = 0;
    std::size_t matched_count_ = 0;
};

}  // namespace hex::improving
