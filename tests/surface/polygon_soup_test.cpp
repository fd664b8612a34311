#include "support/meshes.h"

#include <hex/base/error.h>
#include <hex/surface/polygon_soup.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <set>

namespace hex {
namespace {

using test::box_surface;

PolygonSoup soup_of(std::vector<Vec3> points, const std::vector<std::vector<std::uint32_t>>& polygons) {
    PolygonSoup soup;
    soup.points = std::move(points);
    for (std::size_t f = 0; f < polygons.size(); ++f) soup.add_polygon(polygons[f], static_cast<int>(f) + 1);
    return soup;
}

const std::vector<Vec3> tetrahedron_points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

std::string message_of(const PolygonSoup& soup, const SurfaceRequirements& requirements = {}) {
    try {
        make_triangle_mesh(soup, requirements);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        return error.what();
    }
    return {};
}

TEST(PolygonSoup, AClosedBoxKeepsIndicesPartsAndVolume) {
    const PolygonSoup soup = box_surface(2, 3, 4, 3);
    const TriangleMesh mesh = make_triangle_mesh(soup);
    EXPECT_EQ(mesh.n_faces(), soup.size());
    EXPECT_EQ(mesh.n_vertices(), soup.points.size());
    EXPECT_NEAR(enclosed_volume(mesh), 24.0, 1e-12);
    const PolygonSoup back = to_soup(mesh);
    EXPECT_EQ(back.parts, soup.parts);
    for (std::size_t v = 0; v < soup.points.size(); ++v) EXPECT_EQ(back.points[v], soup.points[v]);
    for (std::size_t f = 0; f < soup.size(); ++f) {
        EXPECT_EQ(mesh.data(mesh.face_handle(static_cast<unsigned>(f))).source, static_cast<std::int64_t>(f));
        const std::set<std::uint32_t> a(soup.polygon(f).begin(), soup.polygon(f).end());
        const std::set<std::uint32_t> b(back.polygon(f).begin(), back.polygon(f).end());
        EXPECT_EQ(a, b);
    }
}

TEST(PolygonSoup, VolumeDoesNotLoseDigitsFarFromTheOrigin) {
    PolygonSoup soup = box_surface(1, 1, 1, 2);
    for (Vec3& p : soup.points) p += Vec3(1048576, -2097152, 4194304);
    EXPECT_NEAR(enclosed_volume(make_triangle_mesh(soup)), 1.0, 1e-12);
}

TEST(PolygonSoup, BadSurfacesAreRejectedWithTheirPlace) {
    EXPECT_NE(message_of(soup_of(tetrahedron_points, {})).find("no faces"), std::string::npos);
    EXPECT_NE(message_of(soup_of(tetrahedron_points, {{0, 1}})).find("polygon 0 has fewer"),
              std::string::npos);
    EXPECT_NE(
        message_of(soup_of(tetrahedron_points, {{0, 2, 1}, {0, 1, 9}})).find("polygon 1 uses vertex 9 of 4"),
        std::string::npos);
    EXPECT_NE(message_of(soup_of(tetrahedron_points, {{0, 2, 2}})).find("vertex 2 twice"), std::string::npos);
    // open
    EXPECT_NE(message_of(soup_of(tetrahedron_points, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}))
                  .find("open: 3 boundary edges"),
              std::string::npos);
    // one face turned over
    EXPECT_NE(message_of(soup_of(tetrahedron_points, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}}))
                  .find("oriented"),
              std::string::npos);
    // three faces on edge 0-1
    EXPECT_NE(message_of(soup_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, -1}},
                                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 1, 4}}))
                  .find("more than two faces, the first between vertices 0 and 1"),
              std::string::npos);
    // not finite
    auto points = tetrahedron_points;
    points[3].y() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(message_of(soup_of(points, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}})).find("vertex 3"),
              std::string::npos);
}

TEST(PolygonSoup, TwoSheetsThatTouchInAVertexAreRejected) {
    const auto soup =
        soup_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {0, 5, 6}});
    EXPECT_NE(message_of(soup).find("touches itself at vertex 0"), std::string::npos);
}

TEST(PolygonSoup, TwoFacesThatShareNeighbouringEdgesAreRejected) {
    // A tetrahedron with a vertex put on edge 0-1, which then has two faces only.
    auto points = tetrahedron_points;
    points.emplace_back(0.5, 0, 0);
    const auto soup = soup_of(points, {{0, 2, 1, 4}, {0, 4, 1, 3}, {1, 2, 3}, {0, 3, 2}});
    EXPECT_NE(message_of(soup).find("neighbouring edges at vertices 4"), std::string::npos);
    // On a boundary two faces at a vertex are nothing unusual.
    EXPECT_EQ(message_of(soup_of(tetrahedron_points, {{0, 2, 1}, {0, 1, 3}}), {.closed = false}), "");
}

TEST(PolygonSoup, AnOpenSurfacePassesWhenItMayBeOpen) {
    const auto soup = soup_of(tetrahedron_points, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}});
    EXPECT_EQ(message_of(soup, {.closed = false}), "");
}

