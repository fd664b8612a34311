/// Methods `untangle` and `auto`.

#include "improve/improve_cases.h"
#include "support/test_files.h"

#include <hex/io/hex_file.h>
#include <hex/io/surface_file.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using hex::HexMesh;
using hex::Vec3;
using hex::VertexId;
using hex::test::method;
using hex::test::shaken_grid;

/// A grid shaken until most of it is inverted: interior vertices by up to 1.5 edge lengths, those of the
/// faces and edges of the box by less along them.
HexMesh tangled_grid(unsigned seed) {
    HexMesh mesh = shaken_grid(5, 5, 5, 0.3, seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-1.5, 1.5);
    const hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    for (const VertexId v : mesh.vertices()) {
        const Vec3 move(shift(random), shift(random), shift(random));
        if (!boundary.contains(v)) mesh.set_position(v, mesh.position(v) + move);
    }
    return mesh;
}

/// Distance to the surface of the box [0, size]^3.
double distance_to_box(const Vec3& p, double size) {
    double distance = std::numeric_limits<double>::infinity();
    for (Eigen::Index d = 0; d < 3; ++d)
        distance = std::min({distance, std::abs(p[d]), std::abs(size - p[d])});
    return distance;
}

TEST(Untangle, TangledGridsBecomeAlmostPerfectAndStayOnTheirBox) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const HexMesh mesh = tangled_grid(seed);
        const auto result = hex::improve(mesh, method("untangle"));
        EXPECT_GT(result.report.before.inverted, 50U);
        EXPECT_EQ(result.report.after.inverted, 0U);
        EXPECT_GT(result.report.after.min, 0.9);
        EXPECT_EQ(result.report.sharp_edges, 60U);
        for (const VertexId v : hex::boundary_quads(mesh).boundary_vertices)
            EXPECT_LT(distance_to_box(result.mesh.position(v), 5.0), 1e-12);
    }
}

TEST(Untangle, SlidesOnAGivenSurfaceAcrossPatchBorders) {
    hex::PolygonSoup soup = hex::test::box_surface(4.0, 4.0, 4.0, 3);
    for (std::size_t f = 0; f < soup.size(); ++f) soup.parts[f] = static_cast<int>(f % 7) + 1;
    const hex::TriangleMesh surface = hex::make_triangle_mesh(soup);
    hex::ImproveOptions options = method("untangle");
    options.surface = &surface;
    options.max_deviation = 0.0;
    const HexMesh mesh = shaken_grid(4, 4, 4, 0.45, 11);
    const auto result = hex::improve(mesh, options);
    EXPECT_GT(result.report.after.min, 0.95);
    for (const VertexId v : hex::boundary_quads(mesh).boundary_vertices)
        EXPECT_LT(distance_to_box(result.mesh.position(v), 4.0), 1e-12);
}

TEST(Untangle, SameBytesForAnyNumberOfThreads) {
    const HexMesh mesh = tangled_grid(5);
    for (const char* name : {"untangle", "auto"}) {
        const auto one = hex::improve(mesh, method(name), hex::test::with_thread_count(1));
        const auto two = hex::improve(mesh, method(name), hex::test::with_thread_count(2));
        EXPECT_TRUE(hex::test::identical(one.mesh, two.mesh)) << name;
    }
}

TEST(Untangle, NeverWorseThanTheInput) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const HexMesh mesh = shaken_grid(3, 2, 3, 0.1 * seed, seed);
        for (const char* name : {"untangle", "auto"}) {
            const auto report = hex::improve(mesh, method(name)).report;
            EXPECT_LE(report.after.inverted, report.before.inverted);
            if (report.after.inverted == report.before.inverted) {
                EXPECT_GE(report.after.min, report.before.min);
            }
        }
    }
    const HexMesh perfect = hex::test::grid(3, 3, 3);
    EXPECT_DOUBLE_EQ(hex::improve(perfect, method("auto")).report.after.min, 1.0);
}

TEST(Untangle, StopsAtTheTarget) {
    hex::ImproveOptions options = method("untangle");
    const HexMesh mesh = shaken_grid(4, 4, 4, 0.3, 3);
    options.target = 0.6;
    const auto easy = hex::improve(mesh, options).report;
    options.target = 1.0;
    const auto full = hex::improve(mesh, options).report;
    EXPECT_GE(easy.after.min, 0.6);
    EXPECT_GT(full.after.min, easy.after.min);
    EXPECT_LT(easy.history.size(), full.history.size());
}

