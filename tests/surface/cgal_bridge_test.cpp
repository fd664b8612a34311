#include "support/meshes.h"

#include <hex/surface/cgal_bridge.h>
#include <hex/surface/polygon_soup.h>

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/transform.h>
#include <CGAL/boost/graph/helpers.h>
#include <gtest/gtest.h>

namespace hex {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;

/// A box whose coordinates are no floats, so that a rounding to float would show.
TriangleMesh precise_box() {
    PolygonSoup soup = test::box_surface(1, 2, 3, 2);
    for (Vec3& p : soup.points) p = p * (1.0 / 3.0) + Vec3(0.1, 0.2, 0.3);
    return make_triangle_mesh(soup);
}

void expect_same(const TriangleMesh& a, const TriangleMesh& b) {
    ASSERT_EQ(a.n_vertices(), b.n_vertices());
    ASSERT_EQ(a.n_faces(), b.n_faces());
    for (const auto v : a.vertices()) EXPECT_EQ(a.point(v), b.point(v));
    for (const auto f : a.faces()) {
        EXPECT_EQ(a.data(f).part, b.data(f).part);
        std::vector<int> in_a, in_b;
        for (const auto v : a.fv_range(f)) in_a.push_back(v.idx());
        for (const auto v : b.fv_range(f)) in_b.push_back(v.idx());
        std::rotate(in_b.begin(), std::find(in_b.begin(), in_b.end(), in_a[0]), in_b.end());
        EXPECT_EQ(in_a, in_b);
    }
}

TEST(CgalBridge, SurfaceMeshAndBackIsTheSameMesh) {
    const TriangleMesh mesh = precise_box();
    const CgalSurfaceMesh cgal = to_surface_mesh(mesh);
    EXPECT_TRUE(CGAL::is_closed(cgal));
    EXPECT_NEAR(PMP::volume(cgal), enclosed_volume(mesh), 1e-14);
    expect_same(mesh, from_cgal(cgal));
}

TEST(CgalBridge, PolyhedronAndBackIsTheSameMesh) {
    const TriangleMesh mesh = precise_box();
    const CgalPolyhedron cgal = to_polyhedron(mesh);
    EXPECT_TRUE(cgal.is_closed());
    EXPECT_TRUE(cgal.is_valid());
    expect_same(mesh, from_cgal(cgal));
}

TEST(CgalBridge, PolyhedronDropsIsolatedVertices) {
    PolygonSoup soup = test::box_surface(1, 1, 1);
    soup.points.insert(soup.points.begin(), Vec3(9, 9, 9));
    for (auto& c : soup.corners) ++c;
    const TriangleMesh mesh = make_triangle_mesh(soup);
    EXPECT_EQ(to_polyhedron(mesh).size_of_vertices(), 8U);
    EXPECT_EQ(to_surface_mesh(mesh).number_of_vertices(), 9U);
}

TEST(CgalBridge, PolygonMeshesKeepTheirPolygons) {
    PolygonSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
    soup.add_polygon(std::array<std::uint32_t, 4>{0, 3, 2, 1}, 7);
    for (std::uint32_t i = 0; i < 4; ++i)
        soup.add_polygon(std::array<std::uint32_t, 3>{i, (i + 1) % 4, 4}, 8);
    const PolyMesh mesh = make_poly_mesh(soup);
    const auto surface = to_surface_mesh(mesh);
    EXPECT_EQ(surface.number_of_faces(), 5U);
    EXPECT_EQ(surface.degree(*surface.faces().begin()), 4U);
    EXPECT_EQ(to_polyhedron(mesh).size_of_facets(), 5U);
    EXPECT_EQ(from_cgal(surface).n_faces(), 6U);
    EXPECT_EQ(from_cgal(surface).data(TriangleMesh::FaceHandle(0)).part, 7);
}

TEST(CgalBridge, CgalAlgorithmsRunOnOpenMeshInFullPrecision) {
    TriangleMesh mesh = precise_box();
    const double volume = enclosed_volume(mesh);
    EXPECT_NEAR(
        PMP::volume(mesh,
                    PMP::parameters::vertex_point_map(vertex_point_map(mesh)).geom_traits(CgalKernel())),
        volume, 1e-14);
    // Moves every vertex through `put`: CGAL's own map for OpenMesh would round to float here.
    const CGAL::Aff_transformation_3<CgalKernel> shift(CGAL::TRANSLATION,
                                                       CgalKernel::Vector_3(0.7, 0.7, 0.7));
    const TriangleMesh before = mesh;
    PMP::transform(shift, mesh, PMP::parameters::vertex_point_map(vertex_point_map(mesh)));
    for (const auto v : mesh.vertices()) {
        for (int i = 0; i < 3; ++i) EXPECT_EQ(mesh.point(v)[i], before.point(v)[i] + 0.7);
    }
}

}  // namespace
}  // namespace hex
