/// \file block_numbering.h
/// One global numbering of the nodes of a subdivided block structure. Every node belongs to exactly one block
/// vertex, edge, face or inside, so neighbouring blocks share nodes by index and nothing has to be merged.
#pragma once

#include <hex/volume/hex_mesh.h>
#include <hex/volume/topology.h>

#include <array>
#include <vector>

namespace hex {

/// Nodes of a block structure whose edge e is cut into `segments[e]` pieces. Nodes are numbered: used block
/// vertices, then the insides of edges, of faces, of blocks, each group in ascending order of its entity.
class BlockNumbering {
  public:
    /// A block face counted once, whether one or two blocks have it. Its frame: (s, t) = (0,0), (1,0), (1,1),
    /// (0,1) at the four vertices of `half_face`, in the order of HexMesh::face_vertices.
    struct Face {
        HalfFaceId half_face;  ///< the smaller of the two half-faces
        int segments_s = 0;    ///< pieces from (0,0) to (1,0)
        int segments_t = 0;    ///< pieces from (0,0) to (0,1)
    };

    /// `edges` must be edge_table(blocks), and `segments` (>= 1, one an edge) equal on opposite edges of
    /// every block face; throws Error{bad_input} naming the block otherwise, and Error{unsupported} when the
    /// mesh would have more cells or nodes than 32-bit ids can name. `blocks` and `edges` must outlive the
    /// numbering.
    BlockNumbering(const HexMesh& blocks, const EdgeTable& edges, std::vector<int> segments);

    /// Vertices of the subdivided structure.
    std::size_t node_count() const { return node_count_; }
    /// Hexahedra of the subdivided structure: the products of the pieces along each block, summed.
    std::size_t cell_count() const { return first_cell_.back(); }
    /// All faces, boundary or not, in the order of their smaller half-faces.
    const std::vector<Face>& faces() const { return faces_; }
    /// Pieces of an edge of the EdgeTable.
    int segments(EdgeId e) const { return segments_[e.index()]; }
    /// Pieces along the axes u, v, w of a block.
    std::array<int, 3> segments(CellId block) const;

    /// Node of a block vertex; none when no block uses it.
    VertexId corner_node(VertexId v) const { return corner_nodes_[v.index()]; }
    /// Nodes along an edge from its smaller to its larger vertex, both ends included.
    std::vector<VertexId> edge_nodes(EdgeId e) const;
    /// Nodes of `faces()[f]`, (segments_s + 1) x (segments_t + 1), s fastest.
    std::vector<VertexId> face_nodes(std::size_t f) const;
    /// Nodes of a block, (nu + 1) x (nv + 1) x (nw + 1), u fastest, then v.
    std::vector<VertexId> block_nodes(CellId block) const;

    /// The hexahedra of all blocks: block after block, u fastest, then v, each with the local axes of its
    /// block.
    std::vector<HexCell> cells() const;
    /// Index of the first hexahedron of a block in `cells()`.
    std::size_t first_cell(CellId block) const { return first_cell_[block.index()]; }

  private:
    const HexMesh* blocks_;
    const EdgeTable* edges_;
    std::vector<int> segments_;
    std::vector<Face> faces_;
    std::vector<std::size_t> face_of_half_face_;
    std::vector<VertexId> corner_nodes_;
    std::vector<std::size_t> first_edge_node_;
    std::vector<std::size_t> first_face_node_;
    std::vector<std::size_t> first_block_node_;
    std::vector<std::size_t> first_cell_;
    std::size_t node_count_ = 0;
};

}  // namespace hex
