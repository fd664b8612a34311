/// The method `patchwise`: Yu, Wei, Li, Liu, He, Zhang: HexGen and Hex2Spline, section on parametric mapping,
/// with interpolations that do not depend on the axes where the paper relaxes and interpolates by
/// coordinates.

#include "map/harmonic_interior.h"

#include <hex/base/parallel.h>
#include <hex/map/block_match.h>
#include <hex/map/block_numbering.h>
#include <hex/map/block_sheets.h>
#include <hex/map/divisions.h>
#include <hex/map/linear_blend.h>
#include <hex/map/map.h>
#include <hex/map/patch_map.h>
#include <hex/map/transfinite.h>
#include <hex/surface/polygon_soup.h>

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>

namespace hex {
namespace {

std::vector<PatchMap> map_patches(const TriangleMesh& surface, const PatchLayout& layout,
                                  const Context& context) {
    std::vector<std::optional<PatchMap>> maps(layout.patches.size());
    std::vector<std::exception_ptr> failures(layout.patches.size());
    parallel_for(
        layout.patches.size(),
        [&](std::size_t p) {
            try {
                context.check_cancelled();
                maps[p].emplace(surface, layout.patches[p]);
            } catch (...) {
                failures[p] = std::current_exception();
            }
        },
        1);
    // The first patch that failed, not the first that happened to be met.
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
    std::vector<PatchMap> result;
    result.reserve(maps.size());
    for (std::optional<PatchMap>& map : maps) result.push_back(std::move(*map));
    return result;
}

void report_patches(const PatchLayout& layout, const std::vector<PatchMap>& maps, MapReport& report) {
    report.patches = maps.size();
    Diagnostic flipped{Severity::warning, "flipped-patch", {}, "patch", {}};
    for (std::size_t p = 0; p < maps.size(); ++p) {
        const PatchParameterization& flat = maps[p].parameterization();
        report.patch_maps.push_back({static_cast<int>(p), layout.patches[p].part, name_of(flat.weights),
                                     flat.flipped, flat.split_edges});
        if (flat.flipped > 0) flipped.ids.push_back(static_cast<std::int64_t>(p));
    }
    if (flipped.ids.empty()) return;
    flipped.message = fmt::format("flattened triangles are flipped in {} patches: {}", flipped.ids.size(),
                                  list_ids(flipped.ids));
    report.diagnostics.push_back(std::move(flipped));
}

/// Fills the positions of all nodes, entity after entity: block vertices, edges, faces, blocks.
class NodePlacer {
  public:
    NodePlacer(const TriangleMesh& surface, const HexMesh& blocks, const BoundaryQuads& quads,
               const EdgeTable& edges, const BlockMatch& match, const BlockNumbering& numbering,
               const std::vector<PatchMap>& maps, Interior interior)
        : surface_(surface),
          blocks_(blocks),
          quads_(quads),
          edges_(edges),
          match_(match),
          numbering_(numbering),
          maps_(maps),
          interior_(interior),
          positions_(numbering.node_count()) {}

    std::vector<Vec3> run(const Context& context) {
        for (const VertexId v : blocks_.vertices()) place_corner(v);
        parallel_for(
            edges_.size(), [this](std::size_t e) { place_edge(EdgeId(e)); }, 16);
        context.check_cancelled();
        context.progress("faces", 0.5);
        parallel_for(
            numbering_.faces().size(), [this](std::size_t f) { place_face(f); }, 4);
        context.check_cancelled();
        context.progress("blocks", 0.7);
        parallel_for(
            blocks_.cell_count(), [this](std::size_t b) { place_block(CellId(b)); }, 1);
        return std::move(positions_);
    }

  private:
    void place_corner(VertexId v) {
        const VertexId node = numbering_.corner_node(v);
        if (!node.valid()) return;
        const int on_surface = match_.surface_vertex[v.index()];
        positions_[node.index()] = on_surface < 0
                                       ? blocks_.position(v)
                                       : to_eigen(surface_.point(TriangleMesh::VertexHandle(on_surface)));
    }

    void place_edge(EdgeId e) {
        const std::vector<VertexId> nodes = numbering_.edge_nodes(e);
        const Chain& chain = match_.chain_of_edge[e.index()];
        // An edge inside is a chain of two points.
        const ChainCurve curve =
            chain.empty() ? ChainCurve({positions_[nodes.front().index()], positions_[nodes.back().index()]})
                          : ChainCurve(surface_, chain);
        const auto n = static_cast<double>(nodes.size() - 1);
        for (std::size_t i = 1; i + 1 < nodes.size(); ++i)
            positions_[nodes[i].index()] = curve.point(static_cast<double>(i) / n);
    }

