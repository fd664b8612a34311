#include "support/meshes.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/volume/hex_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

namespace hex {
namespace {

using Cells = std::vector<HexCell>;

HexCell cell_of(std::array<int, 8> ids) {
    HexCell cell;
    for (std::size_t i = 0; i < 8; ++i) cell[i] = VertexId(static_cast<std::size_t>(ids[i]));
    return cell;
}

/// What the constructor says to `cells` on `count` points.
std::string problem_of(std::size_t count, const Cells& cells, int threads = 2) {
    Context context;
    context.threads = threads;
    try {
        with_threads(context, [&] { HexMesh(std::vector<Vec3>(count, Vec3::Zero()), cells); });
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        return error.what();
    }
    return "";
}

std::array<VertexId, 4> sorted(std::array<VertexId, 4> vertices) {
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

void expect_consistent_twins(const HexMesh& mesh) {
    for (const HalfFaceId h : mesh.half_faces()) {
        const HalfFaceId t = mesh.twin(h);
        if (!t.valid()) continue;
        ASSERT_EQ(mesh.twin(t), h);
        ASSERT_NE(HexMesh::cell_of(t), HexMesh::cell_of(h));
        // Seen from the other side the vertices run the other way round.
        auto mine = mesh.face_vertices(h);
        const auto theirs = mesh.face_vertices(t);
        std::reverse(mine.begin(), mine.end());
        std::rotate(mine.begin(), std::find(mine.begin(), mine.end(), theirs[0]), mine.end());
        ASSERT_EQ(mine, theirs);
    }
}

/// No two half-faces without a twin lie on the same vertices: none was overlooked.
void expect_complete_twins(const HexMesh& mesh) {
    std::set<std::array<VertexId, 4>> boundary;
    for (const HalfFaceId h : mesh.half_faces()) {
        if (!mesh.is_boundary(h)) continue;
        ASSERT_TRUE(boundary.insert(sorted(mesh.face_vertices(h))).second);
    }
}

std::size_t boundary_count(const HexMesh& mesh) {
    std::size_t count = 0;
    for (const HalfFaceId h : mesh.half_faces()) count += mesh.is_boundary(h);
    return count;
}

TEST(HexMesh, AnEmptyMeshHasNothing) {
    const HexMesh mesh({}, {});
    EXPECT_TRUE(mesh.empty());
    EXPECT_EQ(mesh.half_face_count(), 0u);
    EXPECT_TRUE(bounding_box(mesh).empty());
}

TEST(HexMesh, OneCellHasSixBoundaryHalfFacesThatLookOutwards) {
    const HexMesh mesh = test::grid(1, 1, 1);
    ASSERT_EQ(boundary_count(mesh), 6u);
    for (const HalfFaceId h : mesh.half_faces()) {
        const auto v = mesh.face_vertices(h);
        const Vec3 a = mesh.position(v[0]);
        const Vec3 normal = (mesh.position(v[1]) - a).cross(mesh.position(v[2]) - a);
        EXPECT_GT(normal.dot(a - Vec3(0.5, 0.5, 0.5)), 0) << "half-face " << h;
    }
}

TEST(HexMesh, NeighboursInAGridAreTheCellsNextDoor) {
    const int nx = 3, ny = 4, nz = 5;
    const HexMesh mesh = test::grid(nx, ny, nz);
    EXPECT_EQ(boundary_count(mesh), 2u * (nx * ny + ny * nz + nz * nx));
    const auto cell = [&](int i, int j, int k) {
        const bool inside = i >= 0 && i < nx && j >= 0 && j < ny && k >= 0 && k < nz;
        return inside ? CellId(static_cast<std::size_t>(i + nx * (j + ny * k))) : CellId();
    };
    // Local faces: w=0, v=0, u=1, v=1, u=0, w=1.
    const std::array<std::array<int, 3>, 6> step = {
        {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                for (int f = 0; f < 6; ++f) {
                    const auto& d = step[static_cast<std::size_t>(f)];
                    EXPECT_EQ(mesh.neighbour(cell(i, j, k), f), cell(i + d[0], j + d[1], k + d[2]));
                }
}

TEST(HexMesh, TwinsAreMutualReversedAndComplete) {
    for (const HexMesh& mesh : {test::grid(4, 3, 5), test::fan(3, 2), test::fan(5, 3), test::fan(6, 1),
                                test::shuffled_grid(6, 5, 4, 7)}) {
        expect_consistent_twins(mesh);
        expect_complete_twins(mesh);
    }
}

TEST(HexMesh, ShufflingCellsAndTurningThemChangesNoNeighbourhood) {
    const HexMesh plain = test::grid(5, 6, 7);
    const HexMesh shuffled = test::shuffled_grid(5, 6, 7, 3);
    using Pair = std::pair<std::set<VertexId>, std::set<VertexId>>;
    const auto pairs = [](const HexMesh& mesh) {
        std::set<Pair> all;
        for (const HalfFaceId h : mesh.half_faces()) {
            if (mesh.is_boundary(h)) continue;
            const HexCell& a = mesh.cell(HexMesh::cell_of(h));
            const HexCell& b = mesh.cell(HexMesh::cell_of(mesh.twin(h)));
            all.emplace(std::set(a.begin(), a.end()), std::set(b.begin(), b.end()));
        }
        return all;
    };
    EXPECT_EQ(pairs(plain), pairs(shuffled));
    EXPECT_EQ(boundary_count(plain), boundary_count(shuffled));
}

TEST(HexMesh, TheStructureIsTheSameForAnyNumberOfThreads) {
    const HexMesh source = test::shuffled_grid(20, 20, 20, 11);
    const auto twins = [&](int threads) {
        Context context;
        context.threads = threads;
        return with_threads(context, [&] {
            const HexMesh mesh({source.positions().begin(), source.positions().end()},
                               {source.cell_array().begin(), source.cell_array().end()});
            std::vector<HalfFaceId> result;
            for (const HalfFaceId h : mesh.half_faces()) result.push_back(mesh.twin(h));
            return result;
        });
    };
    EXPECT_EQ(twins(1), twins(2));
    EXPECT_EQ(twins(1), twins(4));
}

TEST(HexMesh, PartsAreKeptAndDefaultToOne) {
    const HexMesh plain = test::grid(1, 1, 2);
    EXPECT_EQ(plain.part(CellId(1)), 1);
    const HexMesh with_parts({plain.positions().begin(), plain.positions().end()},
                             {plain.cell_array().begin(), plain.cell_array().end()}, {4, 9});
    EXPECT_EQ(with_parts.part(CellId(0)), 4);
    EXPECT_EQ(with_parts.part(CellId(1)), 9);
    EXPECT_THROW(HexMesh({plain.positions().begin(), plain.positions().end()},
                         {plain.cell_array().begin(), plain.cell_array().end()}, {4}),
                 Error);
}

TEST(HexMesh, PositionsCanBeReplacedButNotTheirNumber) {
    HexMesh mesh = test::grid(1, 1, 1);
    mesh.set_positions(std::vector<Vec3>(8, Vec3(1, 2, 3)));
    EXPECT_EQ(mesh.position(VertexId(7)), Vec3(1, 2, 3));
    mesh.set_position(VertexId(0), Vec3::Zero());
    EXPECT_EQ(mesh.corner_positions(CellId(0))[0], Vec3::Zero());
    EXPECT_THROW(mesh.set_positions({}), Error);
}

TEST(HexMesh, TheBoundingBoxLeavesOutVerticesThatNoCellUses) {
    const HexMesh grid = test::grid(1, 2, 3);
    std::vector<Vec3> points(grid.positions().begin(), grid.positions().end());
    points.emplace_back(100, 100, 100);
    const HexMesh mesh(points, {grid.cell_array().begin(), grid.cell_array().end()});
    EXPECT_EQ(bounding_box(mesh).upper, Vec3(1, 2, 3));
    EXPECT_EQ(bounding_box(mesh).lower, Vec3::Zero());
    EXPECT_EQ(mesh.vertex_count(), grid.vertex_count() + 1);
}

// Errors: each names its cells.

const HexCell unit = cell_of({0, 1, 2, 3, 4, 5, 6, 7});

TEST(HexMeshErrors, AVertexOutOfRangeIsNamedWithItsCell) {
    EXPECT_EQ(problem_of(8, {unit, cell_of({0, 1, 2, 3, 4, 5, 6, 8})}), "cell 1 uses vertex 8 of 8");
    HexCell none = unit;
    none[3] = VertexId();
    EXPECT_NE(problem_of(8, {none}).find("cell 0"), std::string::npos);
}

TEST(HexMeshErrors, ACellWithARepeatedVertexIsNamed) {
    EXPECT_EQ(problem_of(8, {cell_of({0, 1, 2, 3, 4, 5, 6, 4})}), "cell 0 uses vertex 4 twice");
}

TEST(HexMeshErrors, ACoordinateThatIsNotFiniteIsNamed) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity()}) {
        std::vector<Vec3> points(8, Vec3::Zero());
        points[5].y() = bad;
        try {
            const HexMesh mesh(points, {unit});
            FAIL() << "accepted " << bad;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("vertex 5"), std::string::npos) << error.what();
        }
    }
}

TEST(HexMeshErrors, ACellTwiceIsNamed) {
    EXPECT_NE(problem_of(8, {unit, unit}).find("cells 0, 1"), std::string::npos);
    // Turned about an axis it still lies on the same side of every face.
    EXPECT_NE(problem_of(8, {unit, cell_of({1, 2, 3, 0, 5, 6, 7, 4})}).find("cells 0, 1"), std::string::npos);
}

TEST(HexMeshErrors, ACellAndItsMirrorImageOnTheSameVerticesAreNamed) {
    EXPECT_EQ(problem_of(8, {unit, cell_of({4, 5, 6, 7, 0, 1, 2, 3})}),
              "two hexahedra have the same eight vertices: cells 0, 1");
}

TEST(HexMeshErrors, AFaceSharedByThreeCellsIsNamed) {
    const Cells cells = {unit, cell_of({4, 5, 6, 7, 8, 9, 10, 11}), cell_of({4, 5, 6, 7, 12, 13, 14, 15})};
    EXPECT_EQ(problem_of(16, cells), "a face is shared by more than two hexahedra: cells 0, 1, 2");
}

TEST(HexMeshErrors, NeighboursOnTheSameSideOfTheirFaceAreNamed) {
    // The second cell is inside out: its top is its bottom.
    const Cells cells = {unit, cell_of({8, 9, 10, 11, 4, 5, 6, 7})};
    EXPECT_NE(problem_of(12, cells).find("same side of their shared face: cells 0, 1"), std::string::npos);
}

TEST(HexMeshErrors, TheSameOfManyProblemsIsReportedForAnyNumberOfThreads) {
    // Every second cell of a long chain is inside out, in an order that scatters the problems over the
    // buckets.
    Cells cells;
    const int length = 4000;
    for (int k = 0; k < length; ++k) {
        const int layer = (k * 1237) % length;
        const int a = 4 * layer, b = a + 4;
        cells.push_back(layer % 2 == 0 ? cell_of({a, a + 1, a + 2, a + 3, b, b + 1, b + 2, b + 3})
                                       : cell_of({b, b + 1, b + 2, b + 3, a, a + 1, a + 2, a + 3}));
    }
    const std::string expected = problem_of(4 * (length + 1), cells, 1);
    // Layers 0 and 1 meet at the smallest vertices: cell 0 is layer 0, and 1237 k = 1 mod 4000 for k = 2173.
    EXPECT_NE(expected.find("cells 0, 2173"), std::string::npos) << expected;
    for (int repeat = 0; repeat < 20; ++repeat) EXPECT_EQ(problem_of(4 * (length + 1), cells, 4), expected);
}

}  // namespace
}  // namespace hex
