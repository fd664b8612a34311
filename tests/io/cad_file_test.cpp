#include "support/damage.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/cad_file.h>
#include <hex/surface/polygon_soup.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace hex::io {
namespace {

constexpr double pi = std::numbers::pi;

/// Tests of what is read are left out in builds without Open CASCADE.
class Cad : public ::testing::Test {
  protected:
    void SetUp() override {
        try {
            read_cad(angle);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::unsupported) GTEST_SKIP() << error.what();
            throw;
        }
    }
    const std::filesystem::path angle = test::own_data() / "angle" / "angle.step";
    const std::filesystem::path pair = test::own_data() / "pair" / "pair.step";
};

double longest_edge(const PolygonSoup& soup) {
    double longest = 0;
    for (std::size_t f = 0; f < soup.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(
                longest,
                (soup.points[soup.polygon(f)[k]] - soup.points[soup.polygon(f)[(k + 1) % 3]]).norm());
    return longest;
}

/// 60 x 40 x 8 and 60 x 8 x 32, the fillet, three holes.
const double angle_volume = 19200 + 15360 + (36 - 9 * pi) * 60 - 2 * 25 * pi * 8 - 49 * pi * 8;
const double pair_volume = 30 * 20 * 10 + 20 * 20 * 20 - 25 * pi * 20;

TEST_F(Cad, StepIsAClosedSurfaceWithFaceIds) {
    const SurfaceFile file = read_surface(angle);
    const TriangleMesh mesh = make_triangle_mesh(file.soup);
    EXPECT_TRUE(inspect(mesh).empty());
    EXPECT_EQ(std::set<int>(file.soup.parts.begin(), file.soup.parts.end()).size(), 12U);
    EXPECT_NEAR(enclosed_volume(mesh), angle_volume, 1e-3 * angle_volume);
    EXPECT_EQ(mesh.n_vertices() - mesh.n_edges() + mesh.n_faces(), std::size_t(-4)) << "genus 3";
}

TEST_F(Cad, FinerDeflectionComesNearerToTheVolume) {
    double miss = 1e9;
    for (const double deflection : {0.5, 0.05, 0.005}) {
        const CadOptions options{.deflection = deflection, .angle = 45, .longest_edge = 1e9};
        const TriangleMesh mesh = make_triangle_mesh(read_cad(angle, options).soup);
        const double now = std::abs(enclosed_volume(mesh) - angle_volume);
        EXPECT_LT(now, miss);
        miss = now;
    }
    EXPECT_LT(miss, 1e-4 * angle_volume);
}

TEST_F(Cad, LongEdgesAreCutAndTheSurfaceStays) {
    const CadOptions whole{.longest_edge = std::numeric_limits<double>::infinity()};
    const SurfaceFile coarse = read_cad(angle, whole);
    EXPECT_GT(longest_edge(coarse.soup), 30);
    for (const double length : {10.0, 4.0}) {
        const SurfaceFile fine = read_cad(angle, {.longest_edge = length});
        EXPECT_LE(longest_edge(fine.soup), length);
        const TriangleMesh mesh = make_triangle_mesh(fine.soup);
        EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(make_triangle_mesh(coarse.soup)), 1e-6);
    }
}

/// All edges of the part but those where the fillet is tangent to its neighbours and the seams of the holes:
/// in length the two L-shaped sides, the straight edges along x, and two circles a hole.
TEST_F(Cad, SharpEdgesAreThoseOfTheModel) {
    for (const double longest : {4.0, 1e9}) {
        const SurfaceFile file = read_cad(angle, {.deflection = 0.001, .longest_edge = longest});
        double length = 0;
        std::map<std::uint32_t, int> degree;
        std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
        for (std::size_t f = 0; f < file.soup.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k)
                edges.emplace(file.soup.polygon(f)[k], file.soup.polygon(f)[(k + 1) % 3]);
        for (const auto& [a, b] : file.sharp_edges) {
            length += (file.soup.points[a] - file.soup.points[b]).norm();
            ++degree[a];
            ++degree[b];
            EXPECT_TRUE(edges.contains({a, b}));
        }
        const double side = 40 + 40 + 8 + 8 + (32 - 6) + (32 - 6) + 3 * pi;
        EXPECT_NEAR(length, 2 * side + 5 * 60 + 2 * 2 * pi * (5 + 5 + 7), 0.5);
        for (const auto& [v, count] : degree) EXPECT_TRUE(count == 2 || count == 3) << v;
    }
}

