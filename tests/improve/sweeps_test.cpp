/// What holds for every method that moves vertices.

#include "improve/improve_cases.h"

#include <hex/base/error.h>
#include <hex/surface/polygon_soup.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using hex::test::method;
using hex::test::shaken_grid;

class Sweeps : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Sweeps, testing::Values("laplace", "smooth", "optimize"));

TEST_P(Sweeps, NeverLowerTheMinimumNorAddInvertedElements) {
    for (const double amount : {0.2, 0.45, 0.8}) {
        const hex::HexMesh mesh = shaken_grid(6, 5, 4, amount, 1);
        const auto result = hex::improve(mesh, method(GetParam(), 10, 0.3));
        double min = result.report.before.min;
        std::size_t inverted = result.report.before.inverted;
        for (const auto& record : result.report.history) {
            EXPECT_GE(record.min, min - 1e-14) << "sweep " << record.sweep;
            EXPECT_LE(record.inverted, inverted) << "sweep " << record.sweep;
            min = record.min;
            inverted = record.inverted;
        }
        EXPECT_GE(result.report.after.min, result.report.before.min);
        EXPECT_LE(result.report.after.inverted, result.report.before.inverted);
    }
}

TEST_P(Sweeps, MakeAShakenGridBetterOnAverage) {
    const hex::HexMesh mesh = shaken_grid(8, 8, 8, 0.3, 2);
    const auto result = hex::improve(mesh, method(GetParam(), 30, 0.5));
    EXPECT_GT(result.report.after.mean, result.report.before.mean + 0.05);
    EXPECT_GT(result.report.after.min, result.report.before.min);
}

TEST_P(Sweeps, LeaveAPerfectGridAlone) {
    const hex::HexMesh mesh = hex::test::grid(4, 4, 4);
    const auto result = hex::improve(mesh, method(GetParam(), 3));
    for (const hex::VertexId v : mesh.vertices())
        EXPECT_NEAR((result.mesh.position(v) - mesh.position(v)).norm(), 0.0, 1e-14);
}

TEST_P(Sweeps, RecordWhatTheMeshShows) {
    const auto result = hex::improve(shaken_grid(5, 5, 5, 0.3, 3), method(GetParam(), 4, 0.2));
    ASSERT_EQ(result.report.history.size(), 4u);
    const hex::QualitySummary after = hex::summarize(result.mesh);
    EXPECT_NEAR(result.report.history.back().min, after.min, 1e-14);
    EXPECT_NEAR(result.report.history.back().mean, after.mean, 1e-14);
    EXPECT_EQ(result.report.history.back().inverted, after.inverted);
    EXPECT_GT(result.report.history.front().moved, 0u);
    EXPECT_EQ(result.report.method, GetParam());
}

TEST_P(Sweeps, GiveTheSameBytesForAnyNumberOfThreads) {
    const hex::HexMesh mesh = shaken_grid(9, 8, 7, 0.4, 4);
    const hex::TriangleMesh surface = hex::make_triangle_mesh(hex::test::box_surface(9, 8, 7, 3));
    hex::ImproveOptions options = method(GetParam(), 5, 0.3);
    options.surface = &surface;
    const auto one = hex::improve(mesh, options, hex::test::with_thread_count(1));
    for (const int threads : {2, 5}) {
        const auto many = hex::improve(mesh, options, hex::test::with_thread_count(threads));
        EXPECT_TRUE(hex::test::identical(one.mesh, many.mesh)) << threads << " threads";
        EXPECT_EQ(one.report.after.mean, many.report.after.mean);
    }
}

TEST_P(Sweeps, KeepBoxEdgesAndCorners) {
    const hex::HexMesh mesh = shaken_grid(5, 4, 3, 0.35, 5);
    const auto result = hex::improve(mesh, method(GetParam(), 20, 0.5));
    const hex::Vec3 top(5, 4, 3);
    for (const hex::VertexId v : mesh.vertices()) {
        for (Eigen::Index d = 0; d < 3; ++d) {
            const double before = mesh.position(v)[d];
            if (before == 0.0 || before == top[d]) {
                EXPECT_NEAR(result.mesh.position(v)[d], before, 1e-13) << v;
            }
        }
    }
}

