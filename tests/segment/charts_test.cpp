#include "support/surfaces.h"

#include <hex/base/error.h>
#include <hex/segment/charts.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

namespace hex {
namespace {

/// The box with n x n x 2 triangles a side, labelled by side; triangles of a side are consecutive.
struct LabelledBox {
    explicit LabelledBox(int n) {
        const PolygonSoup soup = test::box_surface(n, n, n, n);
        mesh = make_triangle_mesh(soup);
        for (const int part : soup.parts) segmentation.labels.push_back(part - 1);
    }
    /// First triangle of the quad (a, b) of a side.
    static int triangle(int side, int n, int a, int b) { return 2 * (side * n * n + a * n + b); }
    void set_quad(int triangle, int label) {
        segmentation.labels.at(static_cast<std::size_t>(triangle)) = label;
        segmentation.labels.at(static_cast<std::size_t>(triangle) + 1) = label;
    }
    Diagnostics violations() const { return validate_segmentation(mesh, segmentation); }

    TriangleMesh mesh;
    Segmentation segmentation;
};

std::vector<Diagnostic> of_code(const Diagnostics& all, const std::string& code) {
    std::vector<Diagnostic> found;
    std::copy_if(all.begin(), all.end(), std::back_inserter(found),
                 [&](const Diagnostic& d) { return d.code == code; });
    return found;
}

TEST(Charts, ABoxHasTwelveBoundariesOfTwoChartsEach) {
    const LabelledBox box(3);
    const LabelCharts charts = find_charts(box.mesh, box.segmentation);
    ASSERT_EQ(charts.charts.size(), 6U);
    ASSERT_EQ(charts.boundaries.size(), 12U);
    ASSERT_EQ(charts.corners.size(), 8U);
    for (const auto& chart : charts.charts) {
        EXPECT_EQ(chart.boundaries.size(), 4U);
        EXPECT_EQ(chart.euler_characteristic, 1);
    }
    for (const auto& boundary : charts.boundaries) EXPECT_EQ(boundary.vertices.size(), 4U);
    for (const auto& corner : charts.corners) EXPECT_EQ(corner.charts.size(), 3U);
    EXPECT_TRUE(box.violations().empty());
}

TEST(Charts, EveryEdgeBetweenChartsIsOnOneBoundaryWhateverTheLabels) {
    const PolygonSoup soup = test::torus(20, 12);
    const TriangleMesh mesh = make_triangle_mesh(soup);
    std::mt19937 random(11);
    for (int round = 0; round < 20; ++round) {
        Segmentation labels;
        for (std::size_t t = 0; t < soup.size(); ++t)
            labels.labels.push_back(static_cast<int>(random() % (round < 10 ? 6 : 2)));
        const LabelCharts charts = find_charts(mesh, labels);

        std::size_t triangles = 0;
        for (std::size_t c = 0; c < charts.charts.size(); ++c) {
            for (const int t : charts.charts[c].triangles) {
                EXPECT_EQ(charts.chart_of_triangle[static_cast<std::size_t>(t)], static_cast<int>(c));
                EXPECT_EQ(labels.labels[static_cast<std::size_t>(t)], charts.charts[c].label);
            }
            triangles += charts.charts[c].triangles.size();
        }
        EXPECT_EQ(triangles, soup.size());

        std::map<std::pair<int, int>, int> uses;
        for (const auto& boundary : charts.boundaries) {
            ASSERT_EQ(boundary.triangles.size() + 1, boundary.vertices.size());
            for (std::size_t i = 0; i < boundary.triangles.size(); ++i) {
                ++uses[std::minmax(boundary.vertices[i], boundary.vertices[i + 1])];
                for (std::size_t side = 0; side < 2; ++side)
                    EXPECT_EQ(charts.chart_of_triangle[static_cast<std::size_t>(boundary.triangles[i][side])],
                              boundary.charts[side]);
            }
        }
        std::size_t between = 0;
        for (const auto e : mesh.edges()) {
            const auto h = mesh.halfedge_handle(e, 0);
            between += charts.chart_of_triangle[static_cast<std::size_t>(mesh.face_handle(h).idx())] !=
                       charts.chart_of_triangle[static_cast<std::size_t>(mesh.opposite_face_handle(h).idx())];
        }
        EXPECT_EQ(uses.size(), between);
        for (const auto& [edge, count] : uses) EXPECT_EQ(count, 1);
    }
}

TEST(Conditions, AnOutlierHasTooFewBoundaries) {
    LabelledBox box(4);
    const int outlier = LabelledBox::triangle(4, 4, 1, 1);
    box.segmentation.labels[static_cast<std::size_t>(outlier)] = 0;
    const auto found = of_code(box.violations(), "chart-too-few-boundaries");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].severity, Severity::error);
    EXPECT_EQ(found[0].entity, "triangle");
    EXPECT_EQ(found[0].ids, std::vector<std::int64_t>{outlier});
    // The hole it leaves makes a ring of the chart around it, which a cut can repair.
    const auto ring = of_code(box.violations(), "chart-not-a-disk");
    ASSERT_EQ(ring.size(), 1U);
    EXPECT_EQ(ring[0].severity, Severity::warning);
    EXPECT_EQ(of_code(box.violations(), "chart-too-many-boundaries").size(), 1U);
}