    void place_face(std::size_t f) {
        const BlockNumbering::Face& face = numbering_.faces()[f];
        const std::vector<VertexId> nodes = numbering_.face_nodes(f);
        const int m = face.segments_s;
        const int n = face.segments_t;
        const auto node = [&](int s, int t) {
            return nodes[static_cast<std::size_t>(s) +
                         static_cast<std::size_t>(m + 1) * static_cast<std::size_t>(t)]
                .index();
        };
        const QuadId quad = quads_.quad_of_half_face[face.half_face.index()];
        if (quad.valid()) {
            for (int t = 1; t < n; ++t)
                for (int s = 1; s < m; ++s)
                    positions_[node(s, t)] =
                        patch_point(quad, static_cast<double>(s) / m, static_cast<double>(t) / n);
            return;
        }
        FaceGrid grid(m, n);
        for (int t = 0; t <= n; ++t)
            for (int s = 0; s <= m; ++s) grid(s, t) = positions_[node(s, t)];
        fill(grid);
        for (int t = 1; t < n; ++t)
            for (int s = 1; s < m; ++s) positions_[node(s, t)] = grid(s, t);
    }

    /// The harmonic interior starts from the transfinite one.
    template <class Grid>
    void fill(Grid& grid) const {
        if (interior_ == Interior::linear)
            blend_linearly(grid);
        else
            fill_inside(grid);
    }

    /// (s, t) in the frame of a boundary quad, whose vertex 0 lies on some corner of the patch.
    Vec3 patch_point(QuadId quad, double s, double t) const {
        const PatchMap& map = maps_[static_cast<std::size_t>(match_.patch_of_quad[quad.index()])];
        switch (match_.turn_of_quad[quad.index()]) {
            case 0:
                return map.point(s, t);
            case 1:
                return map.point(1.0 - t, s);
            case 2:
                return map.point(1.0 - s, 1.0 - t);
            default:
                return map.point(t, 1.0 - s);
        }
    }

    void place_block(CellId block) {
        const std::vector<VertexId> nodes = numbering_.block_nodes(block);
        const auto [l, m, n] = numbering_.segments(block);
        BlockGrid grid(l, m, n);
        std::size_t next = 0;
        for (int k = 0; k <= n; ++k)
            for (int j = 0; j <= m; ++j)
                for (int i = 0; i <= l; ++i) grid(i, j, k) = positions_[nodes[next++].index()];
        fill(grid);
        next = 0;
        for (int k = 0; k <= n; ++k)
            for (int j = 0; j <= m; ++j)
                for (int i = 0; i <= l; ++i, ++next)
                    if (i > 0 && i < l && j > 0 && j < m && k > 0 && k < n)
                        positions_[nodes[next].index()] = grid(i, j, k);
    }

    const TriangleMesh& surface_;
    const HexMesh& blocks_;
    const BoundaryQuads& quads_;
    const EdgeTable& edges_;
    const BlockMatch& match_;
    const BlockNumbering& numbering_;
    const std::vector<PatchMap>& maps_;
    Interior interior_;
    std::vector<Vec3> positions_;
};

/// Length of the curve that each block edge is mapped to.
std::vector<double> lengths_of_edges(const TriangleMesh& surface, const HexMesh& blocks,
                                     const EdgeTable& edges, const BlockMatch& match) {
    const auto at = [&](VertexId v) -> Vec3 {
        const int on_surface = match.surface_vertex[v.index()];
        return on_surface < 0 ? blocks.position(v)
                              : to_eigen(surface.point(TriangleMesh::VertexHandle(on_surface)));
    };
    std::vector<double> lengths(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const Chain& chain = match.chain_of_edge[e];
        lengths[e] = chain.empty() ? (at(edges.vertices[e][1]) - at(edges.vertices[e][0])).norm()
                                   : ChainCurve(surface, chain).length();
    }
    return lengths;
}

/// What does not depend on the size of the elements.
struct Prepared final : MapMemory {
    Prepared(const TriangleMesh& surface, const HexMesh& blocks, double snap_warning)
        : soup(to_soup(surface)),
          positions(blocks.positions().begin(), blocks.positions().end()),
          cells(blocks.cell_array().begin(), blocks.cell_array().end()),
          snap(snap_warning),
          layout(find_patches(surface)),
          quads(boundary_quads(blocks)),
          edges(edge_table(blocks)),
          match(match_blocks(surface, layout, blocks, quads, edges, snap_warning)),
          lengths(lengths_of_edges(surface, blocks, edges, match)) {}

