/// The paper's rod.

#include "improve/improve_cases.h"
#include "support/test_files.h"

#include <hex/io/hex_file.h>
#include <hex/io/surface_file.h>
#include <hex/surface/polygon_soup.h>

#include <gtest/gtest.h>

namespace {

using hex::test::method;

std::filesystem::path rod(const std::string& file) {
    return hex::test::reference_data() / "paper" / "rod" / file;
}

TEST(PublishedRod, PillowHasThePublishedCells) {
    HEX_NEEDS_REFERENCE_DATA();
    const hex::HexMesh input = hex::io::read_hex_mesh(rod("published/rod_hex_lap.vtk")).mesh;
    const hex::HexMesh published = hex::io::read_hex_mesh(rod("published/rod_hex_lap_pillow.vtk")).mesh;
    const auto result = hex::improve(input, method("pillow", 1));
    ASSERT_EQ(result.mesh.cell_count(), 2272u);
    ASSERT_EQ(result.mesh.vertex_count(), published.vertex_count());
    EXPECT_TRUE(std::equal(result.mesh.cell_array().begin(), result.mesh.cell_array().end(),
                           published.cell_array().begin(), published.cell_array().end()));
    // The new boundary is the old one; inside, the layer is as thick as published but where that inverts.
    std::size_t as_published = 0;
    for (const hex::VertexId v : published.vertices())
        as_published += (result.mesh.position(v) - published.position(v)).norm() < 1e-4;
    EXPECT_GT(as_published, published.vertex_count() * 9 / 10);
    EXPECT_EQ(hex::summarize(published).inverted, 16u);
    EXPECT_EQ(result.report.after.inverted, 0u);
}

TEST(PublishedRod, PillowSmoothOptimizeEndBetterThanTheInput) {
    HEX_NEEDS_REFERENCE_DATA();
    const hex::TriangleMesh surface =
        hex::make_triangle_mesh(hex::io::read_surface(rod("rod_initial_read.k")).soup);
    hex::HexMesh mesh = hex::io::read_hex_mesh(rod("rod_hex_paper_used.vtk")).mesh;
    const hex::QualitySummary before = hex::summarize(mesh);
    const auto run = [&](const std::string& name, int count) {
        hex::ImproveOptions options = method(name, count, 0.01);
        options.surface = &surface;
        auto result = hex::improve(mesh, options);
        mesh = std::move(result.mesh);
        return result.report;
    };
    EXPECT_EQ(run("pillow", 1).after.inverted, 0u);
    EXPECT_TRUE(run("smooth", 50).diagnostics.empty());
    const hex::ImproveReport last = run("optimize", 15);
    EXPECT_GT(last.after.min, 0.319);
    EXPECT_GT(last.after.min, before.min);
    EXPECT_TRUE(last.diagnostics.empty()) << "every boundary vertex is on the surface";
}

}  // namespace
