#include "map/blend.h"

#include <hex/map/linear_blend.h>

namespace hex {
namespace {

double weight(double t) {
    return 1.0 / (t * (1.0 - t));
}

}  // namespace

void blend_linearly(FaceGrid& face) {
    const int m = face.nu();
    const int n = face.nv();
    for (int j = 1; j < n; ++j) {
        const double v = static_cast<double>(j) / n;
        for (int i = 1; i < m; ++i) {
            const double u = static_cast<double>(i) / m;
            face(i, j) = (weight(u) * blend(u, face(0, j), face(m, j)) +
                          weight(v) * blend(v, face(i, 0), face(i, n))) /
                         (weight(u) + weight(v));
        }
    }
}

void blend_linearly(BlockGrid& block) {
    const int l = block.nu();
    const int m = block.nv();
    const int n = block.nw();
    for (int k = 1; k < n; ++k) {
        const double w = static_cast<double>(k) / n;
        for (int j = 1; j < m; ++j) {
            const double v = static_cast<double>(j) / m;
            for (int i = 1; i < l; ++i) {
                const double u = static_cast<double>(i) / l;
                block(i, j, k) = (weight(u) * blend(u, block(0, j, k), block(l, j, k)) +
                                  weight(v) * blend(v, block(i, 0, k), block(i, m, k)) +
                                  weight(w) * blend(w, block(i, j, 0), block(i, j, n))) /
                                 (weight(u) + weight(v) + weight(w));
            }
        }
    }
}

}  // namespace hex