/// The surface of a box whose top is a vault, y = 0 and y = length its ends; sharp along the springings.
hex::PolygonSoup vaulted_box(int pieces, double length) {
    hex::PolygonSoup soup = hex::test::box_surface(4.0, length, 2.0, pieces);
    for (Vec3& p : soup.points)
        p.z() += 0.5 * p.z() * std::sqrt(std::max(0.0, 1.0 - (p.x() / 2.0 - 1.0) * (p.x() / 2.0 - 1.0)));
    return soup;
}

/// A grid in the vaulted box, shaken.
HexMesh vaulted_grid(int nx, int ny, int nz, double amount, unsigned seed) {
    HexMesh mesh = shaken_grid(nx, ny, nz, amount, seed);
    for (const VertexId v : mesh.vertices()) {
        Vec3 p = mesh.position(v).cwiseProduct(Vec3(4.0 / nx, 4.0 / ny, 2.0 / nz));
        p.z() += 0.5 * p.z() * std::sqrt(std::max(0.0, 1.0 - (p.x() / 2.0 - 1.0) * (p.x() / 2.0 - 1.0)));
        mesh.set_position(v, p);
    }
    return mesh;
}

TEST(Auto, SameBytesForAnyNumberOfThreadsOnASurface) {
    const hex::TriangleMesh surface = hex::make_triangle_mesh(vaulted_box(8, 4.0));
    hex::ImproveOptions options;
    options.surface = &surface;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const HexMesh mesh = vaulted_grid(6, 6, 3, 0.4, seed);
        const auto one = hex::improve(mesh, options, hex::test::with_thread_count(1));
        EXPECT_GT(one.report.after.min, one.report.before.min);
        for (const int threads : {2, 4}) {
            const auto many = hex::improve(mesh, options, hex::test::with_thread_count(threads));
            EXPECT_TRUE(hex::test::identical(one.mesh, many.mesh)) << seed << ", " << threads;
        }
    }
}

TEST(Auto, LeavesNoEdgeWithoutLength) {
    const hex::TriangleMesh surface = hex::make_triangle_mesh(vaulted_box(8, 4.0));
    hex::ImproveOptions options;
    options.surface = &surface;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const HexMesh mesh = hex::improve(vaulted_grid(4, 4, 2, 0.4, seed), options).mesh;
        const hex::EdgeTable edges = hex::edge_table(mesh);
        for (const auto& ends : edges.vertices)
            EXPECT_GT((mesh.position(ends[0]) - mesh.position(ends[1])).norm(), 0.04);
    }
}

TEST(Auto, KeepsTheBoundaryAsCloseToTheSurfaceAsItWas) {
    const hex::TriangleMesh surface = hex::make_triangle_mesh(vaulted_box(8, 4.0));
    const HexMesh mesh = vaulted_grid(4, 4, 2, 0.3, 7);
    hex::ImproveOptions options;
    options.surface = &surface;
    const auto report = hex::improve(mesh, options).report;
    EXPECT_EQ(report.method, "auto");
    EXPECT_EQ(report.after.inverted, 0U);
    EXPECT_GT(report.after.min, report.before.min);
    EXPECT_GT(report.after.mean, report.before.mean);
    ASSERT_TRUE(report.fidelity_before && report.fidelity_after && report.fidelity_limit);
    EXPECT_GT(report.fidelity_before->distance, 0.1);
    EXPECT_LE(report.fidelity_limit->distance, 1.051 * report.fidelity_before->distance);
    EXPECT_LE(report.fidelity_after->distance, report.fidelity_limit->distance);
    EXPECT_LE(report.fidelity_after->features, report.fidelity_limit->features);
    for (const auto& record : report.history) EXPECT_FALSE(record.step.empty());
    EXPECT_FALSE(report.seconds.empty());
}

TEST(Auto, SharpEdgesThatWereWrittenAndReadBackGiveTheSameMesh) {
    const hex::TriangleMesh surface = hex::make_triangle_mesh(hex::test::box_surface(3.0, 3.0, 3.0, 3));
    const HexMesh mesh = shaken_grid(3, 3, 3, 0.3, 2);
    hex::ImproveOptions options;
    options.surface = &surface;
    const auto found = hex::improve(mesh, options);
    EXPECT_EQ(found.report.feature_edges.size(), 36U);
    options.feature_edges = found.report.feature_edges;
    const auto listed = hex::improve(mesh, options);
    EXPECT_TRUE(hex::test::identical(found.mesh, listed.mesh));
    EXPECT_EQ(listed.report.feature_edges, found.report.feature_edges);
    options.feature_edges = {{0, 1000000}};
    EXPECT_THROW((void)hex::improve(mesh, options), hex::Error);
}

