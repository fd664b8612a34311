/// \file improve_cases.h
/// Meshes and measures that the tests of `improve` share.
#pragma once

#include "support/meshes.h"

#include <hex/improve/improve.h>

#include <cstring>
#include <random>

namespace hex::test {

/// A grid whose vertices are shaken by up to `amount` edge lengths; boundary vertices of the box stay on
/// their faces and edges.
inline HexMesh shaken_grid(int nx, int ny, int nz, double amount, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-amount, amount);
    HexMesh mesh = shuffled_grid(nx, ny, nz, seed);
    const Vec3 top(nx, ny, nz);
    for (const VertexId v : mesh.vertices()) {
        Vec3 p = mesh.position(v);
        for (Eigen::Index d = 0; d < 3; ++d) {
            const double move = shift(random);
            if (p[d] != 0.0 && p[d] != top[d]) p[d] += move;
        }
        mesh.set_position(v, p);
    }
    return mesh;
}

inline ImproveOptions method(const std::string& name, int count = -1, double step = 0.0) {
    ImproveOptions options;
    options.method = name;
    options.count = count;
    options.step = step;
    options.features = FeatureSource::angle;
    return options;
}

/// The same cells and bit-identical positions.
inline bool identical(const HexMesh& a, const HexMesh& b) {
    return a.vertex_count() == b.vertex_count() && a.cell_count() == b.cell_count() &&
           std::equal(a.cell_array().begin(), a.cell_array().end(), b.cell_array().begin()) &&
           std::memcmp(a.positions().data(), b.positions().data(), a.positions().size_bytes()) == 0;
}

inline Context with_thread_count(int threads) {
    Context context;
    context.threads = threads;
    return context;
}

}  // namespace hex::test