    bool is_of(const TriangleMesh& surface, const HexMesh& blocks, double snap_warning) const {
        const PolygonSoup other = to_soup(surface);
        return soup.points == other.points && soup.corners == other.corners && soup.parts == other.parts &&
               std::ranges::equal(positions, blocks.positions()) &&
               std::ranges::equal(cells, blocks.cell_array()) && snap == snap_warning;
    }

    // What it was made of.
    PolygonSoup soup;
    std::vector<Vec3> positions;
    std::vector<HexCell> cells;
    double snap;

    PatchLayout layout;
    BoundaryQuads quads;
    EdgeTable edges;
    BlockMatch match;
    std::vector<double> lengths;
    std::vector<PatchMap> maps;  ///< none before they are needed
};

class PatchwiseMapper : public Mapper {
  public:
    MapResult map(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options,
                  const Context& context) const override {
        return with_threads(context, [&] { return run(surface, blocks, options, context); });
    }

  private:
    static std::shared_ptr<Prepared> prepare(const TriangleMesh& surface, const HexMesh& blocks,
                                             const MapOptions& options) {
        if (options.memory != nullptr)
            if (auto known = std::dynamic_pointer_cast<Prepared>(*options.memory);
                known && known->is_of(surface, blocks, options.snap_warning))
                return known;
        auto made = std::make_shared<Prepared>(surface, blocks, options.snap_warning);
        if (options.memory != nullptr) *options.memory = made;
        return made;
    }

    static MapResult run(const TriangleMesh& surface, const HexMesh& blocks, const MapOptions& options,
                         const Context& context) {
        context.check_cancelled();
        context.progress("patches", 0.0);
        const std::shared_ptr<Prepared> prepared = prepare(surface, blocks, options);
        const EdgeTable& edges = prepared->edges;
        const BlockMatch& match = prepared->match;
        const std::vector<double>& lengths = prepared->lengths;
        MapResult result;
        const BlockNumbering numbering(blocks, edges,
                                       divide(blocks, edges, lengths, options, context, result.report));

        if (prepared->maps.empty()) prepared->maps = map_patches(surface, prepared->layout, context);
        context.progress("edges", 0.4);
        std::vector<Vec3> positions = NodePlacer(surface, blocks, prepared->quads, edges, match, numbering,
                                                 prepared->maps, options.interior)
                                          .run(context);
        std::vector<HexCell> cells = numbering.cells();
        if (options.interior == Interior::harmonic)
            result.report.held_back_nodes =
                relax_harmonically(blocks, edges, numbering, lengths, cells, positions, context)
                    .held_back_nodes;

        context.check_cancelled();
        context.progress("mesh", 0.9);
        std::vector<int> parts(numbering.cell_count());
        for (const CellId b : blocks.cells())
            std::fill(
                parts.begin() + static_cast<std::ptrdiff_t>(numbering.first_cell(b)),
                b.index() + 1 < blocks.cell_count()
                    ? parts.begin() + static_cast<std::ptrdiff_t>(numbering.first_cell(CellId(b.index() + 1)))
                    : parts.end(),
                static_cast<int>(b.index()) + 1);
        result.mesh = HexMesh(std::move(positions), std::move(cells), std::move(parts));
        result.report.blocks = blocks.cell_count();
        result.report.largest_snap = match.largest_snap;
        result.report.diagnostics = match.diagnostics;
        report_patches(prepared->layout, prepared->maps, result.report);
        context.progress("mesh", 1.0);
        return result;
    }

    /// Pieces of each block edge.
    static std::vector<int> divide(const HexMesh& blocks, const EdgeTable& edges,
                                   const std::vector<double>& lengths, const MapOptions& options,
                                   const Context& context, MapReport& report) {
        const BlockSheets sheets = find_sheets(blocks, edges);
        if (options.edge_length > 0.0 || options.target_hexes > 0) {
            const SheetDivider divider(blocks, edges, sheets, lengths);
            SheetDivisions divisions = options.target_hexes > 0
                                           ? divider.for_count(options.target_hexes, context)
                                           : divider.for_length(options.edge_length, context);
            report.divisions = std::move(divisions.pieces);
            report.edge_length = divisions.edge_length;
        } else {
            report.divisions.assign(sheets.count, 1 << options.level);
        }
        std::vector<int> pieces(edges.size());
        for (std::size_t e = 0; e < edges.size(); ++e) pieces[e] = report.divisions[sheets.sheet_of_edge[e]];
        return pieces;
    }
};

const Register<Mapper, PatchwiseMapper> patchwise(
    mappers(), "patchwise",
    "harmonic maps of the patches, blocks filled from their faces, conforming by one global numbering");

}  // namespace
}  // namespace hex
