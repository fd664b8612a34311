#include <hex/base/error.h>
#include <hex/surface/polygon_soup.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace hex {
namespace {

using Index = std::uint32_t;

/// An undirected edge with the polygon that runs along it, and in which direction.
struct EdgeUse {
    Index low;
    Index high;
    Index polygon;
    Index corner;  ///< of the polygon, in the soup's list of corners, where the edge starts
    bool forward;  ///< the polygon runs from low to high
};

[[noreturn]] void reject(const std::string& what, const std::string& advice = {}) {
    throw Error(ErrorKind::bad_input, what, {}, advice);
}

std::string edge_text(const EdgeUse& use) {
    return "between vertices " + std::to_string(use.low) + " and " + std::to_string(use.high) + " (polygon " +
           std::to_string(use.polygon) + ")";
}

void check_polygons(const PolygonSoup& soup) {
    if (soup.size() == 0) reject("the surface has no faces");
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        if (!soup.points[v].allFinite())
            reject("vertex " + std::to_string(v) + " has a coordinate that is not finite");
    }
    std::vector<Index> sorted;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto polygon = soup.polygon(f);
        if (polygon.size() < 3) reject("polygon " + std::to_string(f) + " has fewer than three corners");
        sorted.assign(polygon.begin(), polygon.end());
        std::sort(sorted.begin(), sorted.end());
        if (sorted.back() >= soup.points.size())
            reject("polygon " + std::to_string(f) + " uses vertex " + std::to_string(sorted.back()) + " of " +
                   std::to_string(soup.points.size()));
        const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
        if (twice != sorted.end())
            reject("polygon " + std::to_string(f) + " uses vertex " + std::to_string(*twice) + " twice");
    }
}

std::vector<EdgeUse> sorted_edge_uses(const PolygonSoup& soup) {
    std::vector<EdgeUse> uses;
    uses.reserve(soup.corners.size());
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto polygon = soup.polygon(f);
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Index a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            uses.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(f),
                            static_cast<Index>(soup.offsets[f] + i), a < b});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& x, const EdgeUse& y) {
        if (x.low != y.low) return x.low < y.low;
        if (x.high != y.high) return x.high < y.high;
        return x.polygon < y.polygon;
    });
    return uses;
}

/// A kind of bad edge: how many, and the first.
struct Finding {
    std::size_t count = 0;
    const EdgeUse* first = nullptr;
    void note(const EdgeUse& use) {
        if (count++ == 0) first = &use;
    }
};

/// Rejects non-manifold edges first, then wrong orientation, then boundaries, as that is the order of how bad
/// they are.
void check_edges(const std::vector<EdgeUse>& uses, const SurfaceRequirements& requirements) {
    Finding crowded, opposed, open;
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t end = i + 1;
        while (end < uses.size() && uses[end].low == uses[i].low && uses[end].high == uses[i].high) ++end;
        if (end - i > 2)
            crowded.note(uses[i]);
        else if (end - i == 2 && uses[i].forward == uses[i + 1].forward)
            opposed.note(uses[i]);
        else if (end - i == 1)
            open.note(uses[i]);
        i = end;
    }
    if (crowded.count > 0)
        reject("the surface is not manifold: " + std::to_string(crowded.count) +
                   " edges have more than two faces, the first " + edge_text(*crowded.first),
               "mend the surface");
    if (opposed.count > 0)
        reject("the faces are not oriented alike along " + std::to_string(opposed.count) +
                   " edges, the first " + edge_text(*opposed.first),
               "orient all faces outwards");
    if (open.count > 0 && requirements.closed)
        reject("the surface is open: " + std::to_string(open.count) + " boundary edges, the first " +
                   edge_text(*open.first),
               "close the holes");
}