TEST_F(Cad, SeveralSolidsAreSeveralComponents) {
    for (const char* name : {"pair.step", "pair.brep", "pair.igs"}) {
        const SurfaceFile file = read_surface(test::own_data() / "pair" / name);
        const TriangleMesh mesh = make_triangle_mesh(file.soup);
        EXPECT_NEAR(enclosed_volume(mesh), pair_volume, 1e-3 * pair_volume) << name;
        const Diagnostics findings = inspect(mesh);
        ASSERT_EQ(findings.size(), 1U) << name;
        EXPECT_NE(findings[0].message.find("2"), std::string::npos) << findings[0].message;
    }
}

TEST_F(Cad, IsTheSameEveryTime) {
    const SurfaceFile a = read_surface(angle);
    const SurfaceFile b = read_surface(angle);
    EXPECT_EQ(a.soup.points, b.soup.points);
    EXPECT_EQ(a.soup.corners, b.soup.corners);
    EXPECT_EQ(a.sharp_edges, b.sharp_edges);
}

/// By itself Open CASCADE crashes on some of these, and never comes to an end of the BREP file that is cut
/// off.
TEST_F(Cad, DamagedFilesAreErrorsOrWhatIsLeft) {
    const test::TemporaryFolder folder;
    const auto attempt = [&](const char* name, const auto& damage) {
        const std::filesystem::path whole = test::own_data() / name;
        const auto path = folder / std::string("damaged").append(whole.extension().string());
        test::write_text(path, damage(test::read_text(whole)));
        try {
            EXPECT_GT(read_cad(path).soup.size(), 0U);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_NE(std::string(error.what()).find("damaged."), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    };
    const auto cut_off = [](const std::string& text) { return text.substr(0, text.size() * 3 / 10); };
    const auto with_gap = [](std::string text) { return text.erase(text.size() * 3 / 10, 1500); };
    const auto noisy = [](std::string text) {
        for (std::size_t i = 600; i < text.size(); i += 1009) text[i] = '7';
        return text;
    };
    attempt("angle/angle.step", with_gap);
    attempt("angle/angle.step", noisy);
    attempt("pair/pair.igs", with_gap);
    attempt("pair/pair.igs", noisy);
    attempt("pair/pair.brep", cut_off);
    attempt("pair/pair.brep", noisy);
}

/// 200 of each format: CPU time and memory of the process that reads are counted in, as it is our child.
TEST_F(Cad, DamagedAnywhereItIsReadOrRefusedInLittleTimeAndMemory) {
    const test::TemporaryFolder folder;
    for (const char* name : {"pair.step", "pair.igs", "pair.brep"}) {
        const std::filesystem::path whole = test::own_data() / "pair" / name;
        const std::string text = test::read_text(whole);
        std::mt19937 random(7);
        for (int round = 0; round < 200; ++round) {
            const auto path = folder / std::string("d").append(whole.extension().string());
            test::write_text(path, test::damaged(text, random, 1 + round % 4));
            SCOPED_TRACE(std::string(name) + ", round " + std::to_string(round));
            test::expect_read_or_refused(path, [](const std::filesystem::path& file) { read_cad(file); });
        }
    }
}

TEST(CadErrors, TruncatedStepSaysSo) {
    const test::TemporaryFolder folder;
    test::write_text(folder / "a.step", "ISO-10303-21;\nHEADER;\n");
    test::write_text(folder / "b.stp", "solid a\nendsolid a\n");
    for (const auto& [name, part] : {std::pair("a.step", "ends early"), std::pair("b.stp", "no STEP file")}) {
        try {
            read_surface(folder / name);
            ADD_FAILURE();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    }
}

TEST(CadErrors, OptionsOutOfRange) {
    const auto path = test::own_data() / "angle" / "angle.step";
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const CadOptions& options :
         {CadOptions{.deflection = -1}, CadOptions{.deflection = nan}, CadOptions{.angle = 0},
          CadOptions{.angle = 91}, CadOptions{.longest_edge = -1}, CadOptions{.sharp_angle = nan}}) {
        try {
            read_cad(path, options);
            ADD_FAILURE();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
        }
    }
}

}  // namespace
}  // namespace hex::io
