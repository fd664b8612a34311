/// What the sweeps really promise about the energies.
#include "support/surfaces.h"

#include <hex/segment/segment.h>

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace hex {
namespace {

/// A torus with ripples; every two-ring has the same number of triangles.
TriangleMesh rippled_torus() {
    PolygonSoup soup = test::torus(60, 36);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> ripple(-0.06, 0.06);
    for (Vec3& p : soup.points) p += Vec3(ripple(random), ripple(random), ripple(random));
    return make_triangle_mesh(soup);
}

SegmentResult run(const TriangleMesh& mesh, const std::string& method, double weight) {
    SegmentOptions options;
    options.method = method;
    options.boundary_weight = weight;
    return segment(mesh, options);
}

/// Triangles within two rings by vertices, found the slow way.
std::set<int> two_ring(const TriangleMesh& mesh, TriangleMesh::FaceHandle face) {
    std::set<int> ring = {face.idx()};
    for (int round = 0; round < 2; ++round) {
        const std::set<int> inner = ring;
        for (const int f : inner) {
            for (const auto v : mesh.fv_range(mesh.face_handle(static_cast<unsigned>(f)))) {
                for (const auto n : mesh.vf_range(v)) ring.insert(n.idx());
            }
        }
    }
    return ring;
}

struct Parts {
    double distance = 0;  ///< sum of squared classical distances
    double boundary = 0;  ///< sum of boundary terms
};

Parts parts_of_energy(const TriangleMesh& mesh, const SegmentResult& result, double weight) {
    Parts parts;
    const auto& labels = result.segmentation.labels;
    for (const auto f : mesh.faces()) {
        const int own = labels[static_cast<std::size_t>(f.idx())];
        const Vec3 normal = to_eigen(mesh.calc_face_normal(f));
        parts.distance +=
            0.25 * (normal - result.report.generators[static_cast<std::size_t>(own)]).squaredNorm();
        const auto ring = two_ring(mesh, f);
        double other = 0;
        for (const int t : ring) other += labels[static_cast<std::size_t>(t)] != own;
        parts.boundary += 2 * weight * other / static_cast<double>(ring.size());
    }
    return parts;
}

TEST(SegmentEnergy, TheReportedEnergyIsTheSumOverTheTriangles) {
    const TriangleMesh mesh = rippled_torus();
    const auto classical = run(mesh, "cvt", 0.1);
    const double distance = parts_of_energy(mesh, classical, 0.1).distance;
    EXPECT_NEAR(classical.report.sweeps.back().energy, distance, 1e-10 * distance);
    const auto enhanced = run(mesh, "hbecvt", 0.1);
    const Parts parts = parts_of_energy(mesh, enhanced, 0.1);
    EXPECT_NEAR(enhanced.report.sweeps.back().energy, parts.distance + parts.boundary,
                1e-10 * (parts.distance + parts.boundary));
}

TEST(SegmentEnergy, ClassicalSweepsLowerTheEnergy) {
    const auto result = run(rippled_torus(), "cvt", 0.1);
    ASSERT_GE(result.report.sweeps.size(), 3U);
    for (std::size_t s = 1; s < result.report.sweeps.size(); ++s)
        EXPECT_LE(result.report.sweeps[s].energy, result.report.sweeps[s - 1].energy);
}

TEST(SegmentEnergy, EnhancedMovesLowerDistancePlusHalfTheBoundaryTermWhereRingsHaveOneSize) {
    // A move lowers the triangle's own d^2 + term; the terms of its two-ring change by as much again. So what
    // falls with every move is D + B/2, and not the energy D + B itself.
    const TriangleMesh mesh = rippled_torus();
    for (const double weight : {0.01, 0.1, 0.5}) {
        const auto before = run(mesh, "cvt", weight);
        const auto after = run(mesh, "hbecvt", weight);
        ASSERT_NE(before.segmentation.labels, after.segmentation.labels);
        const Parts a = parts_of_energy(mesh, before, weight);
        const Parts b = parts_of_energy(mesh, after, weight);
        EXPECT_LT(b.distance + 0.5 * b.boundary, a.distance + 0.5 * a.boundary) << weight;
        EXPECT_LT(b.boundary, a.boundary) << weight;
    }
}

TEST(SegmentEnergy, MoreWeightMakesFewerLabelChanges) {
    const TriangleMesh mesh = rippled_torus();
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (const double weight : {0.0, 0.1, 0.5}) {
        const auto labels = run(mesh, "hbecvt", weight).segmentation.labels;
        std::size_t changes = 0;
        for (const auto e : mesh.edges()) {
            const auto h = mesh.halfedge_handle(e, 0);
            changes += labels[static_cast<std::size_t>(mesh.face_handle(h).idx())] !=
                       labels[static_cast<std::size_t>(mesh.opposite_face_handle(h).idx())];
        }
        EXPECT_LT(changes, before) << weight;
        before = changes;
    }
}

}  // namespace
}  // namespace hex
