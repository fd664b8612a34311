// What is written reads back the same: points to the last bit, corners, part ids.
#include "support/meshes.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/mesh_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <climits>
#include <clocale>
#include <cmath>
#include <locale>
#include <random>

namespace hex::io {
namespace {

using test::TemporaryFolder;

std::filesystem::path file(const TemporaryFolder& folder, const char* stem, std::string_view extension) {
    return folder / std::string(stem).append(extension);
}

/// Coordinates that need all 17 digits, of very different size.
Vec3 awkward_point(std::mt19937_64& random) {
    std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
    std::uniform_int_distribution<int> exponent(-40, 40);
    Vec3 point;
    for (int k = 0; k < 3; ++k) point[k] = std::ldexp(mantissa(random), exponent(random));
    return point;
}

PolygonSoup awkward_surface() {
    PolygonSoup soup = test::box_surface(1, 1, 1, 3);
    std::mt19937_64 random(7);
    for (Vec3& point : soup.points) point = awkward_point(random);
    return soup;
}

HexMesh awkward_hexahedra() {
    const HexMesh grid = test::shuffled_grid(3, 2, 4, 5);
    std::mt19937_64 random(11);
    std::vector<Vec3> points(grid.vertex_count());
    for (Vec3& point : points) point = awkward_point(random);
    std::vector<int> parts;
    for (std::size_t c = 0; c < grid.cell_count(); ++c) parts.push_back(static_cast<int>(c % 3) + 1);
    return {std::move(points), {grid.cell_array().begin(), grid.cell_array().end()}, std::move(parts)};
}

/// Triangles, quadrilaterals and a pentagon.
PolygonSoup polygons() {
    PolygonSoup soup;
    std::mt19937_64 random(3);
    for (int i = 0; i < 9; ++i) soup.points.push_back(awkward_point(random));
    soup.add_polygon(std::array<std::uint32_t, 3>{0, 1, 2}, 1);
    soup.add_polygon(std::array<std::uint32_t, 4>{2, 1, 3, 4}, 2);
    soup.add_polygon(std::array<std::uint32_t, 5>{8, 7, 6, 5, 4}, 7);
    return soup;
}

bool same_points(std::span<const Vec3> a, std::span<const Vec3> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

class SurfaceRoundTrip : public testing::TestWithParam<std::string> {};

TEST_P(SurfaceRoundTrip, KeepsPointsToTheLastBitAndTriangles) {
    const TemporaryFolder folder;
    const PolygonSoup soup = awkward_surface();
    write_surface(file(folder, "a", GetParam()), soup);
    const SurfaceFile back = read_surface(file(folder, "a", GetParam()));
    EXPECT_TRUE(back.diagnostics.empty());
    if (GetParam() == ".stl") {
        // Welding numbers the vertices in the order of their first use.
        ASSERT_EQ(back.soup.corners.size(), soup.corners.size());
        for (std::size_t i = 0; i < soup.corners.size(); ++i)
            ASSERT_EQ(back.soup.points[back.soup.corners[i]], soup.points[soup.corners[i]]);
        EXPECT_EQ(back.soup.points.size(), soup.points.size());
    } else {
        EXPECT_TRUE(same_points(back.soup.points, soup.points));
        EXPECT_EQ(back.soup.corners, soup.corners);
    }
    EXPECT_EQ(back.soup.offsets, soup.offsets);
    EXPECT_EQ(back.soup.parts.size(), soup.size());
}

TEST_P(SurfaceRoundTrip, KeepsPartIdsWhereTheTableSaysSo) {
    const TemporaryFolder folder;
    const PolygonSoup soup = awkward_surface();
    write_surface(file(folder, "a", GetParam()), soup);
    const auto parts = read_surface(file(folder, "a", GetParam())).soup.parts;
    for (const FormatInfo& info : formats()) {
        if (info.extensions.front() != GetParam() && info.extensions.back() != GetParam()) continue;
        EXPECT_EQ(parts == soup.parts, info.part_ids) << info.name;
    }
}

TEST_P(SurfaceRoundTrip, WritesTheSameBytesAgain) {
    const TemporaryFolder folder;
    write_surface(file(folder, "a", GetParam()), awkward_surface());
    write_surface(file(folder, "b", GetParam()), read_surface(file(folder, "a", GetParam())).soup);
    EXPECT_EQ(test::read_text(file(folder, "a", GetParam())), test::read_text(file(folder, "b", GetParam())));
}

TEST_P(SurfaceRoundTrip, KeepsPolygonsOrRefusesThem) {
    const TemporaryFolder folder;
    const PolygonSoup soup = polygons();
    const auto path = file(folder, "a", GetParam());
    const auto& infos = formats();
    const auto info = std::find_if(infos.begin(), infos.end(), [&](const FormatInfo& f) {
        return std::find(f.extensions.begin(), f.extensions.end(), GetParam()) != f.extensions.end();
    });
    if (info->most_corners == 0) {
        write_surface(path, soup);
        const auto back = read_surface(path).soup;
        EXPECT_EQ(back.corners, soup.corners);
        EXPECT_EQ(back.offsets, soup.offsets);
    } else {
        EXPECT_THROW(write_surface(path, soup), Error);
        EXPECT_FALSE(std::filesystem::exists(path)) << "nothing half-written stays behind";
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, SurfaceRoundTrip,
                         testing::Values(".k", ".key", ".vtk", ".vtu", ".mesh", ".mfem", ".inp", ".msh",
                                         ".msh2", ".ovm", ".stl", ".obj", ".off", ".ply"),
                         [](const auto& instance) { return instance.param.substr(1); });

class HexRoundTrip : public testing::TestWithParam<std::string> {};

TEST_P(HexRoundTrip, KeepsPointsToTheLastBitCellsAndParts) {
    const TemporaryFolder folder;
    const HexMesh mesh = awkward_hexahedra();
    write_hex_mesh(file(folder, "a", GetParam()), mesh);
    const HexFile back = read_hex_mesh(file(folder, "a", GetParam()));
    EXPECT_TRUE(back.diagnostics.empty());
    EXPECT_TRUE(same_points(back.mesh.positions(), mesh.positions()));
    EXPECT_TRUE(std::equal(back.mesh.cell_array().begin(), back.mesh.cell_array().end(),
                           mesh.cell_array().begin(), mesh.cell_array().end()));
    for (const CellId c : mesh.cells()) ASSERT_EQ(back.mesh.part(c), mesh.part(c));
    write_hex_mesh(file(folder, "b", GetParam()), back.mesh);
    EXPECT_EQ(test::read_text(file(folder, "a", GetParam())), test::read_text(file(folder, "b", GetParam())));
}

TEST_P(HexRoundTrip, KeepsVerticesThatNoCellUses) {
    const TemporaryFolder folder;
    const HexMesh grid = test::grid(1, 1, 1);
    std::vector<Vec3> points(grid.positions().begin(), grid.positions().end());
    points.insert(points.begin() + 3, Vec3(9, 9, 9));
    points.emplace_back(8, 8, 8);
    HexCell cell = grid.cell(CellId(0));
    for (VertexId& v : cell) v = VertexId(v.index() >= 3 ? v.index() + 1 : v.index());
    write_hex_mesh(file(folder, "a", GetParam()), HexMesh(points, {cell}));
    const HexMesh back = read_hex_mesh(file(folder, "a", GetParam())).mesh;
    EXPECT_TRUE(same_points(back.positions(), points));
    EXPECT_EQ(back.cell(CellId(0)), cell);
}

INSTANTIATE_TEST_SUITE_P(Formats, HexRoundTrip,
                         testing::Values(".k", ".key", ".vtk", ".vtu", ".mesh", ".mfem", ".inp", ".msh",
                                         ".msh2"),
                         [](const auto& instance) { return instance.param.substr(1); });

TEST(OpenVolumeMesh, KeepsHexahedraThoughTheirCornersMayStartElsewhere) {
    const TemporaryFolder folder;
    const HexMesh grid = test::shuffled_grid(3, 2, 4, 5);
    std::vector<int> parts;
    for (std::size_t c = 0; c < grid.cell_count(); ++c) parts.push_back(static_cast<int>(c % 3) - 1);
    const HexMesh mesh({grid.positions().begin(), grid.positions().end()},
                       {grid.cell_array().begin(), grid.cell_array().end()}, parts);
    write_hex_mesh(folder / "a.ovm", mesh);
    const HexMesh back = read_hex_mesh(folder / "a.ovm").mesh;
    EXPECT_TRUE(same_points(back.positions(), mesh.positions()));
    ASSERT_EQ(back.cell_count(), mesh.cell_count());
    for (const CellId c : mesh.cells()) {
        HexCell a = back.cell(c), b = mesh.cell(c);
        const Vec3 u = back.position(a[1]) - back.position(a[0]),
                   v = back.position(a[3]) - back.position(a[0]);
        EXPECT_GT(u.cross(v).dot(back.position(a[4]) - back.position(a[0])), 0.5) << "not turned inside out";
        std::sort(a.begin(), a.end());
        std::sort(b.begin(), b.end());
        EXPECT_EQ(a, b);
        EXPECT_EQ(back.part(c), mesh.part(c));
    }
}

TEST(PartNames, SurviveWhereTheTableSaysSo) {
    const TemporaryFolder folder;
    const PartNames names = {{1, "hub"}, {3, "rim of the wheel"}};
    Fields fields;
    fields.part_names = names;
    for (const FormatInfo& info : formats()) {
        const auto path = file(folder, "n", info.extensions.front());
        if (info.writes_hexahedra) {
            write_hex_mesh(path, awkward_hexahedra(), fields);
            const HexFile back = read_hex_mesh(path);
            EXPECT_EQ(back.part_names, info.part_names ? names : PartNames()) << info.name;
        }
        if (info.part_names) {
            write_surface(path, awkward_surface(), names);
            EXPECT_EQ(read_surface(path).part_names, names) << info.name;
        }
    }
}

TEST(PartIds, ZeroNegativeAndTheLargestSurviveOrTheElementsAreNamed) {
    const TemporaryFolder folder;
    const HexMesh grid = test::grid(3, 1, 1);
    for (const int odd : {0, -7, INT_MIN, INT_MAX}) {
        const HexMesh mesh({grid.positions().begin(), grid.positions().end()},
                           {grid.cell_array().begin(), grid.cell_array().end()}, {2, odd, 1});
        PolygonSoup soup = test::box_surface(1, 1, 1);
        soup.parts[1] = odd;
        for (const FormatInfo& info : formats()) {
            const auto path = file(folder, "p", info.extensions.front());
            const bool carries =
                odd > 0 || (info.name != "MFEM" && (odd == 0 || !info.name.starts_with("Gmsh")));
            if (!info.writes_hexahedra) continue;
            if (carries) {
                write_hex_mesh(path, mesh);
                EXPECT_EQ(read_hex_mesh(path).mesh.part(CellId(1)), odd) << info.name;
                EXPECT_EQ(read_hex_mesh(path).mesh.part(CellId(0)), 2) << info.name;
                write_surface(path, soup);
                EXPECT_EQ(read_surface(path).soup.parts, soup.parts) << info.name;
                continue;
            }
            try {
                write_hex_mesh(path, mesh);
                FAIL() << info.name;
            } catch (const Error& error) {
                EXPECT_NE(error.problem().find("hexahedra 1 have"), std::string::npos) << error.what();
                EXPECT_NE(error.advice().find("another format"), std::string::npos) << error.what();
            }
            EXPECT_THROW(write_surface(path, soup), Error);
        }
    }
}

TEST(OutputName, MayBeAsLongAsTheFileSystemTakes) {
    const TemporaryFolder folder;
    const std::string name = std::string(251, 'n') + ".off";
    write_surface(folder / name, awkward_surface());
    EXPECT_EQ(read_surface(folder / name).soup.size(), awkward_surface().size());
}

TEST(Quadrilaterals, SurviveInEveryFormatForThem) {
    const TemporaryFolder folder;
    PolygonSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
    soup.add_polygon(std::array<std::uint32_t, 4>{0, 1, 2, 3}, 5);
    soup.add_polygon(std::array<std::uint32_t, 3>{1, 4, 2}, 6);
    for (const std::string extension :
         {".k", ".vtk", ".vtu", ".mfem", ".inp", ".msh", ".msh2", ".ovm", ".obj", ".ply"}) {
        write_surface(file(folder, "q", extension), soup);
        const auto back = read_surface(file(folder, "q", extension)).soup;
        EXPECT_EQ(back.corners, soup.corners) << extension;
        EXPECT_EQ(back.offsets, soup.offsets) << extension;
        EXPECT_EQ(back.parts, soup.parts) << extension;
    }
    // Medit has a list for each kind.
    write_surface(folder / "q.mesh", soup);
    const auto back = read_surface(folder / "q.mesh").soup;
    EXPECT_EQ(back.parts, (std::vector<int>{6, 5}));
    EXPECT_EQ(back.polygon(1).size(), 4u);
}

TEST(Dispatch, TakesExtensionsInAnyCase) {
    const TemporaryFolder folder;
    write_surface(folder / "a.OfF", awkward_surface());
    EXPECT_EQ(read_surface(folder / "a.OfF").soup.size(), awkward_surface().size());
    write_hex_mesh(folder / "a.VTK", awkward_hexahedra());
    EXPECT_EQ(read_hex_mesh(folder / "a.VTK").mesh.cell_count(), 24u);
}

TEST(Dispatch, TellsWhatAFileHolds) {
    const TemporaryFolder folder;
    for (const std::string extension :
         {".k", ".vtk", ".vtu", ".mesh", ".mfem", ".inp", ".msh", ".msh2", ".ovm"}) {
        write_surface(file(folder, "s", extension), awkward_surface());
        write_hex_mesh(file(folder, "h", extension), awkward_hexahedra());
        EXPECT_TRUE(std::holds_alternative<SurfaceFile>(read_mesh_file(file(folder, "s", extension))))
            << extension;
        EXPECT_TRUE(std::holds_alternative<HexFile>(read_mesh_file(file(folder, "h", extension))))
            << extension;
        EXPECT_THROW(read_surface(file(folder, "h", extension)), Error) << extension;
        EXPECT_THROW(read_hex_mesh(file(folder, "s", extension)), Error) << extension;
    }
}

TEST(Dispatch, FormatTableMatchesWhatReadersAndWritersDo) {
    const TemporaryFolder folder;
    for (const FormatInfo& info : formats()) {
        for (const auto extension : info.extensions) {
            const auto path = file(folder, "t", std::string(extension));
            if (info.writes_surfaces) {
                EXPECT_NO_THROW(write_surface(path, awkward_surface())) << extension;
            } else {
                EXPECT_THROW(write_surface(path, awkward_surface()), Error) << extension;
            }
            if (info.writes_hexahedra) {
                EXPECT_NO_THROW(write_hex_mesh(path, awkward_hexahedra())) << extension;
            } else {
                EXPECT_THROW(write_hex_mesh(path, awkward_hexahedra()), Error) << extension;
            }
        }
    }
    EXPECT_EQ(extensions_of(&FormatInfo::writes_hexahedra),
              ".k .key .vtk .vtu .mesh .mfem .inp .msh .msh2 .ovm");
}

TEST(Fields, AreWrittenWhereTheyCanBeAndRefusedElsewhere) {
    const TemporaryFolder folder;
    const HexMesh mesh = awkward_hexahedra();
    Fields fields;
    fields.cell.push_back({"scaled Jacobian", std::vector<double>(mesh.cell_count(), 0.25)});
    fields.vertex.push_back({"level<\"&", std::vector<double>(mesh.vertex_count(), 1.0 / 3.0)});
    for (const std::string extension : {".vtk", ".vtu"}) {
        write_hex_mesh(file(folder, "f", extension), mesh, fields);
        const HexFile back = read_hex_mesh(file(folder, "f", extension));
        EXPECT_TRUE(same_points(back.mesh.positions(), mesh.positions())) << extension;
        EXPECT_TRUE(back.diagnostics.empty()) << extension;
        EXPECT_EQ(back.mesh.part(CellId(2)), mesh.part(CellId(2))) << extension;
    }
    EXPECT_THROW(write_hex_mesh(folder / "f.k", mesh, fields), Error);
    fields.cell[0].values.pop_back();
    EXPECT_THROW(write_hex_mesh(folder / "g.vtk", mesh, fields), Error);
    EXPECT_FALSE(std::filesystem::exists(folder / "g.vtk"));
}

/// What a German or French locale does to numbers in streams, whether or not the machine has one.
struct DecimalComma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(Locale, WithADecimalCommaChangesNothing) {
    const TemporaryFolder folder;
    const PolygonSoup soup = awkward_surface();
    for (const FormatInfo& info : formats())
        if (info.writes_surfaces) write_surface(file(folder, "a", info.extensions.front()), soup);
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
    // The C library's locale too, where the machine has one.
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE"}) {
        if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
    for (const FormatInfo& info : formats()) {
        if (!info.writes_surfaces) continue;
        const auto extension = info.extensions.front();
        write_surface(file(folder, "b", extension), soup);
        EXPECT_EQ(test::read_text(file(folder, "a", extension)),
                  test::read_text(file(folder, "b", extension)))
            << extension;
        EXPECT_EQ(same_points(read_surface(file(folder, "a", extension)).soup.points, soup.points),
                  extension != ".stl")
            << extension;
    }
    std::locale::global(before);
    std::setlocale(LC_ALL, "C");
}

}  // namespace
}  // namespace hex::io
