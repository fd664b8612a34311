/// \file vector.h
/// Three numbers and the few products that the metrics are made of. The operations are done in Verdict's
/// order, so that the numbers near a singular element agree with it to the last bits; Eigen adds in another.
#pragma once

namespace hex::quality {

/// `Real` is one number, or that of several elements side by side.
template <class Real>
struct Vector {
    Real x, y, z;
};

template <class Real>
[[gnu::always_inline]] constexpr Vector<Real> operator+(const Vector<Real>& a, const Vector<Real>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class Real>
[[gnu::always_inline]] constexpr Vector<Real> operator-(const Vector<Real>& a, const Vector<Real>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Real>
[[gnu::always_inline]] constexpr Vector<Real> operator*(const Real& factor, const Vector<Real>& a) {
    return {factor * a.x, factor * a.y, factor * a.z};
}

template <class Real>
[[gnu::always_inline]] constexpr Real dot(const Vector<Real>& a, const Vector<Real>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
[[gnu::always_inline]] constexpr Real squared_length(const Vector<Real>& a) {
    return dot(a, a);
}

template <class Real>
[[gnu::always_inline]] constexpr Vector<Real> cross(const Vector<Real>& a, const Vector<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// a . (b x c)
template <class Real>
[[gnu::always_inline]] constexpr Real determinant(const Vector<Real>& a, const Vector<Real>& b,
                                                  const Vector<Real>& c) {
    return dot(a, cross(b, c));
}

}  // namespace hex::quality
