/// \file surface_features.h
/// Sharp features of a mesh that something else than its own angles decides: the parts it is made of, the
/// patches of the part's surface, the sharp edges of the part's surface or CAD model.
///
/// The results are edges of the mesh's boundary by their two vertices, the smaller first, ascending: for
/// SplineOptions::feature_edges.
#pragma once

#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace spline {

/// An edge of a mesh by its two vertices, 0-based.
using VertexPair = std::array<std::int64_t, 2>;
/// The two ends of a straight piece of a sharp edge.
using Segment = std::array<hex::Vec3, 2>;

/// Edges between boundary quads of elements of different parts (HexMesh::part).
std::vector<VertexPair> edges_between_parts(const hex::HexMesh& mesh);

/// Edges between boundary quads that lie on different parts of the surface. A quad lies where most of nine
/// points of it have their closest triangle, of equally many on the part of the smaller number.
std::vector<VertexPair> edges_between_patches(const hex::HexMesh& mesh, const hex::TriangleMesh& surface);

/// Edges of a surface whose triangles' normals have a cosine below `cosine`; fewer than six that hang
/// together and have an open end are noise and left out. Where such edges meet at a corner, or bend there,
/// also chains of weaker edges (below 0.94) from one corner to another: a part's edges seldom have one angle
/// all along.
std::vector<Segment> sharp_segments(const hex::TriangleMesh& surface, double cosine);

/// Edges that run along the segments: five points of the edge are within a quarter of its length, and of the
/// width of its boundary quads, of a segment, and the three in the middle of one with nearly its direction.
std::vector<VertexPair> edges_along(const hex::HexMesh& mesh, std::span<const Segment> segments);

}  // namespace spline
