#include <hex/base/parallel.h>
#include <hex/quality/mesh_defects.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace hex {
namespace {

std::vector<char> used_vertices(const HexMesh& mesh) {
    std::vector<char> used(mesh.vertex_count(), 0);
    for (const HexCell& cell : mesh.cell_array())
        for (const VertexId v : cell) used[v.index()] = 1;
    return used;
}

using Box = std::array<std::int64_t, 3>;

/// A vertex in one of the boxes of a grid.
struct Entry {
    Box box;
    VertexId vertex;
    auto operator<=>(const Entry&) const = default;
};

/// For each vertex the first vertex at the same place; itself when it is the first or not used. Boxes are
/// four times as wide as the tolerance: a vertex is listed in each box that comes near enough, and few
/// distinct places fit in one.
std::vector<VertexId> first_at_place(const HexMesh& mesh, const std::vector<char>& used, double tolerance) {
    const BoundingBox bounds = bounding_box(mesh);
    const double reach = tolerance * bounds.diagonal();
    const double width = reach > 0.0 ? 4.0 * reach : std::max(bounds.diagonal(), 1.0) * 1e-9;
    std::vector<Entry> entries;
    entries.reserve(mesh.vertex_count());
    for (const VertexId v : mesh.vertices()) {
        if (!used[v.index()]) continue;
        const auto box_at = [&](int axis, double offset) {
            return static_cast<std::int64_t>(
                std::floor((mesh.position(v)[axis] - bounds.lower[axis] + offset) / width));
        };
        const Box lower = {box_at(0, -reach), box_at(1, -reach), box_at(2, -reach)};
        const Box upper = {box_at(0, reach), box_at(1, reach), box_at(2, reach)};
        for (std::int64_t x = lower[0]; x <= upper[0]; ++x)
            for (std::int64_t y = lower[1]; y <= upper[1]; ++y)
                for (std::int64_t z = lower[2]; z <= upper[2]; ++z) entries.push_back({{x, y, z}, v});
    }
    std::sort(entries.begin(), entries.end());

    std::vector<VertexId> first(mesh.vertex_count());
    for (const VertexId v : mesh.vertices()) first[v.index()] = v;
    std::vector<VertexId> places;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i == 0 || entries[i].box != entries[i - 1].box) places.clear();
        const VertexId v = entries[i].vertex;
        const auto same = std::find_if(places.begin(), places.end(), [&](VertexId place) {
            return (mesh.position(place) - mesh.position(v)).norm() <= reach;
        });
        if (same == places.end())
            places.push_back(v);
        else
            first[v.index()] = std::min(first[v.index()], *same);
    }
    // A place may itself have been joined to an earlier one in another box.
    for (const VertexId v : mesh.vertices()) first[v.index()] = first[first[v.index()].index()];
    return first;
}

std::vector<std::array<HalfFaceId, 2>> find_cracks(const HexMesh& mesh, const std::vector<VertexId>& first) {
    struct Face {
        std::array<VertexId, 4> corners;
        HalfFaceId half_face;
        auto operator<=>(const Face&) const = default;
    };
    std::vector<Face> faces;
    for (const HalfFaceId h : mesh.half_faces()) {
        if (!mesh.is_boundary(h)) continue;
        Face face{mesh.face_vertices(h), h};
        for (VertexId& v : face.corners) v = first[v.index()];
        std::sort(face.corners.begin(), face.corners.end());
        faces.push_back(face);
    }
    std::sort(faces.begin(), faces.end());
    std::vector<std::array<HalfFaceId, 2>> cracks;
    for (std::size_t i = 1; i < faces.size(); ++i)
        if (faces[i].corners == faces[i - 1].corners)
            cracks.push_back({faces[i - 1].half_face, faces[i].half_face});
    std::sort(cracks.begin(), cracks.end());
    return cracks;
}

std::vector<std::array<VertexId, 2>> find_open_edges(const HexMesh& mesh) {
    std::vector<std::array<VertexId, 2>> sides;
    for (const HalfFaceId h : mesh.half_faces()) {
        if (!mesh.is_boundary(h)) continue;
        const auto corners = mesh.face_vertices(h);
        for (std::size_t i = 0; i < 4; ++i) {
            const VertexId a = corners[i], b = corners[(i + 1) % 4];
            sides.push_back({std::min(a, b), std::max(a, b)});
        }
    }
    std::sort(sides.begin(), sides.end());
    std::vector<std::array<VertexId, 2>> open;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i;
        while (end < sides.size() && sides[end] == sides[i]) ++end;
        if (end - i != 2) open.push_back(sides[i]);
        i = end;
    }
    return open;
}

}  // namespace

MeshDefects find_defects(const HexMesh& mesh, double tolerance, const Context& context) {
    return with_threads(context, [&] {
        MeshDefects defects;
        const std::vector<char> used = used_vertices(mesh);
        const std::vector<VertexId> first = first_at_place(mesh, used, tolerance);
        context.check_cancelled();
        for (const VertexId v : mesh.vertices()) {
            if (!used[v.index()]) defects.unused.push_back(v);
            if (first[v.index()] != v) defects.duplicates.push_back({v, first[v.index()]});
        }
        if (!defects.duplicates.empty()) defects.cracks = find_cracks(mesh, first);
        defects.open_edges = find_open_edges(mesh);
        context.check_cancelled();
        defects.topology = inspect(mesh);
        for (const Diagnostic& finding : defects.topology) {
            if (finding.code == "components") defects.several_components = true;
            if (finding.code != "non-manifold-vertices") continue;
            for (const std::int64_t v : finding.ids)
                defects.pinched.emplace_back(static_cast<std::size_t>(v));
        }
        return defects;
    });
}

}  // namespace hex
