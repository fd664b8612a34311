// Verdict's metrics of a hexahedron. Sums are formed in Verdict's order: near singular elements the last bits
// decide.
#include "quality/verdict_metrics.h"

#include <hex/volume/hexahedron.h>

#include <algorithm>
#include <cmath>

namespace hex::quality {
namespace {

double length(const Point& a) {
    return std::sqrt(squared_length(a));
}

double clamp(double value) {
    return std::clamp(value, -verdict_max, verdict_max);
}

double safe_ratio(double numerator, double denominator) {
    const bool usable = std::abs(numerator) <= verdict_max && std::abs(denominator) >= verdict_min;
    return usable ? numerator / denominator : verdict_max;
}

/// The three edges that leave a corner, right-handed for a positive element.
struct Frame {
    Point a, b, c;
    double determinant() const { return quality::determinant(a, b, c); }
    double square_sum() const { return dot(a, a) + dot(b, b) + dot(c, c); }
};

Frame corner_frame(const Corners& p, std::size_t corner) {
    const auto& next = hexahedron::corner_neighbours[corner];
    const auto edge = [&](std::size_t i) { return p[static_cast<std::size_t>(next[i])] - p[corner]; };
    return {edge(0), edge(1), edge(2)};
}

/// Sum of four corners less the four others, one after the other.
Point corner_difference(const Corners& p, std::array<int, 4> plus, std::array<int, 4> minus) {
    Point sum = p[static_cast<std::size_t>(plus[0])];
    for (std::size_t i = 1; i < 4; ++i) sum = sum + p[static_cast<std::size_t>(plus[i])];
    for (const int i : minus) sum = sum - p[static_cast<std::size_t>(i)];
    return sum;
}

/// Four times the derivatives of the trilinear map at the centre.
Frame principal_axes(const Corners& p) {
    return {corner_difference(p, {1, 2, 5, 6}, {0, 3, 4, 7}),
            corner_difference(p, {2, 3, 6, 7}, {0, 1, 4, 5}),
            corner_difference(p, {4, 5, 6, 7}, {0, 1, 2, 3})};
}

/// |A| |A^-1| in the Frobenius norm.
double condition_of(const Frame& f) {
    const double det = f.determinant();
    if (det <= verdict_min) return verdict_max;
    const Point ab = cross(f.a, f.b), bc = cross(f.b, f.c), ca = cross(f.c, f.a);
    return std::sqrt(f.square_sum() * (dot(ab, ab) + dot(bc, bc) + dot(ca, ca))) / det;
}

double oddy_of(const Frame& f) {
    const double det = f.determinant();
    if (det <= verdict_min) return verdict_max;
    const double aa = dot(f.a, f.a), ab = dot(f.a, f.b), ac = dot(f.a, f.c);
    const double bb = dot(f.b, f.b), bc = dot(f.b, f.c), cc = dot(f.c, f.c);
    const double metric_square = aa * aa + 2.0 * ab * ab + 2.0 * ac * ac + bb * bb + 2.0 * bc * bc + cc * cc;
    const double trace = aa + bb + cc;
    return (metric_square - 1.0 / 3.0 * trace * trace) / std::pow(det, 4.0 / 3.0);
}

std::array<double, 4> diagonals(const Corners& p) {
    return {length(p[6] - p[0]), length(p[4] - p[2]), length(p[7] - p[1]), length(p[5] - p[3])};
}

double shortest_edge(const Corners& p) {
    double shortest = verdict_max;
    for (const auto& [a, b] : hexahedron::edge_corners)
        shortest =
            std::min(shortest, length(p[static_cast<std::size_t>(b)] - p[static_cast<std::size_t>(a)]));
    return shortest;
}

double corner_sign(int node, std::size_t axis) {
    return hexahedron::corner_uvw[static_cast<std::size_t>(node)][axis] == 0 ? -1.0 : 1.0;
}

/// Jacobian determinant of the trilinear map from [-1, 1]^3.
double trilinear_jacobian(const Corners& p, const std::array<double, 3>& at) {
    Frame sum{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int node = 0; node < 8; ++node) {
        const double u = corner_sign(node, 0), v = corner_sign(node, 1), w = corner_sign(node, 2);
        const double along_u = 1 + u * at[0], along_v = 1 + v * at[1], along_w = 1 + w * at[2];
        const Point& point = p[static_cast<std::size_t>(node)];
        sum.a = sum.a + 0.125 * u * along_v * along_w * point;
        sum.b = sum.b + 0.125 * v * along_u * along_w * point;
        sum.c = sum.c + 0.125 * w * along_u * along_v * point;
    }
    return sum.determinant();
}

/// Derivatives of the volume of the hexahedron by the coordinates of its corners (Flanagan and Belytschko
/// 1981, equation 79), in the direction that belongs to the coordinates `second` and `third`.
std::array<double, 8> volume_gradient(const Corners& p, double Point::*second, double Point::*third) {
    // Corner c of the formula for corner 0, seen from corner i.
    static constexpr std::array<std::array<std::size_t, 8>, 8> seen_from = {{{0, 1, 2, 3, 4, 5, 6, 7},
                                                                             {1, 2, 3, 0, 5, 6, 7, 4},
                                                                             {2, 3, 0, 1, 6, 7, 4, 5},
                                                                             {3, 0, 1, 2, 7, 4, 5, 6},
                                                                             {4, 7, 6, 5, 0, 3, 2, 1},
                                                                             {5, 4, 7, 6, 1, 0, 3, 2},
                                                                             {6, 5, 4, 7, 2, 1, 0, 3},
                                                                             {7, 6, 5, 4, 3, 2, 1, 0}}};
    std::array<double, 8> gradient;
    for (std::size_t i = 0; i < 8; ++i) {
        const auto& turn = seen_from[i];
        const auto y = [&](std::size_t c) { return p[turn[c]].*second; };
        const auto z = [&](std::size_t c) { return p[turn[c]].*third; };
        const double z24 = z(1) - z(3), z52 = z(4) - z(1), z45 = z(3) - z(4);
        gradient[i] = (y(1) * (z(5) - z(2) - z45) + y(2) * z24 + y(3) * (z(2) - z(7) - z52) +
                       y(4) * (z(7) - z(5) - z24) + y(5) * z52 + y(7) * z45) /
                      12.0;
    }
    return gradient;
}

/// Angles at the corners of a face, in degrees. Verdict's rule for a face that is not convex: the largest is
/// replaced by what it lacks to 360.
struct FaceAngles {
    double smallest = 360.0;
    double largest = 0.0;
    bool defined = true;
};

FaceAngles face_angles(const Corners& p, const std::array<int, 4>& face) {
    std::array<Point, 4> edge;
    std::array<double, 4> size;
    FaceAngles angles;
    const auto corner = [&](std::size_t i) -> const Point& {
        return p[static_cast<std::size_t>(face[i % 4])];
    };
    for (std::size_t i = 0; i < 4; ++i) {
        edge[i] = corner(i + 1) - corner(i);
        size[i] = length(edge[i]);
        if (size[i] <= verdict_min) angles.defined = false;
    }
    if (!angles.defined) return {0.0, 180.0, false};
    // Twice the face's area vector: which way its corners turn is judged against it.
    const Point normal = cross(edge[0] - edge[2], edge[1] - edge[3]);
    bool reentrant = false;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        const double cosine = -dot(edge[i], edge[next]) / (size[i] * size[next]);
        const double degrees = std::acos(std::clamp(cosine, -1.0, 1.0)) * (180.0 / 3.14159265358979323846);
        angles.smallest = std::min(angles.smallest, degrees);
        angles.largest = std::max(angles.largest, degrees);
        if (dot(cross(edge[i], edge[next]), normal) < 0.0) reentrant = true;
    }
    if (reentrant) angles.largest = 360.0 - angles.largest;
    return angles;
}

FaceAngles all_angles(const Corners& p) {
    FaceAngles all;
    for (const auto& face : hexahedron::face_corners) {
        const FaceAngles angles = face_angles(p, face);
        all.smallest = std::min(all.smallest, angles.smallest);
        all.largest = std::max(all.largest, angles.largest);
    }
    return all;
}

}  // namespace

