#include <hex/base/error.h>
#include <hex/map/block_match.h>
#include <hex/surface/polygon_soup.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/property_map.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace hex {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Numbered = std::pair<Kernel::Point_3, int>;
using SearchTraits = CGAL::Search_traits_adapter<Numbered, CGAL::First_of_pair_property_map<Numbered>,
                                                 CGAL::Search_traits_3<Kernel>>;
using NearestCorner = CGAL::Orthogonal_k_neighbor_search<SearchTraits>;

constexpr const char* blocks_advice =
    "the blocks must be drawn on the corners of this very surface, one boundary quad a patch";

Vec3 surface_point(const TriangleMesh& surface, int vertex) {
    return to_eigen(surface.point(TriangleMesh::VertexHandle(vertex)));
}

/// "patch 3 (part 12)": the index that reports use and the id that the file has.
std::string name_of(const PatchLayout& layout, std::size_t patch) {
    return fmt::format("patch {} (part {})", patch, layout.patches[patch].part);
}

template <std::size_t N>
std::string join(const std::array<int, N>& ids) {
    return fmt::format("{}", fmt::join(ids, ", "));
}

std::array<int, 4> sorted(std::array<int, 4> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
}

[[noreturn]] void fail(std::string what, std::string advice = blocks_advice) {
    throw Error(ErrorKind::bad_input, std::move(what), {}, std::move(advice));
}

void require_four_sided(const PatchLayout& layout) {
    std::vector<std::int64_t> bad;
    for (std::size_t p = 0; p < layout.patches.size(); ++p)
        if (!layout.patches[p].four_sided) bad.push_back(static_cast<std::int64_t>(p));
    if (bad.empty()) return;
    fail(fmt::format("{} of {} patches ({}) are not disks with four corners: {}", bad.size(),
                     layout.patches.size(), list_ids(bad), diagnose_layout(layout).front().message),
         "give a surface whose part ids are four-sided patches (`polycube` tells what is wrong with each)");
}

/// Boundary vertices of the blocks to corners of the surface.
void snap(const TriangleMesh& surface, const PatchLayout& layout, const HexMesh& blocks,
          const BoundaryQuads& quads, double far, BlockMatch& match) {
    std::vector<Numbered> corners;
    for (const int v : layout.corners) {
        const Vec3 p = surface_point(surface, v);
        corners.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), v);
    }
    if (corners.empty()) fail("the surface has no corner, that is no vertex where three patches meet");
    NearestCorner::Tree tree(corners.begin(), corners.end());
    tree.build();

    const double diagonal = bounding_box(surface).diagonal();
    Diagnostic distant{Severity::warning, "far-corner", {}, "block vertex", {}};
    std::map<int, VertexId> owner;
    match.surface_vertex.assign(blocks.vertex_count(), -1);
    for (const VertexId v : quads.boundary_vertices) {
        const Vec3& p = blocks.position(v);
        NearestCorner search(tree, Kernel::Point_3(p.x(), p.y(), p.z()), 1);
        const int corner = search.begin()->first.second;
        const auto [entry, added] = owner.emplace(corner, v);
        if (!added)
            fail(fmt::format(
                "block vertices {} and {} are both nearest to one corner of the surface, vertex {}",
                entry->second.value(), v.value(), corner));
        match.surface_vertex[v.index()] = corner;
        const double distance = diagonal > 0.0 ? (p - surface_point(surface, corner)).norm() / diagonal : 0.0;
        match.largest_snap = std::max(match.largest_snap, distance);
        if (distance > far) distant.ids.push_back(static_cast<std::int64_t>(v.index()));
    }
    if (!distant.ids.empty()) {
        distant.message = fmt::format(
            "{} block vertices are farther than {} diagonals from the nearest corner of the "
            "surface (at most {:.3g}): {}",
            distant.ids.size(), far, match.largest_snap, list_ids(distant.ids));
        match.diagnostics.push_back(std::move(distant));
    }
}