TEST_P(Sweeps, StopWhenNothingMovesAnyMore) {
    const auto result = hex::improve(hex::test::grid(1, 1, 1), method(GetParam(), 40));
    ASSERT_EQ(result.report.history.size(), 1u);
    EXPECT_EQ(result.report.history[0].moved, 0u);
}

TEST_P(Sweeps, CanBeCancelled) {
    std::stop_source source;
    hex::Context context;
    context.stop = source.get_token();
    int sweeps = 0;
    context.on_progress = [&](std::string_view, double) {
        if (++sweeps == 2) source.request_stop();
    };
    try {
        (void)hex::improve(shaken_grid(4, 4, 4, 0.3, 6), method(GetParam(), 100, 0.1), context);
        FAIL() << "not cancelled";
    } catch (const hex::Error& error) {
        EXPECT_EQ(error.kind(), hex::ErrorKind::cancelled);
        EXPECT_EQ(sweeps, 2);
    }
}

TEST_P(Sweeps, AcceptZeroSweeps) {
    const hex::HexMesh mesh = shaken_grid(3, 3, 3, 0.3, 7);
    const auto result = hex::improve(mesh, method(GetParam(), 0));
    EXPECT_TRUE(hex::test::identical(result.mesh, mesh));
    EXPECT_TRUE(result.report.history.empty());
}

TEST(Laplace, PutsALoneInteriorVertexInTheMiddle) {
    hex::HexMesh mesh = hex::test::grid(2, 2, 2);
    mesh.set_position(hex::VertexId(13), {1.3, 0.8, 1.1});
    const auto result = hex::improve(mesh, method("laplace", 1));
    EXPECT_NEAR((result.mesh.position(hex::VertexId(13)) - hex::Vec3(1, 1, 1)).norm(), 0.0, 1e-14);
}

TEST(Laplace, KeepsTheBoundary) {
    const hex::HexMesh mesh = shaken_grid(4, 4, 4, 0.3, 8);
    const auto result = hex::improve(mesh, method("laplace", 5));
    for (const hex::VertexId v : hex::boundary_quads(mesh).boundary_vertices)
        EXPECT_EQ(result.mesh.position(v), mesh.position(v));
}

/// Volume of a trilinear hexahedron by 2 x 2 x 2 Gauss points.
double gauss_volume(const std::array<hex::Vec3, 8>& p) {
    const double g = 0.5 / std::sqrt(3.0);
    double volume = 0.0;
    for (const double u : {0.5 - g, 0.5 + g})
        for (const double v : {0.5 - g, 0.5 + g})
            for (const double w : {0.5 - g, 0.5 + g}) {
                Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
                for (std::size_t c = 0; c < 8; ++c) {
                    const auto& at = hex::hexahedron::corner_uvw[c];
                    const auto weight = [](int side, double t) { return side == 1 ? t : 1.0 - t; };
                    const auto slope = [](int side) { return side == 1 ? 1.0 : -1.0; };
                    jacobian.col(0) += slope(at[0]) * weight(at[1], v) * weight(at[2], w) * p[c];
                    jacobian.col(1) += weight(at[0], u) * slope(at[1]) * weight(at[2], w) * p[c];
                    jacobian.col(2) += weight(at[0], u) * weight(at[1], v) * slope(at[2]) * p[c];
                }
                volume += jacobian.determinant() / 8.0;
            }
    return volume;
}

/// Options under which only the vertices not listed can move: all others are sharp, with many sharp edges.
hex::ImproveOptions only_free(const hex::HexMesh& mesh, std::int64_t free, double step) {
    hex::ImproveOptions options = method("smooth", 1, step);
    options.features = hex::FeatureSource::list;
    for (std::int64_t v = 0; v < static_cast<std::int64_t>(mesh.vertex_count()); ++v)
        if (v != free) options.feature_vertices.push_back(v);
    return options;
}

TEST(Smooth, MovesAnInteriorVertexTowardsTheVolumeCentre) {
    hex::HexMesh mesh = hex::test::grid(2, 2, 2);
    const hex::VertexId middle(13);
    mesh.set_position(middle, {1.3, 0.8, 1.15});
    hex::Vec3 centre = hex::Vec3::Zero();
    double volume = 0.0;
    for (const hex::CellId c : mesh.cells()) {
        const auto corners = mesh.corner_positions(c);
        const double part = gauss_volume(corners);
        for (const hex::Vec3& p : corners) centre += part / 8.0 * p;
        volume += part;
    }
    EXPECT_NEAR(volume, 8.0, 1e-13);
    const hex::Vec3 expected = mesh.position(middle) + 0.1 * (centre / volume - mesh.position(middle));
    const auto result = hex::improve(mesh, only_free(mesh, 13, 0.1));
    EXPECT_NEAR((result.mesh.position(middle) - expected).norm(), 0.0, 1e-14);
}

