#include <hex/base/error.h>
#include <hex/surface/cgal_bridge.h>
#include <hex/surface/repair.h>

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <set>
#include <string>

namespace hex {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

using Point = CgalKernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

/// Corners of a polygon that remembers its part while CGAL moves it about.
struct Polygon : std::vector<std::size_t> {
    using std::vector<std::size_t>::vector;
    int part = 1;
};

std::vector<Polygon> polygons_of(const PolygonSoup& soup) {
    std::vector<Polygon> polygons(soup.size());
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto corners = soup.polygon(f);
        polygons[f].assign(corners.begin(), corners.end());
        polygons[f].part = soup.parts[f];
    }
    return polygons;
}

/// Corners that follow each other in one place become one; what has fewer than three, or one twice, goes.
std::size_t remove_degenerate(std::vector<Polygon>& polygons) {
    for (Polygon& polygon : polygons) {
        polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
        while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
    }
    return std::erase_if(polygons, [](const Polygon& polygon) {
        return polygon.size() < 3 ||
               std::set<std::size_t>(polygon.begin(), polygon.end()).size() < polygon.size();
    });
}

/// Smallest corner first, so that equal cycles are equal lists.
Polygon canonical(Polygon polygon) {
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
    return polygon;
}

std::size_t orient(std::vector<Point>& points, std::vector<Polygon>& polygons) {
    const std::vector<Polygon> before = polygons;
    pmp::orient_polygon_soup(points, polygons);
    std::size_t turned = 0;
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        // Copies of points lie where the point was, so compare places.
        Polygon was = canonical(before[f]);
        std::size_t shift = 0;
        while (shift < polygons[f].size() && points[polygons[f][shift]] != points[was[0]]) ++shift;
        const std::size_t n = was.size();
        if (shift < n && points[polygons[f][(shift + 1) % n]] != points[was[1]]) ++turned;
    }
    return turned;
}

/// orient_polygon_soup() cuts the surface open along edges with more than two polygons; where the pieces have
/// fallen apart, each is closed by itself.
void close_cuts(Mesh& mesh) {
    pmp::stitch_borders(mesh, CGAL::parameters::apply_per_connected_component(true));
    pmp::duplicate_non_manifold_vertices(mesh);
    mesh.collect_garbage();
}

double length_of_border(const Mesh& mesh, Mesh::Halfedge_index start) {
    double length = 0.0;
    for (const Mesh::Halfedge_index h : CGAL::halfedges_around_face(start, mesh))
        length += std::sqrt(
            CGAL::to_double(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)))));
    return length;
}

void fill_holes(Mesh& mesh, Mesh::Property_map<Mesh::Face_index, int>& parts, double longest,
                RepairReport& report) {
    std::vector<Mesh::Halfedge_index> borders;
    pmp::extract_boundary_cycles(mesh, std::back_inserter(borders));
    for (const Mesh::Halfedge_index h : borders) {
        if (length_of_border(mesh, h) > longest) {
            ++report.holes_left;
            continue;
        }
        const int part = parts[mesh.face(mesh.opposite(h))];
        std::vector<Mesh::Face_index> filling;
        pmp::triangulate_hole(mesh, h, std::back_inserter(filling));
        if (filling.empty()) {
            ++report.holes_left;
            continue;
        }
        for (const Mesh::Face_index f : filling) parts[f] = part;
        ++report.filled_holes;
        report.filling_triangles += filling.size();
    }
}

/// Removes inner vertices that have two polygons only: a diagonal that cuts such a vertex off would lie in
/// both. The polygons then meet in one edge, or, if one was a triangle, become one. That takes an edge away
/// from both neighbours, which are looked at again. Where it would give an edge a second time, or leave
/// nothing of two triangles, the vertex stays.
std::size_t remove_doublets(Mesh& mesh) {
    std::size_t removed = 0;
    std::vector<Mesh::Vertex_index> waiting(mesh.vertices().begin(), mesh.vertices().end());
    while (!waiting.empty()) {
        const Mesh::Vertex_index v = waiting.back();
        waiting.pop_back();
        if (mesh.is_removed(v) || mesh.is_border(v) || mesh.degree(v) != 2) continue;
        const Mesh::Halfedge_index h = mesh.halfedge(v);
        const Mesh::Halfedge_index other = mesh.opposite(mesh.next(h));
        const Mesh::Vertex_index a = mesh.source(h);
        const Mesh::Vertex_index b = mesh.source(other);
        const auto corners = std::minmax({mesh.degree(mesh.face(h)), mesh.degree(mesh.face(other))});
        if (corners.second < 4) continue;
        if (corners.first == 3)
            CGAL::Euler::remove_center_vertex(h, mesh);
        else if (!CGAL::halfedge(a, b, mesh).second)
            CGAL::Euler::join_vertex(mesh.opposite(h), mesh);
        else
            continue;
        ++removed;
        waiting.push_back(a);
        waiting.push_back(b);
    }
    mesh.collect_garbage();
    return removed;
}

