#include "spline_samples.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/hex_file.h>
#include <hex/io/list_file.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace spline::test {
namespace {

using hex::CellId;
using hex::VertexId;

bool has_code(const hex::Diagnostics& diagnostics, const std::string& code) {
    return std::any_of(diagnostics.begin(), diagnostics.end(), [&](const auto& d) { return d.code == code; });
}

TEST(Spline, ReportOfAFan) {
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.global_refinements = 1;
    const SplineResult result = build(hex::test::fan(5, 2), options);
    const SplineReport& report = result.report;
    EXPECT_EQ(report.method, "thspline3d");
    EXPECT_EQ(report.input_elements, 10U);
    EXPECT_EQ(report.summary.elements, 80U);
    EXPECT_EQ(report.boundary_elements + report.irregular_elements + report.regular_elements, 80U);
    EXPECT_EQ(report.extraordinary_edges, (std::map<int, std::size_t>{{5, 4}}));
    EXPECT_EQ(result.spline.function_count(), result.levels[0].mesh.vertex_count());
    EXPECT_LE(report.summary.partition_of_unity_error, 1e-15);
    EXPECT_GT(report.summary.smallest_coefficient, 0.0);
    EXPECT_EQ(report.summary.functions_min > 0, true);
}

TEST(Spline, IsTheSameForAnyNumberOfThreads) {
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.refinement = {{0, 1, 2, 3}, {0, 9}};
    options.global_refinements = 1;
    hex::Context one, two;
    one.threads = 1;
    two.threads = 2;
    const SplineResult a = build(hex::test::fan(6, 3), options, one),
                       b = build(hex::test::fan(6, 3), options, two);
    EXPECT_EQ(a.spline.control_points, b.spline.control_points);
    EXPECT_EQ(a.spline.rows.offsets, b.spline.rows.offsets);
    EXPECT_EQ(a.spline.rows.columns, b.spline.rows.columns);
    EXPECT_EQ(a.spline.rows.values, b.spline.rows.values);
    EXPECT_EQ(a.spline.elements, b.spline.elements);
}

TEST(Spline, GlobalThenLocalRefinement) {
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.global_refinements = 1;
    options.refinement = {{63}};
    const SplineResult result = build(hex::test::grid(2, 2, 2), options);
    ASSERT_EQ(result.report.levels.size(), 2U);
    EXPECT_EQ(result.report.levels[0].elements, 64U);
    EXPECT_EQ(result.report.levels[0].active_elements, 63U);
    EXPECT_EQ(result.report.levels[1].active_elements, 8U);
    EXPECT_EQ(result.spline.element_count(), 71U);
    options.levels = 0;
    EXPECT_EQ(build(hex::test::grid(2, 2, 2), options).spline.element_count(), 64U);
}

TEST(Spline, UnusedVerticesAreDropped) {
    const hex::HexMesh grid = hex::test::grid(2, 2, 2);
    std::vector<hex::Vec3> positions = {hex::Vec3(9, 9, 9)};
    positions.insert(positions.end(), grid.positions().begin(), grid.positions().end());
    std::vector<hex::HexCell> cells(grid.cell_array().begin(), grid.cell_array().end());
    for (auto& cell : cells) {
        for (VertexId& v : cell) v = VertexId(v.index() + 1);
    }
    const hex::HexMesh shifted(positions, cells);
    SplineOptions options;
    options.features = hex::FeatureSource::list;
    options.feature_vertices = {1, 2, 3};
    const SplineResult with = build(shifted, options);
    options.feature_vertices = {0, 1, 2};
    const SplineResult without = build(grid, options);
    EXPECT_TRUE(has_code(with.report.diagnostics, "unused-vertices"));
    EXPECT_EQ(with.spline.control_points, without.spline.control_points);
    EXPECT_EQ(with.spline.rows.values, without.spline.rows.values);
    EXPECT_EQ(with.report.sharp_edges, 2U);
}

TEST(Spline, InvertedElementsAreNamedUnlessForced) {
    hex::HexMesh mesh = hex::test::grid(3, 3, 3);
    mesh.set_position(VertexId(0), hex::Vec3(5, 5, 5));
    try {
        build(mesh);
        FAIL();
    } catch (const hex::Error& error) {
        EXPECT_EQ(error.kind(), hex::ErrorKind::bad_input);
        EXPECT_NE(error.problem().find("1 inverted elements: 0"), std::string::npos) << error.what();
    }
    SplineOptions options;
    options.force = true;
    EXPECT_TRUE(has_code(build(mesh, options).report.diagnostics, "inverted-elements"));
}

TEST(Spline, ElementsThatOnlyTouchAreAnError) {
    // Two opposite corners of a square of four cubes, then two of a cube of eight.
    for (const bool edge : {true, false}) {
        const hex::HexMesh grid = hex::test::grid(2, 2, edge ? 1 : 2);
        std::vector<hex::HexCell> cells = {grid.cell(hex::CellId(0U)),
                                           grid.cell(hex::CellId(edge ? 3U : 7U))};
        const hex::HexMesh mesh({grid.positions().begin(), grid.positions().end()}, cells);
        SplineOptions options;
        try {
            build(mesh, options);
            ADD_FAILURE() << "must be refused";
        } catch (const hex::Error& error) {
            EXPECT_EQ(error.kind(), hex::ErrorKind::bad_input);
            EXPECT_NE(error.problem().find("2 elements only touch"), std::string::npos) << error.what();
            EXPECT_NE(error.problem().find(edge ? "4-13" : "13"), std::string::npos) << error.what();
            EXPECT_NE(error.problem().find("0, 1"), std::string::npos) << error.what();
        }
        options.force = true;
        const SplineReport report = build(mesh, options).report;
        EXPECT_TRUE(has_code(report.diagnostics, "non-manifold"));
        EXPECT_EQ(report.summary.elements, 2U);
        EXPECT_LE(report.summary.partition_of_unity_error, 1e-14);
    }
}

TEST(Spline, WrongOptionsAreUsageErrors) {
    const hex::HexMesh mesh = hex::test::grid(2, 2, 2);
    const auto kind_of = [&](const SplineOptions& options) {
        try {
            build(mesh, options);
        } catch (const hex::Error& error) {
            return error.kind();
        }
        return hex::ErrorKind::no_result;
    };
    SplineOptions options;
    options.global_refinements = -1;
    EXPECT_EQ(kind_of(options), hex::ErrorKind::usage);
    options = {};
    options.feature_cosine = 1.5;
    EXPECT_EQ(kind_of(options), hex::ErrorKind::usage);
    options = {};
    options.method = "nobody";
    EXPECT_EQ(kind_of(options), hex::ErrorKind::usage);
    options = {};
    options.features = hex::FeatureSource::list;
    options.feature_vertices = {27};
    EXPECT_EQ(kind_of(options), hex::ErrorKind::bad_input);
    EXPECT_THROW(build(hex::HexMesh()), hex::Error);
}

TEST(Spline, EvaluateAgreesWithFiniteDifferences) {
    const SplineResult result = build(hex::test::fan(3, 2));
    const auto points = bezier_points(result.spline);
    const hex::Vec3 at(0.3, 0.6, 0.2);
    const double step = 1e-6;
    const ElementPoint here = evaluate(result.spline, points, 1, at);
    for (Eigen::Index a = 0; a < 3; ++a) {
        hex::Vec3 h = hex::Vec3::Zero();
        h[a] = step;
        const hex::Vec3 slope = (evaluate(result.spline, points, 1, at + h).point -
                                 evaluate(result.spline, points, 1, at - h).point) /
                                (2 * step);
        EXPECT_LE((slope - here.jacobian.col(a)).norm(), 1e-8);
    }
}

TEST(Spline, EvaluateTakesWeightsIntoAccount) {
    // A rational quadratic arc raised to degree 3 along u: points stay on the unit circle.
    BezierSpline s;
    const double w = std::sqrt(0.5);
    const std::array<hex::Vec3, 3> arc = {hex::Vec3(1, 0, 0), hex::Vec3(1, 1, 0), hex::Vec3(0, 1, 0)};
    const std::array<double, 3> weight = {1, w, 1};
    const double raise[4][3] = {{1, 0, 0}, {1. / 3, 2. / 3, 0}, {0, 2. / 3, 1. / 3}, {0, 0, 1}};
    s.elements.emplace_back();
    for (std::size_t p = 0; p < 64; ++p) {
        const double* r = raise[p % 4];
        const double pw = r[0] * weight[0] + r[1] * weight[1] + r[2] * weight[2];
        hex::Vec3 x =
            (r[0] * weight[0] * arc[0] + r[1] * weight[1] * arc[1] + r[2] * weight[2] * arc[2]) / pw;
        x[2] = static_cast<double>(p / 16) / 3.0;
        s.control_points.push_back(x);
        s.weights.push_back(pw);
        s.rows.columns.push_back(static_cast<std::uint32_t>(p));
        s.rows.values.push_back(1.0);
        s.rows.offsets.push_back(p + 1);
        s.elements[0][p] = static_cast<std::uint32_t>(p);
    }
    EXPECT_TRUE(s.rational());
    const auto points = bezier_points(s);
    for (const double u : {0.0, 0.2, 0.5, 0.9}) {
        const ElementPoint e = evaluate(s, points, 0, hex::Vec3(u, 0.3, 0.4));
        EXPECT_NEAR(e.point.head<2>().norm(), 1.0, 1e-15);
        EXPECT_NEAR(e.point.head<2>().dot(e.jacobian.col(0).head<2>()), 0.0, 1e-14);
    }
}

/// The paper's rod as the published program was run on it.
struct Rod {
    std::filesystem::path folder = hex::test::reference_data() / "paper" / "rod";
    hex::HexMesh mesh = hex::io::read_hex_mesh(folder / "rod_hex_paper_used.vtk").mesh;
    SplineOptions options;

