// Every published file reads, with the counts that are published with it.
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/list_file.h>
#include <hex/io/mesh_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace hex::io {
namespace {

std::filesystem::path paper(const std::string& model, const std::string& suffix) {
    return test::reference_data() / "paper" / model / (model + suffix);
}

struct Model {
    std::string name;
    std::size_t triangles, nodes, part_ids, blocks, block_nodes, initial_vertices, initial_hexahedra,
        final_hexahedra;
};

/// Counts of the published models; `final_hexahedra` is of NAME_hex.vtk.
const std::vector<Model> models = {{"rod", 4480, 2238, 48, 20, 60, 1815, 1280, 1280},
                                   {"mount1", 1782, 886, 164, 70, 164, 5849, 4480, 4480},
                                   {"hepta", 1348, 676, 128, 118, 204, 1259, 944, 944},
                                   {"ant", 14428, 7216, 117, 53, 176, 4925, 3392, 6176},
                                   {"fertility", 13256, 6622, 113, 34, 108, 3165, 2176, 4000},
                                   {"joint", 7612, 3806, 163, 96, 186, 7512, 6144, 6144}};

TEST(PublishedFiles, SegmentedSurfaceHasThePublishedCounts) {
    HEX_NEEDS_REFERENCE_DATA();
    for (const Model& model : models) {
        const auto file = read_surface(paper(model.name, "_initial_read.k"));
        EXPECT_EQ(file.soup.size(), model.triangles) << model.name;
        EXPECT_EQ(file.soup.points.size(), model.nodes) << model.name;
        EXPECT_EQ(std::set<int>(file.soup.parts.begin(), file.soup.parts.end()).size(), model.part_ids)
            << model.name;
        EXPECT_TRUE(file.diagnostics.empty()) << model.name;
        EXPECT_EQ(file.soup.corners.size(), 3 * model.triangles) << model.name << ": all are triangles";
    }
}

TEST(PublishedFiles, RawTrianglesReadWithGapsInTheNodeIds) {
    HEX_NEEDS_REFERENCE_DATA();
    for (const Model& model : models) {
        const auto file = read_surface(paper(model.name, "_tri.k"));
        EXPECT_GT(file.soup.size(), 0u) << model.name;
        EXPECT_TRUE(std::all_of(file.soup.parts.begin(), file.soup.parts.end(), [](int p) { return p == 1; }))
            << model.name;
        EXPECT_EQ(count_at_least(file.diagnostics, Severity::warning), 0u) << model.name;
    }
    // The ids of this one go up to 665 for 509 nodes: they are mapped, not used as indices.
    const auto hepta = read_surface(paper("hepta", "_tri.k")).soup;
    EXPECT_EQ(hepta.points.size(), 509u);
    EXPECT_EQ(hepta.size(), 1014u);
}

TEST(PublishedFiles, BlockStructuresHaveThePublishedCounts) {
    HEX_NEEDS_REFERENCE_DATA();
    for (const Model& model : models) {
        const auto file = read_hex_mesh(paper(model.name, "_polycube_structure_hex.k"));
        EXPECT_EQ(file.mesh.cell_count(), model.blocks) << model.name;
        EXPECT_EQ(file.mesh.vertex_count(), model.block_nodes) << model.name;
        EXPECT_THROW(read_surface(paper(model.name, "_polycube_structure_hex.k")), Error);
    }
}

TEST(PublishedFiles, HexMeshesHaveThePublishedCounts) {
    HEX_NEEDS_REFERENCE_DATA();
    for (const Model& model : models) {
        if (model.name != "rod") {
            const auto initial = read_hex_mesh(paper(model.name, "_hex_initial.vtk")).mesh;
            EXPECT_EQ(initial.vertex_count(), model.initial_vertices) << model.name;
            EXPECT_EQ(initial.cell_count(), model.initial_hexahedra) << model.name;
        }
        EXPECT_EQ(read_hex_mesh(paper(model.name, "_hex.vtk")).mesh.cell_count(), model.final_hexahedra)
            << model.name;
    }
}

TEST(PublishedFiles, PublishedResultsRead) {
    HEX_NEEDS_REFERENCE_DATA();
    const auto folder = test::reference_data() / "paper/rod/published";
    EXPECT_EQ(read_hex_mesh(folder / "rod_hex_gref_lev1_CM.vtk").mesh.vertex_count(), 12303u);
    EXPECT_EQ(read_hex_mesh(folder / "rod_hex_lap_pillow.vtk").mesh.cell_count(), 2272u);
    EXPECT_EQ(read_hex_mesh(folder / "rod_hex_gref_lev0_lref_hmesh1_CM.vtk").mesh.cell_count(), 480u);
    EXPECT_EQ(read_surface(folder / "rod_polycube_structure.k").soup.size(), 62u);
    EXPECT_EQ(read_surface(folder / "rod_initial_write.k").soup.size(), 4480u);
    // The cell scalar `patches` becomes the part id.
    const auto labels = read_surface(folder / "rod_tri_output_EWCVT_edit.vtk").soup;
    EXPECT_EQ(labels.size(), 4480u);
    const auto [least, most] = std::minmax_element(labels.parts.begin(), labels.parts.end());
    EXPECT_EQ(*least, 0);
    EXPECT_EQ(*most, 5);
}

struct HexCount {
    const char* name;
    std::size_t hexahedra, vertices;
};

TEST(PublishedFiles, MeditMeshesHaveThePublishedCounts) {
    HEX_NEEDS_REFERENCE_DATA();
    for (const HexCount& entry :
         {HexCount{"edgecone_block_in", 2520, 3180}, HexCount{"edgecone_block_out", 2520, 3180},
          HexCount{"edgecone_bust_in", 5258, 6314}, HexCount{"edgecone_cap_in", 4420, 5449},
          HexCount{"edgecone_hanger_stresstest_in", 4539, 6633}, HexCount{"edgecone_bunny_in", 37734, 41749},
          HexCount{"swivel2_7494", 7464, 9078}, HexCount{"screw2_2699", 2699, 3467}}) {
        const auto mesh =
            read_hex_mesh(test::reference_data() / "hex" / (std::string(entry.name) + ".mesh")).mesh;
        EXPECT_EQ(mesh.cell_count(), entry.hexahedra) << entry.name;
        EXPECT_EQ(mesh.vertex_count(), entry.vertices) << entry.name;
    }
}

TEST(PublishedFiles, AllOfAFolderRead) {
    HEX_NEEDS_REFERENCE_DATA();
    const auto files_of = [](const char* folder) {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(test::reference_data() / folder))
            files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        return files;
    };
    for (const auto& path : files_of("hex")) EXPECT_NO_THROW(read_hex_mesh(path)) << path;
    for (const auto& path : files_of("surfaces")) EXPECT_GT(read_surface(path).soup.size(), 0u) << path;
    // Surfaces with holes and worse are polygons all the same.
    for (const auto& path : files_of("broken")) EXPECT_GT(read_surface(path).soup.size(), 0u) << path;
    EXPECT_EQ(files_of("surfaces").size(), 30u);
}

