#include "improve/boundary_motion.h"

namespace hex::improving {
namespace {

/// A quad seen from one of its corners: area as half the sum of the cross products at that corner and at the
/// opposite one (paper, smoothing), unit normal at the corner, centre.
struct QuadAtCorner {
    double area = 0.0;
    Vec3 normal = Vec3::Zero();
    Vec3 centre = Vec3::Zero();
};

QuadAtCorner quad_at(const HexMesh& mesh, const std::array<VertexId, 4>& quad, VertexId v) {
    std::size_t corner = 0;
    while (quad[corner] != v) ++corner;
    const auto at = [&](std::size_t i) -> const Vec3& { return mesh.position(quad[(corner + i) % 4]); };
    const Vec3 here = (at(1) - at(0)).cross(at(3) - at(0));
    const Vec3 opposite = (at(3) - at(2)).cross(at(1) - at(2));
    QuadAtCorner result;
    result.area = 0.5 * (here.norm() + opposite.norm());
    const double length = here.norm();
    if (length > 0.0) result.normal = here / length;
    result.centre = 0.25 * (at(0) + at(1) + at(2) + at(3));
    return result;
}

}  // namespace

BoundaryMotion::BoundaryMotion(const HexMesh& mesh, const EdgeTable& edges, const BoundaryQuads& boundary,
                               const FeatureSet& features, const BoundaryGuide* guide)
    : mesh_(mesh),
      edges_(edges),
      boundary_(boundary),
      features_(features),
      guide_(guide),
      item_(guide == nullptr ? 0 : mesh.vertex_count()) {}

bool BoundaryMotion::is_fixed(VertexId v) const {
    if (features_.vertex[v.index()] == VertexFeature::corner) return true;
    return guide_ != nullptr && guide_->freedom(v) == Freedom::corner;
}

Vec3 BoundaryMotion::area_normal(VertexId v) const {
    Vec3 normal = Vec3::Zero();
    for (const QuadId q : boundary_.vertex_quads[v.index()]) {
        const QuadAtCorner quad = quad_at(mesh_, boundary_.vertices[q.index()], v);
        normal += quad.area * quad.normal;
    }
    return normal.normalized();
}

std::array<VertexId, 2> BoundaryMotion::crease_neighbours(VertexId v) const {
    std::array<VertexId, 2> neighbours;
    std::size_t count = 0;
    for (const EdgeId e : edges_.vertex_edges[v.index()]) {
        if (features_.sharp_edge[e.index()] && count < 2) neighbours[count++] = edges_.other(e, v);
    }
    return neighbours;
}

Vec3 BoundaryMotion::smoothing_displacement(VertexId v) const {
    const Vec3& here = mesh_.position(v);
    if (features_.vertex[v.index()] == VertexFeature::crease) {
        const auto [a, b] = crease_neighbours(v);
        const Vec3 to_a = mesh_.position(a) - here;
        const Vec3 to_b = mesh_.position(b) - here;
        const double length_a = to_a.norm();
        const double length_b = to_b.norm();
        if (!(length_a + length_b > 0.0)) return Vec3::Zero();
        return tangential(v, 0.5 * (length_a * to_a + length_b * to_b) / (length_a + length_b));
    }
    Vec3 centre = Vec3::Zero();
    double area = 0.0;
    for (const QuadId q : boundary_.vertex_quads[v.index()]) {
        const QuadAtCorner quad = quad_at(mesh_, boundary_.vertices[q.index()], v);
        centre += quad.area * (quad.centre - here);
        area += quad.area;
    }
    if (!(area > 0.0)) return Vec3::Zero();
    return tangential(v, centre / area);
}

Vec3 BoundaryMotion::tangential(VertexId v, const Vec3& displacement) const {
    switch (features_.vertex[v.index()]) {
        case VertexFeature::interior:
            return displacement;
        case VertexFeature::corner:
            return Vec3::Zero();
        case VertexFeature::smooth: {
            const Vec3 normal = area_normal(v);
            return displacement - displacement.dot(normal) * normal;
        }
        case VertexFeature::crease: {
            const auto [a, b] = crease_neighbours(v);
            // The length-weighted mean of the two edges' directions, both pointing from a to b.
            const Vec3 tangent = (mesh_.position(b) - mesh_.position(a)).normalized();
            return displacement.dot(tangent) * tangent;
        }
    }
    return Vec3::Zero();
}

Vec3 BoundaryMotion::constrained(VertexId v, const Vec3& p) {
    if (guide_ == nullptr) return p;
    const BoundaryGuide::Place place = guide_->nearest(v, p, item_[v.index()]);
    item_[v.index()] = place.item;
    return place.point;
}

}  // namespace hex::improving
