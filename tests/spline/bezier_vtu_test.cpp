#include "spline_samples.h"
#include "support/test_files.h"

#include <spline/io/bext.h>
#include <spline/io/bezier_vtu.h>
#include <spline/io/control_mesh_file.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

#include <random>

namespace spline::test {
namespace {

SplineResult refined_fan() {
    // Turned and moved: a mistake in the order of points cannot hide in a symmetry.
    hex::HexMesh mesh = hex::test::fan(5, 3);
    std::mt19937 random(3);
    for (const hex::VertexId v : mesh.vertices()) {
        hex::Vec3 p = mesh.position(v);
        for (double& x : p) x += 0.1 * (static_cast<double>(random() % 1000) / 1000.0 - 0.5);
        mesh.set_position(v, p);
    }
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    options.refinement = {{0, 1, 2}, {0, 9}};
    return build(mesh, options);
}

TEST(BezierVtu, HeaderNamesWhatReadersNeed) {
    const hex::test::TemporaryFolder folder;
    const SplineResult result = refined_fan();
    io::write_bezier_vtu(folder / "a.vtu", result.spline);
    const std::string text = hex::test::read_text(folder / "a.vtu");
    for (const char* wanted : {"version=\"2.1\"", "HigherOrderDegrees=\"HigherOrderDegrees\"",
                               "RationalWeights=\"RationalWeights\"", "Name=\"level\"", "Name=\"element\""})
        EXPECT_NE(text.find(wanted), std::string::npos) << wanted;
    EXPECT_NE(text.find("NumberOfPoints=\"" + std::to_string(result.spline.rows.size()) + "\""),
              std::string::npos);
}

TEST(BezierVtu, VtkEvaluatesTheSamePoints) {
    const hex::test::TemporaryFolder folder;
    SplineResult result = refined_fan();
    for (const bool rational : {false, true}) {
        if (rational) {
            for (std::size_t i = 0; i < result.spline.weights.size(); i += 3) result.spline.weights[i] = 1.5;
        }
        const std::string vtu = (folder / "a.vtu").string(), bext = (folder / "a.bext").string();
        io::write_bezier_vtu(vtu, result.spline);
        io::write_bext(bext, result.spline);
        const int code = hex::test::run_python("spline/check_vtu.py", {vtu, bext});
        if (code == -1) GTEST_SKIP() << "skipped: no python3 with VTK";
        EXPECT_EQ(code, 0) << (rational ? "rational" : "polynomial");
    }
}

TEST(ControlMeshes, OneFileALevel) {
    const hex::test::TemporaryFolder folder;
    const SplineResult result = refined_fan();
    const auto paths = io::write_control_meshes(folder / "fan", result.levels);
    ASSERT_EQ(paths.size(), 3U);
    EXPECT_EQ(paths[1].filename(), "fan_hmesh1_CM.vtk");
    const std::string text = hex::test::read_text(paths[1]);
    for (const char* wanted : {"pact", "eact", "id"})
        EXPECT_NE(text.find(wanted), std::string::npos) << wanted;
}

}  // namespace
}  // namespace spline::test