double max_aspect_frobenius(const Corners& p) {
    double largest = condition_of(corner_frame(p, 0));
    for (std::size_t c = 1; c < 8; ++c) largest = std::max(largest, condition_of(corner_frame(p, c)));
    return std::min(largest, verdict_max) / 3.0;
}

double med_aspect_frobenius(const Corners& p) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 8; ++c) sum += condition_of(corner_frame(p, c));
    return clamp(sum / 24.0);
}

double diagonal(const Corners& p) {
    const auto d = diagonals(p);
    return clamp(safe_ratio(*std::min_element(d.begin(), d.end()), *std::max_element(d.begin(), d.end())));
}

double dimension(const Corners& p) {
    const auto x = volume_gradient(p, &Point::y, &Point::z);
    const auto y = volume_gradient(p, &Point::z, &Point::x);
    const auto z = volume_gradient(p, &Point::x, &Point::y);
    double size = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < 8; ++i) size += p[i].x * x[i];
    for (const auto& gradient : {x, y, z})
        for (const double value : gradient) squares += value * value;
    return squares > 0.0 ? std::sqrt(0.5 * (size * size) / squares) : 0.0;
}

double distortion(const Corners& p) {
    constexpr std::array<double, 2> gauss = {-0.577350269189626, 0.577350269189626};
    double smallest = verdict_max, size = 0.0;
    for (const double u : gauss) {
        for (const double v : gauss) {
            for (const double w : gauss) {
                const double value = trilinear_jacobian(p, {u, v, w});
                smallest = std::min(smallest, value);
                size += value;
            }
        }
    }
    for (int node = 0; node < 8; ++node)
        smallest = std::min(smallest, trilinear_jacobian(p, {corner_sign(node, 0), corner_sign(node, 1),
                                                             corner_sign(node, 2)}));
    return std::abs(size) > 0.0 ? clamp(smallest / size * 8.0) : verdict_max;
}