TEST(Auto, ATimeLimitGivesWhatWasReachedAndNeverLess) {
    const HexMesh mesh = shaken_grid(6, 6, 6, 0.35, 4);
    hex::ImproveOptions options;
    options.time_limit = 1e-6;
    const auto hurried = hex::improve(mesh, options).report;
    EXPECT_LE(hurried.after.inverted, hurried.before.inverted);
    EXPECT_TRUE(hurried.after.inverted < hurried.before.inverted || hurried.after.min >= hurried.before.min);
    options.time_limit = 0.0;
    const auto full = hex::improve(mesh, options).report;
    EXPECT_LT(hurried.history.size(), full.history.size());
    options.time_limit = -1.0;
    EXPECT_THROW((void)hex::improve(mesh, options), hex::Error);
}

/// What is done is bounded, and what comes out does not depend on the machine.
TEST(Auto, AWorkLimitBoundsTheWorkAndGivesTheSameBytesForAnyNumberOfThreads) {
    const HexMesh mesh = shaken_grid(6, 6, 6, 0.35, 4);
    hex::ImproveOptions options;
    const auto full = hex::improve(mesh, options);
    options.work_limit = 0.25 * full.report.work;
    const auto one = hex::improve(mesh, options, hex::test::with_thread_count(1));
    const auto two = hex::improve(mesh, options, hex::test::with_thread_count(2));
    EXPECT_TRUE(hex::test::identical(one.mesh, two.mesh));
    EXPECT_EQ(one.report.work, two.report.work);
    EXPECT_GT(one.report.work, 0.0);
    EXPECT_LT(one.report.work, 0.6 * full.report.work);
    EXPECT_LE(one.report.after.inverted, one.report.before.inverted);
    EXPECT_LE(one.report.after.min, full.report.after.min + 0.02);
    options.work_limit = -1.0;
    EXPECT_THROW((void)hex::improve(mesh, options), hex::Error);
}

TEST(Auto, AskedToFinishItGivesWhatWasReached) {
    const HexMesh mesh = shaken_grid(6, 6, 6, 0.35, 4);
    hex::ImproveOptions options;
    const auto full = hex::improve(mesh, options).report;
    std::stop_source source;
    options.finish = source.get_token();
    hex::Context context;
    int steps = 0;
    context.on_progress = [&](std::string_view, double) {
        if (++steps == 3) source.request_stop();
    };
    const auto ended = hex::improve(mesh, options, context).report;
    EXPECT_LT(ended.history.size(), full.history.size());
    EXPECT_LE(ended.after.inverted, ended.before.inverted);
    EXPECT_TRUE(ended.after.inverted < ended.before.inverted || ended.after.min >= ended.before.min);
}

/// Paper models before improvement, on their surfaces (the published ones: min 0.10 to 0.24 at the end).
TEST(Untangle, PaperModelsOnTheirSurfaces) {
    HEX_NEEDS_REFERENCE_DATA();
    struct Case {
        const char* name;
        double target, min, mean;
    };
    for (const Case& c : {Case{"hepta", 1.0, 0.6, 0.927}, Case{"joint", 0.45, 0.45, 0.85}}) {
        const auto folder = hex::test::reference_data() / "paper" / c.name;
        const std::string name = c.name;
        const auto input = hex::io::read_hex_mesh(folder / (name + "_hex_initial.vtk"));
        const auto surface =
            hex::make_triangle_mesh(hex::io::read_surface(folder / (name + "_initial_read.k")).soup);
        hex::ImproveOptions options = method("untangle");
        options.surface = &surface;
        options.target = c.target;
        const auto report = hex::improve(input.mesh, options).report;
        EXPECT_EQ(report.after.inverted, 0U) << name;
        EXPECT_GE(report.after.min, c.min) << name;
        EXPECT_GT(report.after.mean, c.mean) << name;
    }
}

/// Against edge-cone rectification's own results (0.250 and 0.870; 0.716 and 0.987).
TEST(Untangle, TangledMeshesBetterThanAPublishedOptimiser) {
    HEX_NEEDS_REFERENCE_DATA();
    struct Case {
        const char* file;
        double min, mean;
    };
    for (const Case& c : {Case{"edgecone_block_in.mesh", 0.250, 0.860},
                          Case{"edgecone_hanger_stresstest_in.mesh", 0.716, 0.977}}) {
        const auto input = hex::io::read_hex_mesh(hex::test::reference_data() / "hex" / c.file);
        const auto report = hex::improve(input.mesh, method("untangle")).report;
        EXPECT_GT(report.before.inverted, 30U) << c.file;
        EXPECT_EQ(report.after.inverted, 0U) << c.file;
        EXPECT_GE(report.after.min, c.min) << c.file;
        EXPECT_GE(report.after.mean, c.mean) << c.file;
    }
}

}  // namespace