TEST(Smooth, MovesABoundaryVertexTowardsTheAreaCentre) {
    hex::HexMesh mesh = hex::test::grid(2, 2, 2);
    const hex::VertexId top(22);
    mesh.set_position(top, {1.3, 0.8, 2.0});
    // Areas and centres of the four flat quads of the top.
    hex::Vec3 centre = hex::Vec3::Zero();
    double area = 0.0;
    const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    for (const hex::QuadId q : boundary.vertex_quads[top.index()]) {
        std::array<hex::Vec3, 4> p;
        for (std::size_t i = 0; i < 4; ++i) p[i] = mesh.position(boundary.vertices[q.index()][i]);
        const double part = 0.5 * (p[2] - p[0]).cross(p[3] - p[1]).norm();
        centre += part * (p[0] + p[1] + p[2] + p[3]) / 4.0;
        area += part;
    }
    const hex::Vec3 expected = mesh.position(top) + 0.1 * (centre / area - mesh.position(top));
    const auto result = hex::improve(mesh, only_free(mesh, 22, 0.1));
    EXPECT_NEAR((result.mesh.position(top) - expected).norm(), 0.0, 1e-14);
}

TEST(Smooth, MovesACreaseVertexTowardsTheMiddleOfItsNeighbours) {
    hex::HexMesh mesh = hex::test::grid(2, 2, 2);
    const hex::VertexId crease(1);  // between (0,0,0) and (2,0,0)
    mesh.set_position(crease, {1.4, 0.0, 0.0});
    hex::ImproveOptions options = method("smooth", 1, 0.1);
    // Length-weighted mean of the middles of the two edges: (1.4 * 0.7 + 0.6 * 1.7) / 2 = 1.0.
    const auto result = hex::improve(mesh, options);
    EXPECT_NEAR((result.mesh.position(crease) - hex::Vec3(1.36, 0, 0)).norm(), 0.0, 1e-14);
}

TEST(Improve, RefusesOptionsOutOfRange) {
    const hex::HexMesh mesh = hex::test::grid(2, 2, 2);
    const auto refuses = [&](const hex::ImproveOptions& options) {
        try {
            (void)hex::improve(mesh, options);
        } catch (const hex::Error& error) {
            return error.kind() == hex::ErrorKind::usage;
        }
        return false;
    };
    EXPECT_TRUE(refuses(method("smooth", -2)));
    EXPECT_TRUE(refuses(method("smooth", 1, -0.1)));
    EXPECT_TRUE(refuses(method("smooth", 1, 1.1)));
    EXPECT_TRUE(refuses(method("no-such-method")));
    hex::ImproveOptions cosine = method("smooth");
    cosine.feature_cosine = 1.5;
    EXPECT_TRUE(refuses(cosine));
}

TEST(Improve, RefusesAnEmptyMesh) {
    EXPECT_THROW((void)hex::improve(hex::HexMesh(), method("smooth")), hex::Error);
}

TEST(Improve, ToleratesUnusedVertices) {
    const hex::HexMesh cubes = shaken_grid(3, 3, 3, 0.3, 9);
    std::vector<hex::Vec3> positions(cubes.positions().begin(), cubes.positions().end());
    positions.emplace_back(50, 50, 50);
    const hex::HexMesh mesh(positions, {cubes.cell_array().begin(), cubes.cell_array().end()});
    for (const char* name : {"laplace", "smooth", "optimize", "pillow"}) {
        const auto result = hex::improve(mesh, method(name, 1));
        EXPECT_EQ(result.mesh.position(hex::VertexId(64)), hex::Vec3(50, 50, 50)) << name;
    }
}

TEST(Improve, ListsItsMethods) {
    std::vector<std::string> names;
    for (const auto& info : hex::improvers().list()) names.push_back(info.name);
    for (const char* name : {"laplace", "optimize", "pillow", "smooth"})
        EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

}  // namespace
