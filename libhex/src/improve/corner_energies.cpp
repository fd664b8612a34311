#include "improve/quality_numbers.h"

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

using Numbers = improving::QualityNumbers<double>;

Numbers numbers_of(const HexCorners& corners) {
    std::array<quality::Vector<double>, 8> p;
    for (std::size_t i = 0; i < 8; ++i) p[i] = {corners[i].x(), corners[i].y(), corners[i].z()};
    return {p, 1.0, 0.0};
}

/// All above the floor, which what is not a number is not.
bool above(const Numbers& numbers, double floor) {
    return std::all_of(numbers.value.begin(), numbers.value.end(), [&](double q) { return q > floor; });
}

void add_gradient(const Numbers& numbers, const std::array<double, Numbers::count>& slope,
                  HexCorners& gradient) {
    const auto own = numbers.gradient(slope);
    for (std::size_t k = 0; k < 8; ++k) gradient[k] += Vec3(own[k].x, own[k].y, own[k].z);
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

double ShortEdgeEnergy::evaluate(const HexCorners& corners, const Vec3& reference,
                                 HexCorners* gradient) const {
    double sum = 0.0;
    for (const auto& ends : hexahedron::edge_corners) {
        const auto a = static_cast<std::size_t>(ends[0]);
        const auto b = static_cast<std::size_t>(ends[1]);
        const Vec3 edge = corners[b] - corners[a];
        const double wanted = share * reference[static_cast<Eigen::Index>(axis_between(ends[0], ends[1]))];
        const double square = edge.squaredNorm();
        if (square >= wanted * wanted) continue;
        if (!(square > 0.0)) return infinity;
        const double logarithm = 0.5 * std::log(wanted * wanted / square);
        sum += weight * logarithm * logarithm;
        if (gradient == nullptr) continue;
        const Vec3 slope = 2.0 * weight * logarithm / square * edge;
        (*gradient)[a] += slope;
        (*gradient)[b] -= slope;
    }
    return sum;
}

double QualityBarrier::evaluate(const HexCorners& corners, HexCorners* gradient) const {
    const Numbers numbers = numbers_of(corners);
    if (!above(numbers, floor)) return infinity;
    std::array<double, Numbers::count> slope;
    double product = 1.0;
    for (std::size_t k = 0; k < slope.size(); ++k) {
        const double gap = numbers.value[k] - floor;
        product *= gap;
        slope[k] = -1.0 / gap;
    }
    if (gradient != nullptr) add_gradient(numbers, slope, *gradient);
    return -std::log(product);
}

double QualityMean::evaluate(const HexCorners& corners, HexCorners* gradient) const {
    const Numbers numbers = numbers_of(corners);
    if (!above(numbers, floor)) return infinity;
    const auto power = [](double x) { return (x * x) * (x * x) * (x * x); };
    double sum = 1e-18;  // the root has no slope at 0
    double product = 1.0;
    for (const double q : numbers.value) {
        sum += power(1.0 - q);
        product *= q - floor;
    }
    const double norm = std::cbrt(std::sqrt(sum));
    if (gradient != nullptr) {
        std::array<double, Numbers::count> slope;
        for (std::size_t k = 0; k < slope.size(); ++k) {
            const double defect = 1.0 - numbers.value[k];
            slope[k] = -norm / sum * (defect * defect) * (defect * defect) * defect -
                       barrier_weight / (numbers.value[k] - floor);
        }
        add_gradient(numbers, slope, *gradient);
    }
    return norm - barrier_weight * std::log(product);
}

}  // namespace hex
