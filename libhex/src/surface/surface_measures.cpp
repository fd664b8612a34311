#include <hex/base/components.h>
#include <hex/surface/polygon_soup.h>

#include <array>
#include <cstdint>

namespace hex {
namespace {

std::array<Vec3, 3> corners(const TriangleMesh& mesh, TriangleMesh::FaceHandle face) {
    std::array<Vec3, 3> points;
    auto point = points.begin();
    for (const auto v : mesh.fv_range(face)) *point++ = to_eigen(mesh.point(v));
    return points;
}

}  // namespace

std::vector<std::uint32_t> components_of(const TriangleMesh& mesh, std::uint32_t& count) {
    Components components(mesh.n_faces());
    for (const auto e : mesh.edges()) {
        const auto one = mesh.face_handle(mesh.halfedge_handle(e, 0));
        const auto other = mesh.face_handle(mesh.halfedge_handle(e, 1));
        if (one.is_valid() && other.is_valid())
            components.join(static_cast<std::size_t>(one.idx()), static_cast<std::size_t>(other.idx()));
    }
    return components.numbers(count);
}

double enclosed_volume(const TriangleMesh& mesh) {
    // About the box's centre, so that a small part far from the origin does not lose its digits.
    const BoundingBox box = bounding_box(mesh);
    if (box.empty()) return 0.0;
    const Vec3 centre = 0.5 * (box.lower + box.upper);
    double volume = 0.0;
    for (const auto f : mesh.faces()) {
        const auto p = corners(mesh, f);
        volume += (p[0] - centre).dot((p[1] - centre).cross(p[2] - centre)) / 6.0;
    }
    return volume;
}

BoundingBox bounding_box(const TriangleMesh& mesh) {
    BoundingBox box;
    for (const auto v : mesh.vertices()) {
        if (!mesh.is_isolated(v)) box.add(to_eigen(mesh.point(v)));
    }
    return box;
}

Diagnostics inspect(const TriangleMesh& mesh) {
    Diagnostics diagnostics;
    const auto report = [&](Severity severity, const char* code, const std::string& message,
                            const char* entity, std::vector<std::int64_t> ids) {
        const std::string text = ids.empty() ? message : message + ": " + list_ids(ids);
        diagnostics.push_back({severity, code, text, entity, std::move(ids)});
    };

    std::vector<std::int64_t> isolated, flat;
    for (const auto v : mesh.vertices()) {
        if (mesh.is_isolated(v)) isolated.push_back(v.idx());
    }
    for (const auto f : mesh.faces()) {
        const auto p = corners(mesh, f);
        if ((p[1] - p[0]).cross(p[2] - p[0]).norm() == 0.0) flat.push_back(f.idx());
    }
    if (!isolated.empty())
        report(Severity::note, "isolated-vertices", "vertices that no face uses", "vertex",
               std::move(isolated));
    if (!flat.empty())
        report(Severity::warning, "zero-area-triangles", "triangles without area", "triangle",
               std::move(flat));
    if (enclosed_volume(mesh) < 0)
        report(Severity::warning, "inside-out", "the surface is oriented inwards (negative volume)",
               "surface", {});
    std::uint32_t components = 0;
    components_of(mesh, components);
    if (components > 1)
        report(Severity::note, "components", "the surface has " + std::to_string(components) + " components",
               "surface", {});
    return diagnostics;
}

}  // namespace hex