/// Every vertex must have one fan of faces: its corners, joined across the edges they share, form one
/// component.
void check_vertices(const PolygonSoup& soup, const std::vector<EdgeUse>& uses) {
    std::vector<Index> parent(soup.corners.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto find = [&](Index x) {
        while (parent[x] != x) x = parent[x] = parent[parent[x]];
        return x;
    };
    // The corner of an edge's polygon at one of its ends.
    const auto corner_at = [&](const EdgeUse& use, Index vertex) {
        if (soup.corners[use.corner] == vertex) return use.corner;
        const bool last = use.corner + 1 == soup.offsets[use.polygon + 1];
        return last ? static_cast<Index>(soup.offsets[use.polygon]) : use.corner + 1;
    };
    for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
        if (uses[i].low != uses[i + 1].low || uses[i].high != uses[i + 1].high) continue;
        for (const Index vertex : {uses[i].low, uses[i].high})
            parent[find(corner_at(uses[i], vertex))] = find(corner_at(uses[i + 1], vertex));
    }
    const auto none = static_cast<Index>(soup.corners.size());
    std::vector<Index> fan_of_vertex(soup.points.size(), none);
    for (Index c = 0; c < none; ++c) {
        Index& fan = fan_of_vertex[soup.corners[c]];
        if (fan == none) fan = find(c);
        if (fan != find(c))
            reject("the surface is not manifold: it only touches itself at vertex " +
                       std::to_string(soup.corners[c]),
                   "give each sheet a vertex of its own");
    }
}

/// An inner vertex with two faces only: they share two neighbouring edges, and any diagonal that cuts the
/// vertex off would lie in both, an edge with four triangles.
void check_valences(const PolygonSoup& soup, const std::vector<EdgeUse>& uses) {
    std::vector<Index> faces(soup.points.size(), 0), edges(soup.points.size(), 0);
    for (const Index v : soup.corners) ++faces[v];
    for (std::size_t i = 0; i < uses.size(); ++i) {
        if (i > 0 && uses[i].low == uses[i - 1].low && uses[i].high == uses[i - 1].high) continue;
        ++edges[uses[i].low];
        ++edges[uses[i].high];
    }
    std::vector<std::int64_t> doublets;
    for (std::size_t v = 0; v < faces.size(); ++v) {
        if (faces[v] == 2 && edges[v] == 2) doublets.push_back(static_cast<std::int64_t>(v));
    }
    if (!doublets.empty())
        reject(
            "the surface is not manifold once triangulated: two faces share two neighbouring edges at "
            "vertices " +
                list_ids(doublets),
            "remove these vertices");
}

template <class Mesh>
PolygonSoup soup_of(const Mesh& mesh) {
    PolygonSoup soup;
    soup.points.reserve(mesh.n_vertices());
    for (const auto v : mesh.vertices()) soup.points.push_back(to_eigen(mesh.point(v)));
    std::vector<Index> polygon;
    for (const auto f : mesh.faces()) {
        polygon.clear();
        for (const auto v : mesh.fv_range(f)) polygon.push_back(static_cast<Index>(v.idx()));
        soup.add_polygon(polygon, mesh.data(f).part);
    }
    return soup;
}

}  // namespace

void PolygonSoup::add_polygon(std::span<const std::uint32_t> polygon, int part) {
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    offsets.push_back(corners.size());
    parts.push_back(part);
}

PolyMesh make_poly_mesh(const PolygonSoup& soup, const SurfaceRequirements& requirements) {
    check_polygons(soup);
    const auto uses = sorted_edge_uses(soup);
    check_edges(uses, requirements);
    check_vertices(soup, uses);
    check_valences(soup, uses);

    PolyMesh mesh;
    mesh.reserve(soup.points.size(), uses.size() / 2, soup.size());
    for (const Vec3& p : soup.points) mesh.add_vertex(to_openmesh(p));
    std::vector<PolyMesh::VertexHandle> handles;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        handles.clear();
        for (const Index v : soup.polygon(f)) handles.emplace_back(static_cast<int>(v));
        const auto face = mesh.add_face(handles);
        if (!face.is_valid())
            reject("polygon " + std::to_string(f) + " cannot be joined to the faces before it");
        mesh.data(face).part = soup.parts.empty() ? 1 : soup.parts[f];
        mesh.data(face).source = static_cast<std::int64_t>(f);
    }
    return mesh;
}

TriangleMesh make_triangle_mesh(const PolygonSoup& soup, const SurfaceRequirements& requirements) {
    return triangulate(make_poly_mesh(soup, requirements));
}

PolygonSoup to_soup(const TriangleMesh& mesh) {
    return soup_of(mesh);
}
PolygonSoup to_soup(const PolyMesh& mesh) {
    return soup_of(mesh);
}

}  // namespace hex
