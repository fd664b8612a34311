#include "map/blend.h"
#include "map/inner_points.h"

#include <hex/map/transfinite.h>

namespace hex {

void fill_inside(FaceGrid& face) {
    const int m = face.nu(), n = face.nv();
    for_each_inner_point(face, [&](int i, int j, double u, double v) {
        face(i, j) = blend(v, face(i, 0), face(i, n)) + blend(u, face(0, j), face(m, j)) -
                     blend(u, v, face(0, 0), face(m, 0), face(0, n), face(m, n));
    });
}

void fill_inside(BlockGrid& block) {
    const int l = block.nu(), m = block.nv(), n = block.nw();
    for_each_inner_point(block, [&](int i, int j, int k, double u, double v, double w) {
        const Vec3 faces = blend(u, block(0, j, k), block(l, j, k)) +
                           blend(v, block(i, 0, k), block(i, m, k)) +
                           blend(w, block(i, j, 0), block(i, j, n));
        const Vec3 edges = blend(v, w, block(i, 0, 0), block(i, m, 0), block(i, 0, n), block(i, m, n)) +
                           blend(u, w, block(0, j, 0), block(l, j, 0), block(0, j, n), block(l, j, n)) +
                           blend(u, v, block(0, 0, k), block(l, 0, k), block(0, m, k), block(l, m, k));
        const Vec3 corners =
            blend(u, blend(v, w, block(0, 0, 0), block(0, m, 0), block(0, 0, n), block(0, m, n)),
                  blend(v, w, block(l, 0, 0), block(l, m, 0), block(l, 0, n), block(l, m, n)));
        block(i, j, k) = faces - edges + corners;
    });
}

}  // namespace hex
