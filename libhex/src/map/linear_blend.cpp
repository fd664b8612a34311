#include "map/blend.h"
#include "map/inner_points.h"

#include <hex/map/linear_blend.h>

namespace hex {
namespace {

double weight(double t) {
    return 1.0 / (t * (1.0 - t));
}

}  // namespace

void blend_linearly(FaceGrid& face) {
    const int m = face.nu(), n = face.nv();
    for_each_inner_point(face, [&](int i, int j, double u, double v) {
        face(i, j) =
            (weight(u) * blend(u, face(0, j), face(m, j)) + weight(v) * blend(v, face(i, 0), face(i, n))) /
            (weight(u) + weight(v));
    });
}

void blend_linearly(BlockGrid& block) {
    const int l = block.nu(), m = block.nv(), n = block.nw();
    for_each_inner_point(block, [&](int i, int j, int k, double u, double v, double w) {
        block(i, j, k) = (weight(u) * blend(u, block(0, j, k), block(l, j, k)) +
                          weight(v) * blend(v, block(i, 0, k), block(i, m, k)) +
                          weight(w) * blend(w, block(i, j, 0), block(i, j, n))) /
                         (weight(u) + weight(v) + weight(w));
    });
}

}  // namespace hex
