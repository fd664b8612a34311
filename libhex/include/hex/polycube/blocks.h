/// \file blocks.h
/// From a labelled surface to a polycube in the integers, its blocks, and the surface cut into their
/// four-sided patches.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/segment/segment.h>
#include <hex/surface/mesh_types.h>
#include <hex/volume/hex_mesh.h>

#include <vector>

namespace hex {

/// How coarse the integer polycube is.
struct BlocksOptions {
    /// Length in space of one unit of the integer polycube, > 0; charts closer than about half of it may come
    /// to lie in one plane. 0: the edge of a cube with 1/1500 of the volume of all bodies.
    double unit = 0.0;
};

/// How blocks came about. Numbers are of all bodies together unless their line says otherwise, and 0
/// where an error came first.
struct BlocksReport {
    std::size_t bodies = 0;         ///< outer shells, each with its voids, which have a polycube each
    std::size_t turned_shells = 0;  ///< outer shells oriented inwards and voids oriented outwards
    std::size_t charts = 0;         ///< components of equal label
    std::size_t sides = 0;          ///< edges of the polycube
    std::size_t corners = 0;        ///< of the polycube
    std::size_t orders = 0;         ///< order constraints between charts that were kept
    std::size_t turned_sides = 0;   ///< sides whose direction had to differ from that in space
    std::size_t rounds = 0;         ///< integer programs solved until no charts overlapped; most of any body
    std::array<std::size_t, 3> planes = {0, 0, 0};  ///< of charts, along x, y, z, of all bodies
    std::size_t cells = 0;                          ///< between those planes, inside
    std::size_t blocks = 0;            ///< hexahedra of the block structures of bodies without an error
    std::size_t patches = 0;           ///< four-sided ones, one a boundary quad of these blocks
    std::size_t cut_alone = 0;         ///< block lines that needed a map of their own (chart_cutter.h)
    std::size_t slides = 0;            ///< moves of block vertices on the surface to mend inverted blocks
    double unit = 0.0;                 ///< length of one unit of the integer polycubes that was used
    double min_scaled_jacobian = 0.0;  ///< of the blocks, at their corners
    std::size_t inverted_corners = 0;  ///< of the blocks, determinant not above zero
    /// Errors leave the result's `patches` and `blocks` empty; entity "chart" = component of equal label, in
    /// the order of first triangles: `chart-without-corners`, `opposite-labels-adjacent`, `side-without-end`,
    /// `chart-touches-itself`; `infeasible-orders`, the charts of a cycle in which each would have to lie
    /// below the next; `charts-overlap`, charts that cannot both lie where they have to. Warning
    /// `inverted-block`: blocks.
    Diagnostics violations;
};

/// Blocks and patches that belong together.
struct BlocksResult {
    /// The surface, with triangles split along block lines; part = patch + 1.
    TriangleMesh patches;
    /// One boundary quad a patch, on the patch's four corners, which are vertices of `patches`.
    HexMesh blocks;
    BlocksReport report;  ///< of both; its violations tell when there are none
};

/// Makes the blocks of a labelled closed surface. Each body, an outer shell with the voids right inside it,
/// has a polycube of its own, so bodies may be as near to each other as they like, or overlap. Nesting tells
/// what is a void; shells that are oriented the other way are turned in the patches. For each body:
/// 1. every chart gets one integer coordinate along its axis. The ends of every side of the polycube keep
/// their order in
///    space, and so do charts that see each other along their axis, as far as that closes no cycle; the sum
///    of |difference - length / unit| is least (an integer program);
/// 2. the grid of the charts' planes is filled and joined to blocks: walls continue the charts from every
/// concave edge
///    straight through the inside, and nothing else parts two blocks;
/// 3. block lines are cut into the triangles of each chart, straight in a one-to-one map of it;
/// 4. inner block vertices are placed by averaging, then so that the worst block corner is best.
///
/// When there are no errors among the violations, boundary quads and patches correspond one-to-one (checked).
/// Does not throw for labellings that have no polycube; throws Error{bad_input} unless there is a label for
/// each triangle, Error{usage} for a unit out of range, and Error{no_result} when a step fails that should
/// not.
BlocksResult make_blocks(const TriangleMesh& mesh, const Segmentation& segmentation,
                         const BlocksOptions& options = {}, const Context& context = {});

/// The labels that the part ids (label + 1) of a mesh name; empty unless all are in 1..6 and every connected
/// region of one part faces, on the whole, the way of its label.
std::vector<int> labels_of_parts(const TriangleMesh& mesh);

}  // namespace hex