TEST(Conditions, OppositeLabelsThatTouchAreNamedWithTheTrianglesOnBothSides) {
    LabelledBox box(4);
    const int quad = LabelledBox::triangle(0, 4, 1, 2);
    box.set_quad(quad, 1);  // -X within +X
    const auto found = of_code(box.violations(), "opposite-labels-adjacent");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].severity, Severity::error);
    const std::set<std::int64_t> ids(found[0].ids.begin(), found[0].ids.end());
    EXPECT_EQ(ids.size(), 6U);  // the two triangles of the quad, and one beyond each of its four edges
    EXPECT_TRUE(ids.contains(quad));
    EXPECT_TRUE(ids.contains(quad + 1));
}

TEST(Conditions, ThreeChartsOnTwoAxesMakeNoCorner) {
    LabelledBox box(2);
    box.set_quad(LabelledBox::triangle(0, 2, 0, 0), 1);  // a corner quad of +X says -X
    const auto found = of_code(box.violations(), "corner-repeats-axis");
    EXPECT_FALSE(found.empty());
    for (const auto& d : found) {
        ASSERT_EQ(d.entity, "vertex");
        const auto v = box.mesh.vertex_handle(static_cast<unsigned>(d.ids.at(0)));
        std::set<int> labels;
        for (const auto f : box.mesh.vf_range(v))
            labels.insert(box.segmentation.labels[static_cast<std::size_t>(f.idx())]);
        EXPECT_TRUE(labels.contains(0) && labels.contains(1));
    }
}

TEST(Conditions, AChartThatTouchesItselfMakesACornerOfTwoCharts) {
    // A band around the torus that is pinched to a vertex: quads (0..3, 0), then (4..9, 1), joined by edges
    // at the other end only.
    const int around = 10, across = 8;
    const TriangleMesh mesh = make_triangle_mesh(test::torus(around, across));
    Segmentation labels;
    labels.labels.assign(mesh.n_faces(), 0);
    const auto set = [&](int i, int j) {
        for (int k = 0; k < 2; ++k) labels.labels[static_cast<std::size_t>(2 * (i * across + j) + k)] = 2;
    };
    for (int i = 0; i < 4; ++i) set(i, 0);
    for (int i = 4; i < around; ++i) set(i, 1);
    set(around - 1, 0);
    const LabelCharts charts = find_charts(mesh, labels);
    ASSERT_EQ(charts.charts.size(), 2U);
    const auto found = of_code(validate_charts(charts), "corner-of-two-charts");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].ids, std::vector<std::int64_t>{4 * across + 1});
}

TEST(Conditions, OneLabelEverywhereIsAChartWithoutBoundary) {
    LabelledBox box(2);
    std::fill(box.segmentation.labels.begin(), box.segmentation.labels.end(), 3);
    const auto violations = box.violations();
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_EQ(violations[0].code, "chart-too-few-boundaries");
    EXPECT_EQ(violations[0].ids.size(), 48U);
}

TEST(Conditions, CornersOfMoreThanThreeChartsAreToldAsNotes) {
    LabelledBox box(2);
    // The four quads of +Z around its middle look in turn to +X, +Y, -X, -Y.
    box.set_quad(LabelledBox::triangle(4, 2, 0, 0), 0);
    box.set_quad(LabelledBox::triangle(4, 2, 1, 0), 2);
    box.set_quad(LabelledBox::triangle(4, 2, 1, 1), 1);
    box.set_quad(LabelledBox::triangle(4, 2, 0, 1), 3);
    const auto found = of_code(box.violations(), "corner-valence");
    const auto middle = std::find_if(found.begin(), found.end(), [&](const Diagnostic& d) {
        return box.mesh.point(box.mesh.vertex_handle(static_cast<unsigned>(d.ids.at(0)))) ==
               OpenMesh::Vec3d(1, 1, 2);
    });
    ASSERT_NE(middle, found.end());
    EXPECT_EQ(middle->severity, Severity::note);
}

TEST(Conditions, LabelsMustFitTheMesh) {
    LabelledBox box(1);
    box.segmentation.labels.pop_back();
    EXPECT_THROW(box.violations(), Error);
    box.segmentation.labels.push_back(6);
    EXPECT_THROW(box.violations(), Error);
    EXPECT_THROW(with_labels(box.mesh, box.segmentation), Error);
}

}  // namespace
}  // namespace hex
