#include <hex/improve/corner_energies.h>
#include <hex/volume/hexahedron.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hex {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Local axis (0, 1, 2 for u, v, w) of the edge between two corners.
constexpr std::size_t axis_between(int a, int b) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (hexahedron::corner_uvw[static_cast<std::size_t>(a)][i] !=
            hexahedron::corner_uvw[static_cast<std::size_t>(b)][i])
            return i;
    }
    return 0;
}

/// The three edges at a corner, divided by the reference lengths.
struct Frame {
    std::array<std::size_t, 3> neighbour;
    std::array<double, 3> scale;
    std::array<Vec3, 3> edge;

    Frame(const HexCorners& corners, std::size_t corner, const Vec3& inverse_reference) {
        for (std::size_t i = 0; i < 3; ++i) {
            const int n = hexahedron::corner_neighbours[corner][i];
            neighbour[i] = static_cast<std::size_t>(n);
            scale[i] =
                inverse_reference[static_cast<Eigen::Index>(axis_between(static_cast<int>(corner), n))];
            edge[i] = scale[i] * (corners[neighbour[i]] - corners[corner]);
        }
    }
    double determinant() const { return edge[0].dot(edge[1].cross(edge[2])); }
    /// Derivative of the determinant for edge i.
    Vec3 cofactor(std::size_t i) const { return edge[(i + 1) % 3].cross(edge[(i + 2) % 3]); }
    void scatter(std::size_t corner, std::size_t i, const Vec3& edge_gradient, HexCorners& gradient) const {
        const Vec3 scaled = scale[i] * edge_gradient;
        gradient[neighbour[i]] += scaled;
        gradient[corner] -= scaled;
    }
};

/// -log(q - floor) of the scaled determinant q of three vectors, with its derivative for each.
double barrier(const std::array<Vec3, 3>& vectors, double floor, std::array<Vec3, 3>* gradient) {
    const std::array<double, 3> square = {vectors[0].squaredNorm(), vectors[1].squaredNorm(),
                                          vectors[2].squaredNorm()};
    const double product = square[0] * square[1] * square[2];
    if (!(product > 0.0)) return infinity;
    const double inverse_volume = 1.0 / std::sqrt(product);
    const Vec3 cross = vectors[1].cross(vectors[2]);
    const double q = inverse_volume * vectors[0].dot(cross);
    const double gap = q - floor;
    if (!(gap > 0.0)) return infinity;
    if (gradient != nullptr) {
        const double factor = -1.0 / gap;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 cofactor = i == 0 ? cross : vectors[(i + 1) % 3].cross(vectors[(i + 2) % 3]);
            (*gradient)[i] = factor * (inverse_volume * cofactor - (q / square[i]) * vectors[i]);
        }
    }
    return -std::log(gap);
}

}  // namespace

double FoldoverEnergy::evaluate(const HexCorners& corners, const Vec3& reference,
                                HexCorners* gradient) const {
    const Vec3 inverse = reference.cwiseInverse();
    double sum = 0.0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const Frame frame(corners, corner, inverse);
        const double det = frame.determinant();
        const double root = std::sqrt(epsilon * epsilon + det * det);
        // The second form has no cancellation where det is negative.
        const double chi = det > 0.0 ? 0.5 * (det + root) : 0.5 * epsilon * epsilon / (root - det);
        if (!(chi > 0.0)) return infinity;
        const double trace =
            frame.edge[0].squaredNorm() + frame.edge[1].squaredNorm() + frame.edge[2].squaredNorm();
        const double cube_root = std::cbrt(chi);
        const double shape_factor = 1.0 / (cube_root * cube_root);
        const double size = det * det + 1.0;
        sum += trace * shape_factor + size_weight * size / chi;
        if (gradient == nullptr) continue;
        const double chi_slope = chi / root;
        const double det_slope = -2.0 / 3.0 * trace * shape_factor / chi * chi_slope +
                                 size_weight * (2.0 * det - size / chi * chi_slope) / chi;
        for (std::size_t i = 0; i < 3; ++i)
            frame.scatter(corner, i, 2.0 * shape_factor * frame.edge[i] + det_slope * frame.cofactor(i),
                          *gradient);
    }
    return sum;
}

double FoldoverEnergy::smallest_determinant(const HexCorners& corners, const Vec3& reference) {
    const Vec3 inverse = reference.cwiseInverse();
    double smallest = infinity;
    for (std::size_t corner = 0; corner < 8; ++corner)
        smallest = std::min(smallest, Frame(corners, corner, inverse).determinant());
    return smallest;
}

double QualityBarrier::evaluate(const HexCorners& corners, HexCorners* gradient) const {
    double sum = 0.0;
    std::array<Vec3, 3> slope;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const Frame frame(corners, corner, Vec3::Ones());
        const double value = barrier(frame.edge, floor, gradient == nullptr ? nullptr : &slope);
        if (value == infinity) return infinity;
        sum += value;
        if (gradient == nullptr) continue;
        for (std::size_t i = 0; i < 3; ++i) frame.scatter(corner, i, slope[i], *gradient);
    }
    // The principal axes at the centre, times four.
    std::array<Vec3, 3> axes = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        for (std::size_t i = 0; i < 3; ++i)
            axes[i] += hexahedron::corner_uvw[corner][i] == 1 ? corners[corner] : Vec3(-corners[corner]);
    }
    const double value = barrier(axes, floor, gradient == nullptr ? nullptr : &slope);
    if (value == infinity) return infinity;
    if (gradient != nullptr) {
        for (std::size_t corner = 0; corner < 8; ++corner) {
            for (std::size_t i = 0; i < 3; ++i) {
                if (hexahedron::corner_uvw[corner][i] == 1)
                    (*gradient)[corner] += slope[i];
                else
                    (*gradient)[corner] -= slope[i];
            }
        }
    }
    return sum + value;
}

}  // namespace hex
