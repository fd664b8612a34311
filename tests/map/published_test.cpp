/// The paper's models, compared with what its own implementation made of them.

#include "map/cases.h"
#include "support/test_files.h"

#include <hex/io/hex_file.h>
#include <hex/io/surface_file.h>
#include <hex/map/map.h>
#include <hex/quality/scaled_jacobian.h>

#include <gtest/gtest.h>

namespace hex {
namespace {

struct Model {
    const char* name;
    int level;
    std::size_t vertices;
    std::size_t hexes;
    double min_scaled_jacobian;  ///< at least, of the mesh before any improvement
    std::size_t inverted;        ///< at most
};

void PrintTo(const Model& model, std::ostream* out) {
    *out << model.name;
}

class Published : public ::testing::TestWithParam<Model> {
  protected:
    void SetUp() override {
        HEX_NEEDS_REFERENCE_DATA();
        const std::string name = GetParam().name;
        const auto folder = test::reference_data() / "paper" / name;
        surface_ = make_triangle_mesh(io::read_surface(folder / (name + "_initial_read.k")).soup);
        blocks_ = io::read_hex_mesh(folder / (name + "_polycube_structure_hex.k")).mesh;
        result_ = map(surface_, blocks_, {.level = GetParam().level});
    }
    TriangleMesh surface_;
    HexMesh blocks_;
    MapResult result_;
};

TEST_P(Published, CountsAndQuality) {
    EXPECT_EQ(result_.mesh.vertex_count(), GetParam().vertices);
    EXPECT_EQ(result_.mesh.cell_count(), GetParam().hexes);
    const QualitySummary quality = summarize(result_.mesh);
    EXPECT_EQ(quality.vertices, GetParam().vertices);
    EXPECT_GE(quality.min, GetParam().min_scaled_jacobian);
    EXPECT_LE(quality.inverted, GetParam().inverted);
}

/// The harmonic interior, the default, is better on the average and nowhere worse where it matters.
TEST_P(Published, HarmonicIsTheBestInterior) {
    const QualitySummary harmonic = summarize(result_.mesh);
    for (const Interior interior : {Interior::linear, Interior::transfinite}) {
        const HexMesh other = map(surface_, blocks_, {.level = GetParam().level, .interior = interior}).mesh;
        const QualitySummary quality = summarize(other);
        EXPECT_GE(harmonic.min, std::min(0.3, quality.min)) << name_of(interior);
        EXPECT_LE(harmonic.inverted, quality.inverted) << name_of(interior);
        if (interior == Interior::transfinite) {
            EXPECT_GT(harmonic.mean, quality.mean);
        }
    }
}

TEST_P(Published, TargetIsMetWithinTenPercent) {
    const MapResult result = map(surface_, blocks_, {.target_hexes = 4000, .interior = Interior::linear});
    EXPECT_NEAR(static_cast<double>(result.mesh.cell_count()), 4000, 400);
}

TEST_P(Published, IsConformingAndWatertight) {
    EXPECT_TRUE(inspect(result_.mesh).empty());
    EXPECT_GT(test::smallest_gap(result_.mesh), 1e-5 * bounding_box(surface_).diagonal());
}

TEST_P(Published, NoTriangleIsFlipped) {
    for (const PatchMapRecord& record : result_.report.patch_maps)
        EXPECT_EQ(record.flipped, 0U) << "patch " << record.patch;
    EXPECT_LT(result_.report.largest_snap, 1e-5);
}

/// A sample, not all: the search is by brute force.
TEST_P(Published, BoundaryVerticesLieOnTheTriangles) {
    const double diagonal = bounding_box(surface_).diagonal();
    const auto boundary = boundary_quads(result_.mesh).boundary_vertices;
    for (std::size_t i = 0; i < boundary.size(); i += 1 + boundary.size() / 400)
        EXPECT_LT(test::distance_to_surface(result_.mesh.position(boundary[i]), surface_), 1e-14 * diagonal);
}

// Counts, and the smallest scaled Jacobian; transfinite interpolation has these too, but for joint, as was
// measured independently. For ant that was -0.916 with 10 inverted elements, where edges along a side were
// not cut.
INSTANTIATE_TEST_SUITE_P(Models, Published,
                         ::testing::Values(Model{"rod", 2, 1815, 1280, 0.319, 0},
                                           Model{"hepta", 1, 1259, 944, 0.267, 0},
                                           Model{"mount1", 2, 5849, 4480, -0.0021, 2},
                                           Model{"fertility", 2, 3165, 2176, -0.1651, 7},
                                           Model{"ant", 2, 4925, 3392, -0.35, 4},
                                           Model{"joint", 2, 7512, 6144, 0.077, 0}),
                         [](const auto& model) { return std::string(model.param.name); });

struct Original {
    const char* name;
    const char* mesh;
    int level;
    double tolerance;     ///< its solver stops early and its files have six digits
    std::size_t outside;  ///< vertices that were moved by hand or by its repair of flips
};

void PrintTo(const Original& original, std::ostream* out) {
    *out << original.name;
}

class AgainstOriginal : public ::testing::TestWithParam<Original> {};

/// Every boundary vertex of the published mesh is one of ours.
TEST_P(AgainstOriginal, BoundaryVerticesAgree) {
    HEX_NEEDS_REFERENCE_DATA();
    const std::string name = GetParam().name;
    const auto folder = test::reference_data() / "paper" / name;
    const TriangleMesh surface =
        make_triangle_mesh(io::read_surface(folder / (name + "_initial_read.k")).soup);
    const HexMesh blocks = io::read_hex_mesh(folder / (name + "_polycube_structure_hex.k")).mesh;
    const HexMesh ours = map(surface, blocks, {.level = GetParam().level}).mesh;
    const HexMesh theirs = io::read_hex_mesh(folder / GetParam().mesh).mesh;
    const BoundaryQuads our_boundary = boundary_quads(ours);
    const BoundaryQuads their_boundary = boundary_quads(theirs);
    ASSERT_EQ(our_boundary.boundary_vertices.size(), their_boundary.boundary_vertices.size());
    std::size_t outside = 0;
    for (const VertexId v : their_boundary.boundary_vertices) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const VertexId w : our_boundary.boundary_vertices)
            nearest = std::min(nearest, (ours.position(w) - theirs.position(v)).norm());
        if (nearest > GetParam().tolerance) ++outside;
    }
    EXPECT_LE(outside, GetParam().outside);
}

INSTANTIATE_TEST_SUITE_P(Models, AgainstOriginal,
                         ::testing::Values(Original{"rod", "rod_hex.vtk", 2, 1.1e-4, 0},
                                           Original{"hepta", "hepta_hex_initial.vtk", 1, 2e-6, 0},
                                           Original{"mount1", "mount1_hex_initial.vtk", 2, 4.4e-3, 0},
                                           Original{"fertility", "fertility_hex_initial.vtk", 2, 1.2e-6, 0},
                                           Original{"ant", "ant_hex_initial.vtk", 2, 1e-3, 21},
                                           Original{"joint", "joint_hex_initial.vtk", 2, 1e-3, 35}),
                         [](const auto& original) { return std::string(original.param.name); });

}  // namespace
}  // namespace hex
