/// \file hex_mesh.h
/// The hexahedral half-face mesh of the volume stages.
#pragma once

#include <hex/base/diagnostics.h>
#include <hex/base/ids.h>
#include <hex/base/linear_algebra.h>
#include <hex/volume/hexahedron.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hex {

/// The eight vertices of a hexahedron in VTK_HEXAHEDRON order (hexahedron.h).
using HexCell = std::array<VertexId, 8>;

/// All-hexahedral mesh with half-face connectivity.
///
/// Cells are in VTK_HEXAHEDRON corner order (hexahedron.h). Half-face h = 6 * cell + local face; `twin(h)` is
/// the half-face of the neighbouring cell, or none on the boundary. The topology is fixed once built;
/// positions and part ids can be changed. Vertex and cell indices are those given to the constructor, unused
/// vertices included.
///
/// Building is parallel, linear in the number of cells, and gives the same structure for any number of
/// threads. It throws Error{bad_input}, naming cells (0-based), for: a vertex index out of range, a cell with
/// a repeated vertex, a cell twice, a face shared by more than two cells, two neighbours that see their
/// shared face with the same orientation, positions that are not finite, a number of part ids that is not
/// that of the cells; and Error{unsupported} for more cells than 32-bit half-face ids can number.
class HexMesh {
  public:
    /// A mesh without vertices and cells.
    HexMesh() = default;
    /// Builds the connectivity. `parts` has one part id a cell, or is empty. Throws as the class says.
    HexMesh(std::vector<Vec3> positions, std::vector<HexCell> cells, std::vector<int> parts = {});

    /// Number of vertices, unused ones included.
    std::size_t vertex_count() const { return positions_.size(); }
    /// Number of hexahedra.
    std::size_t cell_count() const { return cells_.size(); }
    /// Six a cell.
    std::size_t half_face_count() const { return 6 * cells_.size(); }
    /// It has no cells; there may be vertices.
    bool empty() const { return cells_.empty(); }

    /// Ids of all vertices in ascending order, for range-based for loops.
    auto vertices() const { return IdRange<VertexId>(vertex_count()); }
    /// Ids of all cells, in the same way.
    auto cells() const { return IdRange<CellId>(cell_count()); }
    /// Ids of all half-faces, in the same way.
    auto half_faces() const { return IdRange<HalfFaceId>(half_face_count()); }

    /// Position of a vertex, in the unit of the input.
    const Vec3& position(VertexId v) const { return positions_[v.index()]; }
    /// Moves a vertex. Different vertices may be moved by different threads.
    void set_position(VertexId v, const Vec3& p) { positions_[v.index()] = p; }
    /// All positions, by vertex id.
    std::span<const Vec3> positions() const { return positions_; }
    /// Replaces all positions. Throws Error{usage} when the count is not the same.
    void set_positions(std::vector<Vec3> positions);

    /// The eight vertices of a cell.
    const HexCell& cell(CellId c) const { return cells_[c.index()]; }
    /// All cells, by cell id.
    std::span<const HexCell> cell_array() const { return cells_; }
    /// The vertex at a corner 0..7 of a cell.
    VertexId corner(CellId c, int local) const { return cells_[c.index()][static_cast<std::size_t>(local)]; }
    /// The eight corner positions of a cell.
    std::array<Vec3, 8> corner_positions(CellId c) const;

    /// Part id of a cell; 1 unless given.
    int part(CellId c) const { return parts_.empty() ? 1 : parts_[c.index()]; }
    /// One part id a cell, or empty.
    std::span<const int> parts() const { return parts_; }

    /// The half-face of a cell at its local face 0..5 (hexahedron.h).
    static HalfFaceId half_face(CellId c, int local_face) {
        return HalfFaceId(6 * c.index() + static_cast<std::size_t>(local_face));
    }
    /// The cell that a half-face belongs to.
    static CellId cell_of(HalfFaceId h) { return CellId(h.index() / 6); }
    /// The local face 0..5 that a half-face is in its cell.
    static int local_face(HalfFaceId h) { return static_cast<int>(h.index() % 6); }
    /// The same face seen from the neighbouring cell; none on the boundary.
    HalfFaceId twin(HalfFaceId h) const { return twins_[h.index()]; }
    /// There is no cell on the other side.
    bool is_boundary(HalfFaceId h) const { return !twins_[h.index()].valid(); }
    /// The neighbour of a cell across a local face, or none.
    CellId neighbour(CellId c, int local_face) const {
        const HalfFaceId t = twin(half_face(c, local_face));
        return t.valid() ? cell_of(t) : CellId();
    }
    /// The four vertices of a half-face, counter-clockwise seen from outside its cell.
    std::array<VertexId, 4> face_vertices(HalfFaceId h) const;

  private:
    std::vector<Vec3> positions_;
    std::vector<HexCell> cells_;
    std::vector<int> parts_;
    std::vector<HalfFaceId> twins_;
};

/// Bounding box of the vertices that a cell uses.
BoundingBox bounding_box(const HexMesh& mesh);

}  // namespace hex
