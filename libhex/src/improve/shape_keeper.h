/// \file shape_keeper.h
/// An energy that keeps the boundary of a mesh close to the surface between its vertices, and its edges close
/// to the sharp edges of the surface.
#pragma once

#include "improve/fidelity_meter.h"

#include <array>
#include <span>

namespace hex::improving {

/// Points of the surface where it is not flat, and on its sharp edges, each with the quads or the edges of
/// the mesh near it. With r the distance of such a point to the nearest of them, h the size of the quads and
/// L the limit of the distance, the energy is the sum of
///     w r^2 / h^2 + H max(0, (r / L)^2 - s)^2     for points of the surface,
///     w (sqrt(1 + (r / d)^2) - 1), d = h / 20     for points on sharp edges,
/// where the points of a quad or an edge share a weight w between them. The second form grows like r, so a
/// sharp edge that the mesh cannot follow does not outweigh those that it does. A minimum of smooth
/// functions, so its gradient is the one of the nearest (envelope theorem).
class ShapeKeeper {
  public:
    /// Keeps references to mesh topology. `positions` are where the mesh is as the surface wants it.
    ShapeKeeper(const EdgeTable& edges, const BoundaryQuads& boundary, const GuideSurface& surface,
                double sharp_cosine, std::span<const Vec3> positions);

    /// The largest distance wanted; none at first.
    void set_limit(double distance) { limit_ = distance; }
    /// Factor of everything, >= 0; 1 at first.
    void set_strength(double factor) { strength_ = factor; }
    double strength() const { return strength_; }

    /// Looks for the nearest quad and edge of each point, walking from the last ones. Between two calls only
    /// these and their neighbours count.
    void follow(std::span<const Vec3> positions);
    /// Value; the gradient is added to `gradient` unless that is null.
    double evaluate(std::span<const Vec3> positions, std::vector<Vec3>* gradient) const;
    /// The part of the value that depends on boundary vertex v, when it is at p. Thread-safe.
    double around(VertexId v, const Vec3& p, std::span<const Vec3> positions) const;
    /// Calls `visit` for every vertex whose position `around(v, ...)` reads; some more than once.
    template <class Visit>
    void visit_reach(VertexId v, const Visit& visit) const {
        for (const std::uint32_t i : points_at_[v.index()]) {
            if (points_[i].sharp) {
                for (const std::uint32_t e : near_edges_[points_[i].home])
                    for (const VertexId w : edges_.vertices[e]) visit(w);
            } else {
                for (const std::uint32_t q : near_quads_[points_[i].home])
                    for (const VertexId w : boundary_.vertices[q]) visit(w);
            }
        }
    }

  private:
    struct Point {
        Vec3 place;
        std::uint32_t home;  ///< quad or edge of the mesh
        double weight;
        double size;
        bool sharp;
    };
    /// The nearest point of the mesh as a combination of three of its vertices.
    struct Foot {
        std::array<VertexId, 3> vertices;
        std::array<double, 3> shares;
        Vec3 off;  ///< from it to the surface's point
        double squared = 0.0;
        std::uint32_t home = 0;
        /// No other quad or edge near the point is nearer than this, squared.
        double rival = 0.0;
    };
    template <class Positions>
    Foot foot(const Point& point, const Positions& at) const;
    /// The nearest point of one quad or edge.
    template <class Positions>
    Foot foot_on(const Point& point, std::uint32_t home, const Positions& at) const;
    /// Finds the feet of all points. Where the mesh has moved so little since quads and edges were last
    /// compared that the one which was nearest still is, only that one is looked at.
    void find_feet(std::span<const Vec3> positions) const;
    /// Cost, and its derivative for the squared distance.
    std::array<double, 2> cost(const Point& point, double squared) const;
    std::vector<double> quad_sizes(std::span<const Vec3> positions) const;
    void add_surface_points(const GuideSurface& surface, double spacing, std::span<const Vec3> positions);
    void add_sharp_points(const GuideSurface& surface, double sharp_cosine, std::span<const Vec3> positions);
    void share_weights(std::size_t first, std::size_t homes, double weight);

    const EdgeTable& edges_;
    const BoundaryQuads& boundary_;
    double limit_ = 0.0;
    double strength_ = 1.0;
    CompressedRows<std::uint32_t> near_quads_;            // of each quad: itself and those that share an edge
    std::vector<std::vector<std::uint32_t>> near_edges_;  // of each boundary edge, the same at vertices
    std::vector<Point> points_;
    CompressedRows<std::uint32_t> points_at_;  // whose feet may be at a vertex
    mutable std::vector<Foot> feet_;
    /// The mesh when all quads and edges were last compared; empty: never since `follow`. With each point the
    /// nearest then, and by how much it was.
    mutable std::vector<Vec3> compared_;
    mutable std::vector<std::uint32_t> nearest_;
    mutable std::vector<double> lead_;
    mutable std::vector<double> quad_move_;
};

}  // namespace hex::improving
