/// \file topology.h
/// What can be derived from a HexMesh: boundary quads, unique edges with their cell fans, vertex stars. Plain
/// values, computed when asked for, in parallel where it pays; identical for any number of threads.
#pragma once

#include <hex/volume/hex_mesh.h>

namespace hex {

/// Rows of varying length in one array (compressed rows).
template <class T>
struct CompressedRows {
    std::vector<std::size_t> offsets = {0};  ///< where each row starts in `values`, and the end
    std::vector<T> values;                   ///< row after row

    /// Number of rows.
    std::size_t size() const { return offsets.size() - 1; }
    /// A row, which must exist; it may be empty.
    std::span<const T> operator[](std::size_t row) const {
        return {values.data() + offsets[row], offsets[row + 1] - offsets[row]};
    }
};

/// Cells around each vertex, ascending.
CompressedRows<CellId> vertex_cells(const HexMesh& mesh);

/// The boundary as a quad mesh, in the order of its half-faces (cell, then local face).
struct BoundaryQuads {
    std::vector<HalfFaceId> half_faces;             ///< of quad q
    std::vector<std::array<VertexId, 4>> vertices;  ///< of quad q, counter-clockwise seen from outside
    std::vector<QuadId> quad_of_half_face;          ///< none for interior half-faces
    std::vector<VertexId> boundary_vertices;        ///< ascending
    std::vector<char> on_boundary;                  ///< one flag a mesh vertex
    CompressedRows<QuadId> vertex_quads;  ///< quads around each mesh vertex, ascending; empty rows inside

    /// Number of boundary quads.
    std::size_t size() const { return vertices.size(); }
    /// The vertex lies on the boundary.
    bool contains(VertexId v) const { return on_boundary[v.index()] != 0; }
};

/// The boundary of a mesh. Linear in the number of its half-faces.
BoundaryQuads boundary_quads(const HexMesh& mesh);

/// The unique edges. Edges are ordered by their smaller, then larger vertex.
struct EdgeTable {
    std::vector<std::array<VertexId, 2>> vertices;  ///< of edge e, smaller id first
    std::vector<std::array<EdgeId, 12>>
        cell_edges;                       ///< of each cell, in the local order of hexahedron::edge_corners
    CompressedRows<CellId> cells;         ///< cells around each edge, ascending; their number is the valence
    std::vector<char> boundary;           ///< the edge lies on a boundary face
    CompressedRows<EdgeId> vertex_edges;  ///< edges around each vertex, ascending

    /// Number of edges.
    std::size_t size() const { return vertices.size(); }
    /// Interior and not shared by exactly four cells: an extraordinary edge.
    bool is_extraordinary(EdgeId e) const { return !boundary[e.index()] && cells[e.index()].size() != 4; }
    /// The end of an edge that is not v, which must be the other one.
    VertexId other(EdgeId e, VertexId v) const {
        const auto& ends = vertices[e.index()];
        return ends[0] == v ? ends[1] : ends[0];
    }
    /// The edge between two vertices, or none. Linear in the number of edges at `a`.
    EdgeId find(VertexId a, VertexId b) const;
};

/// The edges of all cells of a mesh; vertices that no cell uses have none.
EdgeTable edge_table(const HexMesh& mesh);

/// Problems that the constructor of HexMesh lets pass: boundary edges with more than two boundary quads,
/// vertices whose cells do not hang together through faces, unused vertices, several components.
Diagnostics inspect(const HexMesh& mesh);

}  // namespace hex
