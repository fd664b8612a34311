#include "map/blend.h"

#include <hex/map/transfinite.h>

namespace hex {

void fill_inside(FaceGrid& face) {
    const int m = face.nu();
    const int n = face.nv();
    for (int j = 1; j < n; ++j) {
        const double v = static_cast<double>(j) / n;
        for (int i = 1; i < m; ++i) {
            const double u = static_cast<double>(i) / m;
            face(i, j) = blend(v, face(i, 0), face(i, n)) + blend(u, face(0, j), face(m, j)) -
                         blend(u, v, face(0, 0), face(m, 0), face(0, n), face(m, n));
        }
    }
}

void fill_inside(BlockGrid& block) {
    const int l = block.nu();
    const int m = block.nv();
    const int n = block.nw();
    for (int k = 1; k < n; ++k) {
        const double w = static_cast<double>(k) / n;
        for (int j = 1; j < m; ++j) {
            const double v = static_cast<double>(j) / m;
            const Vec3 corners_at_0 =
                blend(v, w, block(0, 0, 0), block(0, m, 0), block(0, 0, n), block(0, m, n));
            const Vec3 corners_at_1 =
                blend(v, w, block(l, 0, 0), block(l, m, 0), block(l, 0, n), block(l, m, n));
            for (int i = 1; i < l; ++i) {
                const double u = static_cast<double>(i) / l;
                const Vec3 faces = blend(u, block(0, j, k), block(l, j, k)) +
                                   blend(v, block(i, 0, k), block(i, m, k)) +
                                   blend(w, block(i, j, 0), block(i, j, n));
                const Vec3 edges =
                    blend(v, w, block(i, 0, 0), block(i, m, 0), block(i, 0, n), block(i, m, n)) +
                    blend(u, w, block(0, j, 0), block(l, j, 0), block(0, j, n), block(l, j, n)) +
                    blend(u, v, block(0, 0, k), block(l, 0, k), block(0, m, k), block(l, m, k));
                const Vec3 corners = blend(u, corners_at_0, corners_at_1);
                block(i, j, k) = faces - edges + corners;
            }
        }
    }
}

}  // namespace hex