double edge_ratio(const Corners& p) {
    // As VTK 9.1 computes it, the longest is looked for among six of the twelve edges only.
    constexpr std::array<std::array<std::size_t, 2>, 12> edges = {
        {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
    double shortest = verdict_max, longest = 0.0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const double square = squared_length(p[edges[e][1]] - p[edges[e][0]]);
        shortest = std::min(shortest, square);
        if (e < 6) longest = std::max(longest, square);
    }
    return shortest < verdict_min ? verdict_max : clamp(std::sqrt(longest / shortest));
}

double jacobian(const Corners& p) {
    double smallest = principal_axes(p).determinant() / 64.0;
    for (std::size_t c = 0; c < 8; ++c) smallest = std::min(smallest, corner_frame(p, c).determinant());
    return clamp(smallest);
}

double nodal_jacobian_ratio(const Corners& p) {
    double smallest = verdict_max, largest = -verdict_max;
    for (std::size_t c = 0; c < 8; ++c) {
        const double value = corner_frame(p, c).determinant();
        smallest = std::min(smallest, value);
        largest = std::max(largest, value);
    }
    return largest <= verdict_min ? -verdict_max : smallest / largest;
}

double max_edge_ratio(const Corners& p) {
    const Frame axes = principal_axes(p);
    const double a = length(axes.a), b = length(axes.b), c = length(axes.c);
    const auto ratio = [](double s, double t) { return safe_ratio(std::max(s, t), std::min(s, t)); };
    return clamp(std::max(ratio(a, b), std::max(ratio(a, c), ratio(b, c))));
}

double oddy(const Corners& p) {
    double largest = std::max(0.0, oddy_of(principal_axes(p)));
    for (std::size_t c = 0; c < 8; ++c) largest = std::max(largest, oddy_of(corner_frame(p, c)));
    return clamp(largest);
}

double relative_size_squared(const Corners& p, double average_volume) {
    // Verdict takes the cube root of the average volume, with a third of eleven digits, and its cube again.
    const double scale = std::pow(average_volume, 0.33333333333);
    const double weight = scale * (scale * scale);
    if (average_volume == 0.0 || !(weight >= verdict_min)) return 0.0;
    double sum = 0.0;
    for (std::size_t c = 0; c < 8; ++c) sum += corner_frame(p, c).determinant();
    if (sum <= verdict_min) return 0.0;
    const double tau = sum / (8.0 * weight);
    const double smaller = std::min(tau, 1.0 / tau);
    return clamp(smaller * smaller);
}

double shape(const Corners& p) {
    double smallest = 1.0;
    for (std::size_t c = 0; c < 8; ++c) {
        const Frame frame = corner_frame(p, c);
        const double det = frame.determinant();
        if (det <= verdict_min) return 0.0;
        smallest = std::min(smallest, 3.0 * std::pow(det, 2.0 / 3.0) / frame.square_sum());
    }
    return smallest <= verdict_min ? 0.0 : smallest;
}

double shear(const Corners& p) {
    double smallest = 1.0;
    for (std::size_t c = 0; c < 8; ++c) {
        const Frame frame = corner_frame(p, c);
        const double a = squared_length(frame.a), b = squared_length(frame.b), e = squared_length(frame.c);
        if (a <= verdict_min || b <= verdict_min || e <= verdict_min) return 0.0;
        const double det = frame.determinant();
        if (det < verdict_min) return 0.0;
        smallest = std::min(smallest, det / std::sqrt(a * b * e));
    }
    return smallest <= verdict_min ? 0.0 : smallest;
}

double skew(const Corners& p) {
    Frame axes = principal_axes(p);
    for (Point* axis : {&axes.a, &axes.b, &axes.c}) {
        const double size = length(*axis);
        if (size <= verdict_min) return verdict_max;
        *axis = {axis->x / size, axis->y / size, axis->z / size};
    }
    return std::max(std::abs(dot(axes.a, axes.b)),
                    std::max(std::abs(dot(axes.a, axes.c)), std::abs(dot(axes.b, axes.c))));
}

double stretch(const Corners& p) {
    const auto d = diagonals(p);
    return clamp(std::sqrt(3.0) * safe_ratio(shortest_edge(p), *std::max_element(d.begin(), d.end())));
}

double taper(const Corners& p) {
    const Frame axes = principal_axes(p);
    const double a = length(axes.a), b = length(axes.b), c = length(axes.c);
    const double ab = length(corner_difference(p, {0, 2, 4, 6}, {1, 3, 5, 7}));
    const double ac = length(corner_difference(p, {0, 3, 5, 6}, {1, 2, 4, 7}));
    const double bc = length(corner_difference(p, {0, 1, 6, 7}, {2, 3, 4, 5}));
    return clamp(std::max(safe_ratio(ab, std::min(a, b)),
                          std::max(safe_ratio(ac, std::min(a, c)), safe_ratio(bc, std::min(b, c)))));
}

double volume(const Corners& p) {
    // The Jacobian at the centre times the volume of the reference cube; the volume itself for a
    // parallelepiped.
    return clamp(principal_axes(p).determinant() / 64.0);
}

double equiangle_skew(const Corners& p) {
    const FaceAngles angles = all_angles(p);
    return std::max((angles.largest - 90.0) / 90.0, (90.0 - angles.smallest) / 90.0);
}

double aspect_ratio(const Corners& p) {
    double shortest = verdict_max, longest = 0.0;
    for (const auto& [a, b] : hexahedron::edge_corners) {
        const double size = length(p[static_cast<std::size_t>(b)] - p[static_cast<std::size_t>(a)]);
        shortest = std::min(shortest, size);
        longest = std::max(longest, size);
    }
    return clamp(safe_ratio(longest, shortest));
}

double min_angle(const Corners& p) {
    return all_angles(p).smallest;
}

double max_angle(const Corners& p) {
    return all_angles(p).largest;
}

double warpage(const Corners& p) {
    double largest = 0.0;
    for (const auto& face : hexahedron::face_corners) {
        const auto corner = [&](std::size_t i) -> const Point& {
            return p[static_cast<std::size_t>(face[i])];
        };
        // Over either diagonal the face falls into two triangles.
        for (const std::size_t start : {std::size_t{0}, std::size_t{1}}) {
            const Point &a = corner(start), &b = corner(start + 1), &c = corner(start + 2),
                        &d = corner((start + 3) % 4);
            const Point one = cross(b - a, c - a), other = cross(c - a, d - a);
            const double size = std::max({length(b - a), length(c - a), length(d - a)});
            if (length(one) * length(other) <= verdict_min * size * size * size * size) return 180.0;
            // Exact for flat faces, too, where the arc cosine loses half of the digits.
            const double angle = std::atan2(length(cross(one, other)), dot(one, other));
            largest = std::max(largest, angle * (180.0 / 3.14159265358979323846));
        }
    }
    return largest;
}

}  // namespace hex::quality