PolygonSoup soup_of(const Mesh& mesh, const Mesh::Property_map<Mesh::Face_index, int>& parts) {
    PolygonSoup soup;
    for (const Mesh::Vertex_index v : mesh.vertices()) {
        const Point& p = mesh.point(v);
        soup.points.emplace_back(p.x(), p.y(), p.z());
    }
    std::vector<std::uint32_t> corners;
    for (const Mesh::Face_index f : mesh.faces()) {
        corners.clear();
        for (const Mesh::Vertex_index v : CGAL::vertices_around_face(mesh.halfedge(f), mesh))
            corners.push_back(static_cast<std::uint32_t>(v));
        soup.add_polygon(corners, parts[f]);
    }
    return soup;
}

/// Six times the volume, by fans of the polygons.
double volume_of(const PolygonSoup& soup) {
    double volume = 0.0;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto c = soup.polygon(f);
        for (std::size_t k = 1; k + 1 < c.size(); ++k)
            volume += soup.points[c[0]].dot(soup.points[c[k]].cross(soup.points[c[k + 1]]));
    }
    return volume;
}

}  // namespace

RepairReport repair(PolygonSoup& soup, const RepairOptions& options) {
    RepairReport report;
    std::vector<Point> points;
    BoundingBox box;
    for (const Vec3& p : soup.points) {
        points.emplace_back(p.x(), p.y(), p.z());
        box.add(p);
    }
    std::vector<Polygon> polygons = polygons_of(soup);
    report.merged_points = pmp::merge_duplicate_points_in_polygon_soup(points, polygons);
    report.degenerate_polygons = remove_degenerate(polygons);
    report.duplicate_polygons = pmp::merge_duplicate_polygons_in_polygon_soup(
        points, polygons, CGAL::parameters::erase_all_duplicates(false).require_same_orientation(false));
    report.unused_points = pmp::remove_isolated_points_in_polygon_soup(points, polygons);
    const std::size_t count = points.size();
    report.turned_polygons = orient(points, polygons);
    if (polygons.empty() || !pmp::is_polygon_soup_a_polygon_mesh(polygons))
        throw Error(ErrorKind::no_result, "no surface can be made of the polygons", {},
                    "mend the model in a modelling program");

    Mesh mesh;
    pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
    auto parts = mesh.add_property_map<Mesh::Face_index, int>("f:part", 1).first;
    std::size_t next = 0;
    for (const Mesh::Face_index f : mesh.faces()) parts[f] = polygons[next++].part;
    close_cuts(mesh);
    report.split_points = mesh.number_of_vertices() - std::min<std::size_t>(count, mesh.number_of_vertices());
    fill_holes(mesh, parts, options.longest_hole * box.diagonal(), report);
    report.removed_points = remove_doublets(mesh);

    soup = soup_of(mesh, parts);
    if (report.holes_left == 0 && volume_of(soup) < 0.0) {
        for (std::size_t f = 0; f < soup.size(); ++f)
            std::reverse(soup.corners.begin() + static_cast<std::ptrdiff_t>(soup.offsets[f]),
                         soup.corners.begin() + static_cast<std::ptrdiff_t>(soup.offsets[f + 1]));
        report.turned_polygons = polygons.size() - std::min(report.turned_polygons, polygons.size());
    }
    return report;
}

Diagnostics describe(const RepairReport& report) {
    Diagnostics findings;
    const auto tell = [&](std::size_t count, const char* code, const std::string& what,
                          Severity severity = Severity::note) {
        if (count > 0) findings.push_back({severity, code, std::to_string(count) + what, {}, {}});
    };
    tell(report.merged_points, "repair-points", " points merged with others in the same place");
    tell(report.degenerate_polygons, "repair-degenerate", " degenerate polygons removed");
    tell(report.duplicate_polygons, "repair-duplicate", " duplicate polygons removed");
    tell(report.unused_points, "repair-unused", " unused points removed");
    tell(report.turned_polygons, "repair-orientation", " polygons turned");
    tell(report.split_points, "repair-manifold", " points split where the surface was not manifold");
    tell(report.filled_holes, "repair-hole",
         " holes filled with " + std::to_string(report.filling_triangles) + " triangles");
    tell(report.removed_points, "repair-doublet", " points removed that only two polygons had");
    tell(report.holes_left, "hole-left", " holes left: too long to fill", Severity::warning);
    return findings;
}

}  // namespace hex