/// Boundary quads of the blocks to patches.
void pair_quads(const PatchLayout& layout, const BoundaryQuads& quads, BlockMatch& match) {
    std::map<std::array<int, 4>, std::size_t> patch_with;
    for (std::size_t p = 0; p < layout.patches.size(); ++p) {
        const auto [entry, added] = patch_with.emplace(sorted(layout.patches[p].corners), p);
        if (!added)
            fail(fmt::format(
                     "{} and {} have the same four corners, surface vertices {}, so no block structure can "
                     "tell them apart",
                     name_of(layout, entry->second), name_of(layout, p), join(layout.patches[p].corners)),
                 "cut one of them into more patches");
    }

    match.patch_of_quad.resize(quads.size());
    match.turn_of_quad.resize(quads.size());
    std::vector<char> used(layout.patches.size(), 0);
    std::string first_unmatched;
    std::size_t unmatched = 0;
    for (std::size_t q = 0; q < quads.size(); ++q) {
        std::array<int, 4> corners{};
        std::array<int, 4> block_vertices{};
        for (std::size_t k = 0; k < 4; ++k) {
            const VertexId v = quads.vertices[q][k];
            block_vertices[k] = static_cast<int>(v.value());
            corners[k] = match.surface_vertex[v.index()];
        }
        const std::size_t block = HexMesh::cell_of(quads.half_faces[q]).index();
        const auto found = patch_with.find(sorted(corners));
        if (found == patch_with.end()) {
            if (++unmatched == 1)
                first_unmatched = fmt::format(
                    "block {} has a boundary quad on block vertices {} (surface vertices {}) that is no "
                    "patch",
                    block, join(block_vertices), join(corners));
            continue;
        }
        const std::size_t p = found->second;
        const std::array<int, 4>& cycle = layout.patches[p].corners;
        const auto turn =
            static_cast<std::size_t>(std::find(cycle.begin(), cycle.end(), corners[0]) - cycle.begin());
        const auto follows = [&](std::size_t step) {
            for (std::size_t k = 1; k < 4; ++k)
                if (cycle[(turn + k * step) % 4] != corners[k]) return false;
            return true;
        };
        if (follows(3))
            fail(fmt::format("block {} and {} are oriented against each other on block vertices {}", block,
                             name_of(layout, p), join(block_vertices)),
                 "blocks must have positive volume and the triangles must be counter-clockwise seen from "
                 "outside");
        if (!follows(1))
            fail(fmt::format(
                "block {} has a boundary quad on block vertices {} that joins the corners of {} crosswise",
                block, join(block_vertices), name_of(layout, p)));
        used[p] = 1;
        match.patch_of_quad[q] = static_cast<int>(p);
        match.turn_of_quad[q] = static_cast<int>(turn);
    }
    if (unmatched > 0)
        fail(first_unmatched + (unmatched > 1 ? fmt::format(" ({} such quads in all)", unmatched) : ""));

    std::string unused;
    std::size_t unused_count = 0;
    for (std::size_t p = 0; p < used.size(); ++p) {
        if (used[p] == 0 && ++unused_count <= 8) unused += (unused.empty() ? "" : ", ") + name_of(layout, p);
    }
    if (unused_count > 0)
        fail(fmt::format("{} of {} patches have no boundary quad of the blocks: {}{}", unused_count,
                         used.size(), unused, unused_count > 8 ? ", ..." : ""));
}

/// Boundary edges of the blocks to chains.
void pair_edges(const PatchLayout& layout, const BoundaryQuads& quads, const EdgeTable& edges,
                BlockMatch& match) {
    match.chain_of_edge.resize(edges.size());
    std::vector<int> patch_of_edge(edges.size(), -1);
    for (std::size_t q = 0; q < quads.size(); ++q) {
        const int p = match.patch_of_quad[q];
        const std::vector<Chain>& sides = layout.patches[static_cast<std::size_t>(p)].loops.front();
        for (std::size_t k = 0; k < 4; ++k) {
            const VertexId from = quads.vertices[q][k];
            const VertexId to = quads.vertices[q][(k + 1) % 4];
            const EdgeId e = edges.find(from, to);
            Chain chain = sides[(k + static_cast<std::size_t>(match.turn_of_quad[q])) % 4];
            if (from > to) std::reverse(chain.begin(), chain.end());
            Chain& known = match.chain_of_edge[e.index()];
            if (known.empty()) {
                known = std::move(chain);
                patch_of_edge[e.index()] = p;
            } else if (known != chain) {
                fail(fmt::format("the block edge between block vertices {} and {} would have to follow both "
                                 "{} and {}, "
                                 "whose boundaries differ between surface vertices {} and {}",
                                 edges.vertices[e.index()][0].value(), edges.vertices[e.index()][1].value(),
                                 name_of(layout, static_cast<std::size_t>(patch_of_edge[e.index()])),
                                 name_of(layout, static_cast<std::size_t>(p)), chain.front(), chain.back()),
                     "cut one of the patches so that two corners are joined by one chain only");
            }
        }
    }
}

}  // namespace

BlockMatch match_blocks(const TriangleMesh& surface, const PatchLayout& layout, const HexMesh& blocks,
                        const BoundaryQuads& quads, const EdgeTable& edges, double far) {
    if (blocks.empty()) fail("there are no blocks", "give a block structure of hexahedra");
    if (layout.patches.empty()) fail("the surface has no triangles", "give a closed triangle surface");
    require_four_sided(layout);
    BlockMatch match;
    snap(surface, layout, blocks, quads, far, match);
    pair_quads(layout, quads, match);
    pair_edges(layout, quads, edges, match);
    return match;
}

}  // namespace hex
