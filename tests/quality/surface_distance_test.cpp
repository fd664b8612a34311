#include "support/meshes.h"

#include <hex/base/error.h>
#include <hex/quality/surface_distance.h>
#include <hex/surface/polygon_soup.h>

#include <gtest/gtest.h>

#include <cmath>

namespace hex {
namespace {

TEST(SurfaceDistance, OfAGridFromItsOwnBoundaryIsZero) {
    const SurfaceDistance d =
        surface_distance(test::grid(3, 2, 4), make_triangle_mesh(test::box_surface(3, 2, 4)));
    EXPECT_NEAR(d.max(), 0, 1e-14);
    EXPECT_DOUBLE_EQ(d.diagonal, std::sqrt(9.0 + 4.0 + 16.0));
}

TEST(SurfaceDistance, IsMeasuredInBothDirections) {
    // The surface goes 1 further in x: only the faces at its far end see that from the mesh.
    const SurfaceDistance d =
        surface_distance(test::grid(4, 4, 4), make_triangle_mesh(test::box_surface(5, 4, 4)));
    EXPECT_DOUBLE_EQ(d.to_surface_max, 1);
    EXPECT_DOUBLE_EQ(d.from_surface_max, 1);
    EXPECT_DOUBLE_EQ(d.vertex_max, 1);
    EXPECT_LT(d.to_surface_mean, 0.2);
    EXPECT_DOUBLE_EQ(d.percent(d.max()), 100 / std::sqrt(57.0));
}

TEST(SurfaceDistance, TheFarthestVertexIsNamed) {
    HexMesh mesh = test::grid(2, 2, 2);
    mesh.set_position(VertexId(26), {2.5, 2, 2});
    const SurfaceDistance d = surface_distance(mesh, make_triangle_mesh(test::box_surface(2, 2, 2)));
    EXPECT_EQ(d.farthest_vertex, VertexId(26));
    EXPECT_DOUBLE_EQ(d.vertex_max, 0.5);
}

TEST(SurfaceDistance, TheSameBitsForAnyNumberOfThreads) {
    const HexMesh mesh = test::grid(12, 12, 12);
    const TriangleMesh surface = make_triangle_mesh(test::box_surface(12.3, 11.9, 12.1, 9));
    Context one, two;
    one.threads = 1;
    two.threads = 2;
    const SurfaceDistance a = surface_distance(mesh, surface, one), b = surface_distance(mesh, surface, two);
    EXPECT_EQ(a.to_surface_mean, b.to_surface_mean);
    EXPECT_EQ(a.from_surface_max, b.from_surface_max);
}

TEST(SurfaceDistance, NeedsAMeshAndASurface) {
    EXPECT_THROW(surface_distance(HexMesh(), make_triangle_mesh(test::box_surface(1, 1, 1))), Error);
    EXPECT_THROW(surface_distance(test::grid(1, 1, 1), TriangleMesh()), Error);
}

}  // namespace
}  // namespace hex
