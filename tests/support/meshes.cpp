#include "support/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace hex::test {
namespace {

struct GridArrays {
    std::vector<Vec3> points;
    std::vector<HexCell> cells;
};

GridArrays grid_arrays(int nx, int ny, int nz) {
    GridArrays g;
    const auto at = [=](int i, int j, int k) {
        return VertexId(static_cast<std::size_t>(i + (nx + 1) * (j + (ny + 1) * k)));
    };
    for (int k = 0; k <= nz; ++k)
        for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i) g.points.emplace_back(i, j, k);
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                g.cells.push_back({at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
                                   at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1),
                                   at(i, j + 1, k + 1)});
    return g;
}

/// The 24 rotations of the cube as corner permutations, found by composing two generators.
std::vector<std::array<int, 8>> cube_rotations() {
    const std::array<int, 8> about_w = {1, 2, 3, 0, 5, 6, 7, 4};
    const std::array<int, 8> about_u = {3, 2, 6, 7, 0, 1, 5, 4};
    std::vector<std::array<int, 8>> rotations = {{0, 1, 2, 3, 4, 5, 6, 7}};
    for (std::size_t i = 0; i < rotations.size(); ++i) {
        for (const auto& generator : {about_w, about_u}) {
            std::array<int, 8> next{};
            for (std::size_t c = 0; c < 8; ++c)
                next[c] = rotations[i][static_cast<std::size_t>(generator[c])];
            if (std::find(rotations.begin(), rotations.end(), next) == rotations.end())
                rotations.push_back(next);
        }
    }
    return rotations;
}

}  // namespace

HexMesh grid(int nx, int ny, int nz) {
    GridArrays g = grid_arrays(nx, ny, nz);
    return {std::move(g.points), std::move(g.cells)};
}

HexMesh shuffled_grid(int nx, int ny, int nz, unsigned seed) {
    GridArrays g = grid_arrays(nx, ny, nz);
    std::mt19937 random(seed);
    std::shuffle(g.cells.begin(), g.cells.end(), random);
    const auto rotations = cube_rotations();
    for (HexCell& cell : g.cells) {
        const auto& rotation = rotations[random() % rotations.size()];
        HexCell turned;
        for (std::size_t c = 0; c < 8; ++c) turned[c] = cell[static_cast<std::size_t>(rotation[c])];
        cell = turned;
    }
    return {std::move(g.points), std::move(g.cells)};
}

HexMesh fan(int valence, int layers) {
    // One layer of vertices: the centre, then for each sector a spoke end and an outer corner.
    std::vector<Vec3> points;
    std::vector<HexCell> cells;
    const auto per_layer = static_cast<std::size_t>(2 * valence + 1);
    const double angle = 2 * std::numbers::pi / valence;
    for (int k = 0; k <= layers; ++k) {
        points.emplace_back(0, 0, k);
        for (int s = 0; s < valence; ++s) points.emplace_back(std::cos(s * angle), std::sin(s * angle), k);
        for (int s = 0; s < valence; ++s) {
            const double middle = (s + 0.5) * angle;
            const double radius = 1.3;
            points.emplace_back(radius * std::cos(middle), radius * std::sin(middle), k);
        }
    }
    for (int k = 0; k < layers; ++k) {
        for (int s = 0; s < valence; ++s) {
            const std::array<std::size_t, 4> ring = {0, static_cast<std::size_t>(1 + s),
                                                     static_cast<std::size_t>(1 + valence + s),
                                                     static_cast<std::size_t>(1 + (s + 1) % valence)};
            HexCell cell;
            for (std::size_t c = 0; c < 4; ++c) {
                cell[c] = VertexId(ring[c] + per_layer * static_cast<std::size_t>(k));
                cell[c + 4] = VertexId(ring[c] + per_layer * static_cast<std::size_t>(k + 1));
            }
            cells.push_back(cell);
        }
    }
    return {std::move(points), std::move(cells)};
}

PolygonSoup box_surface(double x, double y, double z, int n) {
    PolygonSoup soup;
    std::map<std::array<int, 3>, std::uint32_t> index;
    const auto vertex = [&](const std::array<int, 3>& p) {
        const auto [entry, added] = index.emplace(p, static_cast<std::uint32_t>(soup.points.size()));
        if (added) soup.points.emplace_back(x * p[0] / n, y * p[1] / n, z * p[2] / n);
        return entry->second;
    };
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2;
        const bool upper = side % 2 == 0;
        for (int a = 0; a < n; ++a) {
            for (int b = 0; b < n; ++b) {
                const auto at = [&](int da, int db) {
                    std::array<int, 3> p{};
                    p[static_cast<std::size_t>(axis)] = upper ? n : 0;
                    p[static_cast<std::size_t>((axis + 1) % 3)] = a + da;
                    p[static_cast<std::size_t>((axis + 2) % 3)] = b + db;
                    return vertex(p);
                };
                std::array<std::uint32_t, 4> q = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
                if (!upper) std::swap(q[1], q[3]);
                soup.add_polygon(std::array{q[0], q[1], q[2]}, side + 1);
                soup.add_polygon(std::array{q[0], q[2], q[3]}, side + 1);
            }
        }
    }
    return soup;
}

}  // namespace hex::test