TEST(PublishedFiles, PolygonsStayPolygons) {
    HEX_NEEDS_REFERENCE_DATA();
    const auto cylinder = read_surface(test::reference_data() / "surfaces/cylinder.obj").soup;
    std::size_t most = 0;
    for (std::size_t f = 0; f < cylinder.size(); ++f) most = std::max(most, cylinder.polygon(f).size());
    EXPECT_GT(most, 3u);
}

TEST(PublishedFiles, TextFilesOfThePaperRead) {
    HEX_NEEDS_REFERENCE_DATA();
    const auto rod = test::reference_data() / "paper/rod";
    const auto overrides = read_overrides(rod / "rod_manual.txt");
    EXPECT_EQ(overrides.size(), 56u);
    EXPECT_EQ(overrides.front().triangle, 354);
    EXPECT_EQ(overrides.front().label, 0);
    const auto sharp = read_sharp_vertices(rod / "sharp.txt");
    EXPECT_EQ(sharp.size(), 124u);
    EXPECT_EQ(sharp.front(), 1426);
    const auto refinement = read_refinement(rod / "lev_rfid.txt");
    ASSERT_EQ(refinement.size(), 2u);
    EXPECT_EQ(refinement[0].size(), 16u);
    EXPECT_EQ(refinement[0].front(), 950);
    auto second = refinement[1];
    std::sort(second.begin(), second.end());
    EXPECT_EQ(second, (std::vector<std::int64_t>{84, 85, 102, 103}));
}

}  // namespace
}  // namespace hex::io
