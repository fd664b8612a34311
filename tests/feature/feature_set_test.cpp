#include "support/meshes.h"

#include <hex/base/error.h>
#include <hex/feature/feature_set.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using hex::VertexFeature;

struct Case {
    hex::HexMesh mesh;
    hex::EdgeTable edges;
    hex::BoundaryQuads boundary;

    explicit Case(hex::HexMesh m)
        : mesh(std::move(m)), edges(hex::edge_table(mesh)), boundary(hex::boundary_quads(mesh)) {}
};

std::size_t count(const hex::FeatureSet& features, VertexFeature kind) {
    return static_cast<std::size_t>(std::count(features.vertex.begin(), features.vertex.end(), kind));
}

TEST(Features, WithoutAnyEveryBoundaryVertexIsSmooth) {
    const Case c(hex::test::grid(3, 3, 3));
    const hex::FeatureSet features = hex::no_features(c.mesh, c.edges, c.boundary);
    EXPECT_EQ(features.sharp_edge_count(), 0u);
    EXPECT_EQ(count(features, VertexFeature::interior), 8u);
    EXPECT_EQ(count(features, VertexFeature::smooth), 56u);
}

TEST(Features, OfABoxAreItsTwelveEdgesAndEightCorners) {
    const Case c(hex::test::shuffled_grid(4, 3, 2, 7));
    const hex::FeatureSet features = hex::features_by_angle(c.mesh, c.edges, c.boundary, 0.8);
    EXPECT_EQ(features.sharp_edge_count(), 4u * (4 + 3 + 2));
    EXPECT_EQ(count(features, VertexFeature::corner), 8u);
    EXPECT_EQ(count(features, VertexFeature::crease), 4u * (3 + 2 + 1));
    EXPECT_EQ(count(features, VertexFeature::interior), 3u * 2 * 1);
}

TEST(Features, AreSharpBelowTheCosineOnly) {
    // One cube bent so that its top quad makes 60 degrees with the quad at u = 1.
    hex::HexMesh mesh = hex::test::grid(1, 1, 1);
    const double shift = 1.0 / std::tan(std::numbers::pi / 3.0);
    for (const hex::VertexId v : mesh.vertices()) {
        hex::Vec3 p = mesh.position(v);
        if (p.x() == 1.0 && p.z() == 0.0) p.x() += shift;
        mesh.set_position(v, p);
    }
    const Case c(mesh);
    // Angles between outward normals: 30 and 150 degrees at u = 1 (top and bottom), else 90.
    EXPECT_EQ(hex::features_by_angle(c.mesh, c.edges, c.boundary, 0.51).sharp_edge_count(), 12u);
    EXPECT_EQ(hex::features_by_angle(c.mesh, c.edges, c.boundary, 0.49).sharp_edge_count(), 11u);
    EXPECT_EQ(hex::features_by_angle(c.mesh, c.edges, c.boundary, -0.49).sharp_edge_count(), 1u);
    EXPECT_EQ(hex::features_by_angle(c.mesh, c.edges, c.boundary, -0.51).sharp_edge_count(), 0u);
}

TEST(Features, OfAWarpedQuadDoNotDependOnTheCornerLookedAt) {
    // One corner of a flat 3 x 3 top is lifted: the normals of the four quads around it turn a little, and
    // turning every cell must not change what is sharp.
    const auto lifted = [](hex::HexMesh mesh) {
        for (const hex::VertexId v : mesh.vertices()) {
            const hex::Vec3 p = mesh.position(v);
            if (p == hex::Vec3(1, 1, 3)) mesh.set_position(v, p + hex::Vec3(0, 0, 0.45));
        }
        return mesh;
    };
    const Case plain(lifted(hex::test::grid(3, 3, 3)));
    const Case turned(lifted(hex::test::shuffled_grid(3, 3, 3, 11)));
    for (const double cosine : {0.95, 0.9, 0.85, 0.8}) {
        EXPECT_EQ(hex::features_by_angle(plain.mesh, plain.edges, plain.boundary, cosine).sharp_edge,
                  hex::features_by_angle(turned.mesh, turned.edges, turned.boundary, cosine).sharp_edge);
    }
}

