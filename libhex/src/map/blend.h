/// \file blend.h
/// Linear and bilinear interpolation, of which the blends of faces and blocks are made.
#pragma once

#include <hex/base/linear_algebra.h>

namespace hex {

/// `at_0` for t = 0, `at_1` for t = 1.
inline Vec3 blend(double t, const Vec3& at_0, const Vec3& at_1) {
    return (1.0 - t) * at_0 + t * at_1;
}

/// `at_st` for s and t of 0 or 1.
inline Vec3 blend(double s, double t, const Vec3& at_00, const Vec3& at_10, const Vec3& at_01,
                  const Vec3& at_11) {
    return blend(t, blend(s, at_00, at_10), blend(s, at_01, at_11));
}

}  // namespace hex
