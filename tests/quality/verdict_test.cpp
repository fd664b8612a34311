/// Agreement with Verdict: numbers that VTK 9.1's vtkMeshQuality gives for the published meshes, read with
/// the digits of their files.

#include "support/test_files.h"

#include <hex/io/hex_file.h>
#include <hex/quality/scaled_jacobian.h>

#include <gtest/gtest.h>

#include <cctype>

namespace {

struct Published {
    const char* file;
    std::size_t hexes;
    double min;
    double mean;
    std::size_t inverted;
};

constexpr Published published[] = {
    {"hex/edgecone_block_in.mesh", 2520, -0.69688345332306612, 0.76575906995333176, 31},
    {"hex/edgecone_block_out.mesh", 2520, 0.25010434944375376, 0.87019385214801293, 0},
    {"hex/edgecone_bunny_in.mesh", 37734, -0.0027514737706080556, 0.89818384288047137, 1},
    {"hex/edgecone_bunny_out.mesh", 37734, 0.60614866410205692, 0.97221876766006465, 0},
    {"hex/edgecone_bust_in.mesh", 5258, -0.59668991385130432, 0.73360056045147215, 30},
    {"hex/edgecone_bust_out.mesh", 5258, 0.11424632373722721, 0.92215535186421327, 0},
    {"hex/edgecone_cap_in.mesh", 4420, -0.93710657187715152, 0.73967611691357282, 50},
    {"hex/edgecone_cap_out.mesh", 4420, 0.1062438349709084, 0.87029507921912119, 0},
    {"hex/edgecone_hanger_stresstest_in.mesh", 4539, -0.99875030212145766, -0.3930931743021121, 3930},
    {"hex/edgecone_hanger_stresstest_out.mesh", 4539, 0.71624854994031151, 0.98726128481574271, 0},
    {"hex/medial_armchair.mesh", 1577, 0.1985917002940393, 0.90049806998941451, 0},
    {"hex/medial_beam.mesh", 444, 0.16044834433280586, 0.78970624791541799, 0},
    {"hex/medial_bird.mesh", 588, 0.1957412368334728, 0.72612572434325151, 0},
    {"hex/medial_fertility.mesh", 4384, 0.12444581272000689, 0.90139794061003076, 0},
    {"hex/medial_hand.mesh", 1368, 0.2436056904620037, 0.87539804107960861, 0},
    {"hex/screw2_2699.mesh", 2699, 0.21794280058687102, 0.81776912191062712, 0},
    {"hex/swivel2_7494.mesh", 7464, 0.26139961360478248, 0.8385077256740634, 0},
    {"paper/ant/ant_hex.vtk", 6176, 0.17497722651891645, 0.82854863736884732, 0},
    {"paper/ant/ant_hex_initial.vtk", 3392, 0.10322226567445721, 0.76458793091451704, 0},
    {"paper/fertility/fertility_hex.vtk", 4000, 0.20159465163897267, 0.79833805454005013, 0},
    {"paper/fertility/fertility_hex_initial.vtk", 2176, -0.36311374971034993, 0.68816993748310318, 20},
    {"paper/hepta/hepta_hex.vtk", 944, 0.24164905217258853, 0.89689442462092273, 0},
    {"paper/hepta/hepta_hex_initial.vtk", 944, 0.24164905217258853, 0.89689442462092273, 0},
    {"paper/joint/joint_hex.vtk", 6144, 0.1004486314054114, 0.68910213350841809, 0},
    {"paper/joint/joint_hex_initial.vtk", 6144, -0.19772704267040389, 0.68696767994381547, 36},
    {"paper/mount1/mount1_hex.vtk", 4480, 0.16218081782535565, 0.83771827822879252, 0},
    {"paper/mount1/mount1_hex_initial.vtk", 4480, -0.44829408959356709, 0.80292004954258422, 17},
    {"paper/rod/published/rod_hex_lap.vtk", 1280, 0.31950089371518148, 0.83217684175003193, 0},
    {"paper/rod/published/rod_hex_lap_pillow.vtk", 2272, -0.99900102800334711, 0.82217225211528056, 16},
    {"paper/rod/published/rod_hex_lap_pillow_smooth.vtk", 2272, -0.98905813775309293, 0.84041425491370558, 4},
    {"paper/rod/published/rod_hex_lap_pillow_smooth_opt.vtk", 2272, -0.96917099220349456, 0.83671637028266443,
     4},
    {"paper/rod/rod_hex.vtk", 1280, 0.31943195316479533, 0.83217649028638196, 0},
    {"paper/rod/rod_hex_paper_used.vtk", 1280, 0.31943170039232455, 0.80747027993706655, 0},
};

class Verdict : public testing::TestWithParam<Published> {};
INSTANTIATE_TEST_SUITE_P(Meshes, Verdict, testing::ValuesIn(published), [](const auto& test) {
    std::string name = test.param.file;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
});

TEST_P(Verdict, GivesTheSameNumbers) {
    HEX_NEEDS_REFERENCE_DATA();
    const Published& expected = GetParam();
    const hex::HexMesh mesh = hex::io::read_hex_mesh(hex::test::reference_data() / expected.file).mesh;
    const hex::QualitySummary summary = hex::summarize(mesh);
    EXPECT_EQ(summary.cells, expected.hexes);
    EXPECT_NEAR(summary.min, expected.min, 1e-12);
    EXPECT_NEAR(summary.mean, expected.mean, 1e-12);
    EXPECT_EQ(summary.inverted, expected.inverted);
}

}  // namespace
