#include <hex/volume/hexahedron.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace hex::hexahedron {
namespace {

Eigen::Vector3d point(int corner) {
    const auto& uvw = corner_uvw[static_cast<std::size_t>(corner)];
    return {double(uvw[0]), double(uvw[1]), double(uvw[2])};
}

TEST(Hexahedron, CornerAtIsTheInverseOfCornerUvw) {
    for (int c = 0; c < corner_count; ++c) {
        const auto& uvw = corner_uvw[static_cast<std::size_t>(c)];
        EXPECT_EQ(corner_at(uvw[0], uvw[1], uvw[2]), c);
    }
}

TEST(Hexahedron, FacesArePlanarSquaresThatLookOutwards) {
    const Eigen::Vector3d centre(0.5, 0.5, 0.5);
    for (const auto& face : face_corners) {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const int c : face) middle += point(c) / 4;
        for (std::size_t i = 0; i < 4; ++i) {
            const Eigen::Vector3d normal = (point(face[(i + 1) % 4]) - point(face[i]))
                                               .cross(point(face[(i + 2) % 4]) - point(face[(i + 1) % 4]));
            EXPECT_TRUE(normal.isApprox(2 * (middle - centre)));
        }
    }
}

TEST(Hexahedron, OppositeFacesShareNoCorner) {
    for (std::size_t f = 0; f < 6; ++f) {
        std::set<int> corners(face_corners[f].begin(), face_corners[f].end());
        const auto& other = face_corners[static_cast<std::size_t>(opposite_face[f])];
        corners.insert(other.begin(), other.end());
        EXPECT_EQ(corners.size(), 8u);
    }
}

TEST(Hexahedron, EdgesAreThePairsAtDistanceOne) {
    for (int a = 0; a < corner_count; ++a) {
        for (int b = 0; b < corner_count; ++b) {
            const int e = edge_between(a, b);
            EXPECT_EQ(e >= 0, (point(a) - point(b)).norm() == 1.0);
            EXPECT_EQ(e, edge_between(b, a));
        }
    }
}

TEST(Hexahedron, NeighboursOfACornerMakeARightHandedFrame) {
    for (int c = 0; c < corner_count; ++c) {
        Eigen::Matrix3d frame;
        for (int k = 0; k < 3; ++k) {
            const int n = corner_neighbours[static_cast<std::size_t>(c)][static_cast<std::size_t>(k)];
            EXPECT_GE(edge_between(c, n), 0);
            frame.col(k) = point(n) - point(c);
        }
        EXPECT_EQ(frame.determinant(), 1.0);
    }
}

TEST(Hexahedron, FacesOfCornersAndEdgesAreThoseThatContainThem) {
    const auto contains = [](std::size_t f, int c) {
        return std::count(face_corners[f].begin(), face_corners[f].end(), c) > 0;
    };
    for (std::size_t c = 0; c < 8; ++c) {
        std::vector<int> faces;
        for (std::size_t f = 0; f < 6; ++f) {
            if (contains(f, static_cast<int>(c))) faces.push_back(static_cast<int>(f));
        }
        EXPECT_EQ(faces, std::vector<int>(corner_faces[c].begin(), corner_faces[c].end()));
    }
    for (std::size_t e = 0; e < 12; ++e) {
        std::vector<int> faces;
        for (std::size_t f = 0; f < 6; ++f) {
            if (contains(f, edge_corners[e][0]) && contains(f, edge_corners[e][1]))
                faces.push_back(static_cast<int>(f));
        }
        EXPECT_EQ(faces, std::vector<int>(edge_faces[e].begin(), edge_faces[e].end()));
    }
}

TEST(Hexahedron, BezierPointsOfACornerAreItsLatticeCornerAndTheBodyPointNextToIt) {
    for (std::size_t c = 0; c < 8; ++c) {
        const auto& uvw = corner_uvw[c];
        EXPECT_EQ(bezier_corner[c], 3 * uvw[0] + 4 * 3 * uvw[1] + 16 * 3 * uvw[2]);
        EXPECT_EQ(bezier_body[c], (1 + uvw[0]) + 4 * (1 + uvw[1]) + 16 * (1 + uvw[2]));
    }
}

}  // namespace
}  // namespace hex::hexahedron