TEST(Triangulate, PolygonsBecomeTrianglesThatKnowTheirPolygon) {
    // A prism over an L-shaped (concave) hexagon: two hexagons and six quads.
    std::vector<Vec3> points;
    for (const double z : {0.0, 1.0})
        for (const auto& [x, y] : {std::pair(0, 0), {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}})
            points.emplace_back(x, y, z);
    std::vector<std::vector<std::uint32_t>> polygons = {{5, 4, 3, 2, 1, 0}, {6, 7, 8, 9, 10, 11}};
    for (std::uint32_t i = 0; i < 6; ++i) polygons.push_back({i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6});
    const PolygonSoup soup = soup_of(points, polygons);
    const PolyMesh poly = make_poly_mesh(soup);
    EXPECT_EQ(poly.n_faces(), 8U);
    const TriangleMesh mesh = triangulate(poly);
    EXPECT_EQ(mesh.n_faces(), 2U * 4 + 6U * 2);
    EXPECT_NEAR(enclosed_volume(mesh), 3.0, 1e-12);
    std::vector<int> count(8, 0);
    std::int64_t last = 0;
    for (const auto f : mesh.faces()) {
        const auto source = mesh.data(f).source;
        EXPECT_GE(source, last) << "triangles come in the order of their polygons";
        last = source;
        ++count[static_cast<std::size_t>(source)];
        EXPECT_EQ(mesh.data(f).part, source + 1);
    }
    EXPECT_EQ(count, (std::vector<int>{4, 4, 2, 2, 2, 2, 2, 2}));
}

/// A prism over a star with `rays` rays (concave when `inner` is small), 2 rays corners a polygon.
PolygonSoup star_prism(std::uint32_t rays, double inner) {
    const std::uint32_t n = 2 * rays;
    std::vector<Vec3> points;
    for (const double z : {0.0, 1.0})
        for (std::uint32_t i = 0; i < n; ++i) {
            const double radius = i % 2 == 0 ? 1.0 : inner, angle = 2 * std::numbers::pi * i / n;
            points.emplace_back(radius * std::cos(angle), z, -radius * std::sin(angle));
        }
    std::vector<std::vector<std::uint32_t>> polygons(2);
    for (std::uint32_t i = 0; i < n; ++i) {
        polygons[0].push_back(n - 1 - i);
        polygons[1].push_back(n + i);
        polygons.push_back({i, (i + 1) % n, (i + 1) % n + n, i + n});
    }
    return soup_of(points, polygons);
}

TEST(Triangulate, PolygonsWithManyCornersAreFilled) {
    for (const double inner : {1.0, 0.5}) {
        constexpr std::uint32_t rays = 3000;
        const TriangleMesh mesh = make_triangle_mesh(star_prism(rays, inner));
        EXPECT_EQ(mesh.n_faces(), 2U * (2 * rays - 2) + 2U * 2 * rays);
        EXPECT_NEAR(enclosed_volume(mesh), rays * inner * std::sin(std::numbers::pi / rays), 1e-9);
        std::set<std::int64_t> sources;
        for (const auto f : mesh.faces()) {
            sources.insert(mesh.data(f).source);
            EXPECT_EQ(mesh.data(f).part, mesh.data(f).source + 1);
        }
        EXPECT_EQ(sources.size(), 2U * rays + 2);
    }
}

TEST(Triangulate, TheTimeDoesNotGrowWithTheSquareOfTheCorners) {
    const auto clocks = [](std::uint32_t rays) {
        const PolygonSoup soup = star_prism(rays, 1.0);
        const auto start = std::clock();
        make_triangle_mesh(soup);
        return static_cast<double>(std::clock() - start);
    };
    // Eight times as many take 8 to 10 times as long; going through all corners for each of them, 40.
    const double few = std::min(clocks(5000), clocks(5000));
    EXPECT_LT(clocks(40000), 20 * few);
}

TEST(Triangulate, ALargePolygonThatCrossesItselfIsRefused) {
    PolygonSoup soup = star_prism(1000, 1.0);
    std::swap(soup.points[10], soup.points[500]);
    std::swap(soup.points[2010], soup.points[2500]);
    EXPECT_NE(message_of(soup).find("polygon 0 cannot be split"), std::string::npos) << message_of(soup);
    for (Vec3& point : soup.points) point.x() = 0.0;
    EXPECT_NE(message_of(soup).find("cannot be split"), std::string::npos) << message_of(soup);
}

TEST(Inspect, TellsIsolatedVerticesComponentsAndInsideOut) {
    PolygonSoup soup = box_surface(1, 1, 1);
    const auto n = static_cast<std::uint32_t>(soup.points.size());
    const PolygonSoup second = box_surface(1, 1, 1);
    for (const Vec3& p : second.points) soup.points.push_back(p + Vec3(3, 0, 0));
    for (std::size_t f = 0; f < second.size(); ++f) {
        const auto p = second.polygon(f);
        soup.add_polygon(std::array{p[0] + n, p[1] + n, p[2] + n});
    }
    soup.points.emplace_back(9, 9, 9);
    const auto codes = [](const Diagnostics& diagnostics) {
        std::set<std::string> result;
        for (const auto& d : diagnostics) result.insert(d.code);
        return result;
    };
    EXPECT_EQ(codes(inspect(make_triangle_mesh(soup))),
              (std::set<std::string>{"isolated-vertices", "components"}));
    EXPECT_NEAR(bounding_box(make_triangle_mesh(soup)).upper.x(), 4.0, 0.0)
        << "isolated vertices do not count";

    PolygonSoup turned = box_surface(1, 1, 1);
    for (std::size_t f = 0; f < turned.size(); ++f)
        std::swap(turned.corners[3 * f], turned.corners[3 * f + 1]);
    EXPECT_EQ(codes(inspect(make_triangle_mesh(turned))), (std::set<std::string>{"inside-out"}));
}

}  // namespace
}  // namespace hex