    Rod() {
        options.features = hex::FeatureSource::list;
        options.feature_vertices = hex::io::read_sharp_vertices(folder / "sharp.txt");
    }
};

/// Numbers after a keyword's line of a legacy VTK file.
std::vector<double> numbers_after(const std::filesystem::path& path, const std::string& keyword,
                                  std::size_t skip_words, std::size_t count) {
    std::istringstream text(hex::test::read_text(path));
    std::string word;
    while (text >> word && word != keyword) {
    }
    for (std::size_t i = 0; i < skip_words; ++i) text >> word;
    std::vector<double> numbers(count);
    for (double& x : numbers) text >> x;
    EXPECT_TRUE(text) << path << ' ' << keyword;
    return numbers;
}

TEST(SplineRod, ClassesOfElementsAndFeatures) {
    HEX_NEEDS_REFERENCE_DATA();
    Rod rod;
    const SplineReport report = build(rod.mesh, rod.options).report;
    EXPECT_EQ(report.boundary_elements, 820U);
    EXPECT_EQ(report.irregular_elements, 20U);
    EXPECT_EQ(report.regular_elements, 440U);
    EXPECT_EQ(report.extraordinary_edges, (std::map<int, std::size_t>{{5, 8}}));
    EXPECT_EQ(report.sharp_edges, 128U);
    EXPECT_EQ(report.crease_vertices, 116U);
    EXPECT_EQ(report.corner_vertices, 8U);
    EXPECT_EQ(report.refinable_elements, 1280U - 168U);
    EXPECT_EQ(report.summary.functions_min, 27U);
    EXPECT_EQ(report.summary.functions_max, 72U);
}

TEST(SplineRod, SamplesAreThePublishedOnes) {
    HEX_NEEDS_REFERENCE_DATA();
    Rod rod;
    const SplineResult result = build(rod.mesh, rod.options);
    const auto points = bezier_points(result.spline);
    const auto published =
        numbers_after(rod.folder / "published" / "rod_hex_gref_lev0_disp.vtk", "POINTS", 2, 1280 * 64 * 3);
    double largest = 0.0;
    for (std::size_t s = 0; s < 1280 * 64; ++s) {
        const std::size_t p = s % 64;
        const hex::Vec3 uvw(static_cast<double>(p % 4) / 3, static_cast<double>(p / 4 % 4) / 3,
                            static_cast<double>(p / 16) / 3);
        const hex::Vec3 x(published[3 * s], published[3 * s + 1], published[3 * s + 2]);
        largest = std::max(largest, (evaluate(result.spline, points, s / 64, uvw).point - x).norm());
    }
    EXPECT_LE(largest, 1.1e-4);
}

TEST(SplineRod, LocalRefinementHasThePublishedLevels) {
    HEX_NEEDS_REFERENCE_DATA();
    Rod rod;
    rod.options.refinement = hex::io::read_refinement(rod.folder / "lev_rfid.txt");
    rod.options.closure = false;
    const SplineResult result = build(rod.mesh, rod.options);
    EXPECT_EQ(result.spline.function_count(), 1851U);
    EXPECT_EQ(result.spline.element_count(), 1420U);
    EXPECT_LE(result.report.summary.partition_of_unity_error, 1e-14);
    EXPECT_EQ(result.report.summary.functions_min, 27U);
    EXPECT_EQ(result.report.summary.functions_max, 72U);
    EXPECT_NEAR(result.report.summary.functions_mean, 52.76, 0.005);
    ASSERT_EQ(result.levels.size(), 3U);
    for (std::size_t l = 0; l < 3; ++l) {
        const auto path =
            rod.folder / "published" / ("rod_hex_gref_lev0_lref_hmesh" + std::to_string(l) + "_CM.vtk");
        const ControlMesh& level = result.levels[l];
        const std::size_t vertices = level.mesh.vertex_count(), cells = level.mesh.cell_count();
        ASSERT_EQ(numbers_after(path, "POINTS", 0, 1)[0], static_cast<double>(vertices));
        ASSERT_EQ(numbers_after(path, "CELLS", 0, 1)[0], static_cast<double>(cells));
        const auto points = numbers_after(path, "POINTS", 2, 3 * vertices);
        const auto corners = numbers_after(path, "CELLS", 2, 9 * cells);
        const auto pact = numbers_after(path, "pact", 4, vertices);
        const auto eact = numbers_after(path, "eact", 4, cells);
        for (std::size_t v = 0; v < vertices; ++v) {
            EXPECT_EQ(pact[v], level.function_active[v]);
            for (std::size_t a = 0; a < 3; ++a)
                EXPECT_NEAR(points[3 * v + a], level.mesh.position(VertexId(v))[static_cast<Eigen::Index>(a)],
                            5.1e-5);
        }
        for (std::size_t c = 0; c < cells; ++c) {
            EXPECT_EQ(eact[c], level.element_active[c]);
            for (std::size_t k = 0; k < 8; ++k)
                EXPECT_EQ(corners[9 * c + 1 + k], static_cast<double>(level.mesh.cell(CellId(c))[k].value()));
        }
    }
}

TEST(SplineRod, GlobalRefinementIsThePublishedMesh) {
    HEX_NEEDS_REFERENCE_DATA();
    Rod rod;
    rod.options.global_refinements = 1;
    const SplineResult result = build(rod.mesh, rod.options);
    ASSERT_EQ(result.spline.function_count(), 12303U);
    const auto points =
        numbers_after(rod.folder / "published" / "rod_hex_gref_lev1_CM.vtk", "POINTS", 2, 3 * 12303);
    for (std::size_t v = 0; v < 12303; ++v) {
        for (std::size_t a = 0; a < 3; ++a)
            EXPECT_NEAR(points[3 * v + a], result.spline.control_points[v][static_cast<Eigen::Index>(a)],
                        5.1e-5);
    }
}

}  // namespace
}  // namespace spline::test