TEST(Features, IgnoreAQuadWithoutArea) {
    hex::HexMesh mesh = hex::test::grid(1, 1, 1);
    for (const std::size_t v : {4, 5, 6, 7}) mesh.set_position(hex::VertexId(v), hex::Vec3(0.5, 0.5, 1.0));
    const Case c(mesh);
    const hex::FeatureSet features = hex::features_by_angle(c.mesh, c.edges, c.boundary, 0.8);
    for (std::size_t e = 0; e < c.edges.size(); ++e) {
        const auto& [a, b] = c.edges.vertices[e];
        if (a.index() < 4 || b.index() < 4) continue;
        EXPECT_FALSE(features.sharp_edge[e]) << a << " " << b;
    }
    EXPECT_GT(features.sharp_edge_count(), 0u);
}

TEST(Features, ByAngleRejectACosineOutOfRange) {
    const Case c(hex::test::grid(1, 1, 1));
    for (const double cosine : {1.5, -1.01, std::nan("")})
        EXPECT_THROW((void)hex::features_by_angle(c.mesh, c.edges, c.boundary, cosine), hex::Error);
}

TEST(Features, FromAListJoinListedBoundaryNeighbours) {
    // Vertices (0,0,0) (1,0,0) (2,0,0) of a 3 x 3 x 3 grid lie on one edge; (1,1,1) is inside; (3,3,3) alone.
    const Case c(hex::test::grid(3, 3, 3));
    const std::vector<std::int64_t> listed = {0, 1, 2, 1 + 4 + 16, 63, 63};
    const hex::FeatureSet features = hex::features_from_vertices(c.mesh, c.edges, c.boundary, listed);
    EXPECT_EQ(features.sharp_edge_count(), 2u);
    EXPECT_TRUE(features.sharp_edge[c.edges.find(hex::VertexId(0), hex::VertexId(1)).index()]);
    EXPECT_TRUE(features.sharp_edge[c.edges.find(hex::VertexId(1), hex::VertexId(2)).index()]);
    EXPECT_EQ(features.vertex[0], VertexFeature::corner) << "one sharp edge: the end of a curve";
    EXPECT_EQ(features.vertex[1], VertexFeature::crease);
    EXPECT_EQ(features.vertex[2], VertexFeature::corner);
    EXPECT_EQ(features.vertex[21], VertexFeature::interior);
    EXPECT_EQ(features.vertex[63], VertexFeature::smooth) << "listed, but without a sharp edge";
}

TEST(Features, FromAListNeverUseInteriorEdges) {
    // Two boundary vertices on opposite sides of a 1-cell-thick plate are joined by a boundary or an interior
    // edge; only the first kind can be sharp.
    const Case c(hex::test::grid(3, 3, 1));
    const auto at = [](int i, int j, int k) { return static_cast<std::int64_t>(i + 4 * (j + 4 * k)); };
    const std::vector<std::int64_t> listed = {at(1, 1, 0), at(1, 1, 1), at(0, 0, 0), at(0, 0, 1)};
    const hex::FeatureSet features = hex::features_from_vertices(c.mesh, c.edges, c.boundary, listed);
    EXPECT_EQ(features.sharp_edge_count(), 1u);
    EXPECT_EQ(features.vertex[static_cast<std::size_t>(at(1, 1, 0))], VertexFeature::smooth);
    EXPECT_EQ(features.vertex[0], VertexFeature::corner);
}

TEST(Features, FromAListRejectVerticesThatDoNotExist) {
    const Case c(hex::test::grid(1, 1, 1));
    for (const std::int64_t v : {std::int64_t{-1}, std::int64_t{8}}) {
        const std::vector<std::int64_t> listed = {v};
        try {
            (void)hex::features_from_vertices(c.mesh, c.edges, c.boundary, listed);
            FAIL() << "vertex " << v << " was accepted";
        } catch (const hex::Error& error) {
            EXPECT_EQ(error.kind(), hex::ErrorKind::bad_input);
            EXPECT_NE(std::string(error.what()).find(std::to_string(v)), std::string::npos);
        }
    }
}

}  // namespace
