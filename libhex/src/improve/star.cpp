#include "improve/star.h"

#include "volume/counting_rows.h"

#include <algorithm>
#include <cmath>

namespace hex::improving {
namespace {

using quality::difference;
using quality::lane_count;
using quality::Lanes;
using quality::Vector;

/// turned_corner[c][i]: the corner of a cell that takes the place of corner i when the cell is turned so that
/// c comes to corner 0.
constexpr std::array<std::array<int, 8>, 8> make_turned_corners() {
    const auto add = [](int base, int a, int b) {
        // The corner reached from `base` along the directions base -> a and base -> b.
        const auto& o = hexahedron::corner_uvw[base];
        const auto& p = hexahedron::corner_uvw[a];
        const auto& q = hexahedron::corner_uvw[b];
        return hexahedron::corner_at(p[0] + q[0] - o[0], p[1] + q[1] - o[1], p[2] + q[2] - o[2]);
    };
    std::array<std::array<int, 8>, 8> table{};
    for (int c = 0; c < 8; ++c) {
        const auto& n = hexahedron::corner_neighbours[c];
        table[c] = {c, n[0], add(c, n[0], n[1]), n[1], n[2], add(c, n[0], n[2]), 0, add(c, n[1], n[2])};
        const auto& o = hexahedron::corner_uvw[c];
        table[c][6] = hexahedron::corner_at(1 - o[0], 1 - o[1], 1 - o[2]);
    }
    return table;
}
constexpr auto turned_corner = make_turned_corners();

Vector<Lanes> broadcast(const Vec3& p) {
    return {Lanes::Constant(p.x()), Lanes::Constant(p.y()), Lanes::Constant(p.z())};
}

Vec3 corner_of(const std::array<Vector<Lanes>, 8>& corners, std::size_t i, int lane) {
    return {corners[i].x[lane], corners[i].y[lane], corners[i].z[lane]};
}

/// A scaled determinant of three vectors and its gradient. Each vector is known to change by `rate` times the
/// displacement of the vertex.
Term term(const std::array<Vec3, 3>& axis, const std::array<double, 3>& rate) {
    const std::array<Vec3, 3> cross = {axis[1].cross(axis[2]), axis[2].cross(axis[0]),
                                       axis[0].cross(axis[1])};
    const double determinant = axis[0].dot(cross[0]);
    const double root = std::sqrt(axis[0].squaredNorm() * axis[1].squaredNorm() * axis[2].squaredNorm());
    if (!(root > 0.0)) return {0.0, Vec3::Zero()};
    Term result{determinant / root, Vec3::Zero()};
    for (std::size_t i = 0; i < 3; ++i)
        result.gradient += rate[i] * (cross[i] / root - result.value / axis[i].squaredNorm() * axis[i]);
    return result;
}

/// The five numbers of a turned cell that depend on its corner 0.
std::array<Term, 5> moving_terms(const std::array<Vec3, 8>& p) {
    const std::array<double, 3> all = {-1.0, -1.0, -1.0};
    const std::array<double, 3> second = {0.0, 1.0, 0.0};
    const std::array<double, 3> first = {1.0, 0.0, 0.0};
    const std::array<double, 3> third = {0.0, 0.0, 1.0};
    const std::array<Vec3, 3> centre = {(p[1] + p[2] + p[5] + p[6]) - (p[0] + p[3] + p[4] + p[7]),
                                        (p[2] + p[3] + p[6] + p[7]) - (p[0] + p[1] + p[4] + p[5]),
                                        (p[4] + p[5] + p[6] + p[7]) - (p[0] + p[1] + p[2] + p[3])};
    return {term({p[1] - p[0], p[3] - p[0], p[4] - p[0]}, all),
            term({p[2] - p[1], p[0] - p[1], p[5] - p[1]}, second),
            term({p[0] - p[3], p[2] - p[3], p[7] - p[3]}, first),
            term({p[7] - p[4], p[5] - p[4], p[0] - p[4]}, third), term(centre, all)};
}

/// Volume of the trilinear hexahedron, the integral of its Jacobian determinant, by three determinants
/// (J. Grandy, Efficient computation of volume of hexahedral cells, UCRL-ID-128886, 1997).
Lanes volume(const std::array<Vector<Lanes>, 8>& p) {
    const auto from = [&](std::size_t a, std::size_t b) { return difference<Lanes>(p[b], p[a]); };
    const auto sum = [](const Vector<Lanes>& a, const Vector<Lanes>& b) {
        return Vector<Lanes>{a.x + b.x, a.y + b.y, a.z + b.z};
    };
    const Lanes twelvefold =
        quality::determinant<Lanes>(sum(from(1, 3), from(2, 7)), from(3, 6), from(0, 2)) +
        quality::determinant<Lanes>(sum(from(3, 4), from(7, 5)), from(4, 6), from(0, 7)) +
        quality::determinant<Lanes>(sum(from(4, 1), from(5, 2)), from(1, 6), from(0, 5));
    return twelvefold / 12.0;
}

/// The point nearest to the origin of the convex hull of some vectors, by Gilbert's algorithm: where it is
/// not zero, it is the direction along which the smallest of the functions with these gradients rises
/// fastest.
Vec3 nearest_of_hull(const std::vector<Vec3>& vectors) {
    Vec3 point = vectors.front();
    for (int i = 0; i < 60; ++i) {
        const auto lowest =
            std::min_element(vectors.begin(), vectors.end(),
                             [&](const Vec3& a, const Vec3& b) { return a.dot(point) < b.dot(point); });
        const Vec3 step = *lowest - point;
        const double gain = -step.dot(point);
        if (!(gain > 1e-6 * point.squaredNorm())) break;
        point += std::min(1.0, gain / step.squaredNorm()) * step;
    }
    return point;
}

}  // namespace

CompressedRows<StarCell> vertex_stars(const HexMesh& mesh) {
    return rows_by_counting<StarCell>(mesh.vertex_count(), [&](const auto& emit) {
        for (std::uint32_t c = 0; c < mesh.cell_count(); ++c) {
            const HexCell& cell = mesh.cell_array()[c];
            for (std::uint32_t i = 0; i < 8; ++i) emit(cell[i].index(), StarCell{c, i});
        }
    });
}

void Star::gather(const HexMesh& mesh, std::span<const StarCell> cells) {
    cells_ = cells;
    fixed_known_ = false;
    allowed_place_.reset();
    block_count_ = (cells.size() + lane_count - 1) / lane_count;
    if (blocks_.size() < block_count_) blocks_.resize(block_count_);
    for (std::size_t b = 0; b < block_count_; ++b) {
        Block& block = blocks_[b];
        const std::size_t first = b * lane_count;
        block.count = static_cast<int>(std::min<std::size_t>(lane_count, cells.size() - first));
        for (int lane = 0; lane < lane_count; ++lane) {
            // A short block repeats its last cell.
            const StarCell& star_cell =
                cells[first + static_cast<std::size_t>(std::min(lane, block.count - 1))];
            const HexCell& cell = mesh.cell_array()[star_cell.cell];
            const auto& turn = turned_corner[star_cell.corner];
            for (std::size_t i = 0; i < 8; ++i) {
                const Vec3& p = mesh.position(cell[static_cast<std::size_t>(turn[i])]);
                block.corners[i].x[lane] = p.x();
                block.corners[i].y[lane] = p.y();
                block.corners[i].z[lane] = p.z();
            }
        }
    }
}

Star::Lanes Star::moving(const Block& block, const Vector<Lanes>& p) {
    std::array<Vector<Lanes>, 8> c = block.corners;
    c[0] = p;
    const auto edge = [&](std::size_t from, std::size_t to) { return difference<Lanes>(c[to], c[from]); };
    const Vector<Lanes> e01 = edge(0, 1), e03 = edge(0, 3), e04 = edge(0, 4);
    const Lanes l01 = squared_length(e01), l03 = squared_length(e03), l04 = squared_length(e04);
    Lanes smallest = quality::centre_scaled_jacobian(c);
    const auto include = [&](const Lanes& determinant, const Lanes& square) {
        smallest = smallest.min(quality::over_root(determinant, square));
    };
    include(determinant(e01, e03, e04), l01 * l03 * l04);
    // At corner 1 the edge to the vertex is -e01, and so on; the signs cancel in the order of the rows.
    const Vector<Lanes> e12 = edge(1, 2), e15 = edge(1, 5);
    include(determinant(e01, e12, e15), l01 * squared_length(e12) * squared_length(e15));
    const Vector<Lanes> e32 = edge(3, 2), e37 = edge(3, 7);
    include(determinant(e32, e03, e37), l03 * squared_length(e32) * squared_length(e37));
    const Vector<Lanes> e47 = edge(4, 7), e45 = edge(4, 5);
    include(determinant(e45, e47, e04), l04 * squared_length(e45) * squared_length(e47));
    return smallest;
}

void Star::compute_fixed() const {
    if (fixed_known_) return;
    fixed_.resize(std::max(fixed_.size(), block_count_));
    for (std::size_t b = 0; b < block_count_; ++b) {
        const auto& c = blocks_[b].corners;
        Lanes smallest = Lanes::Ones();
        for (const std::size_t corner : {2, 5, 6, 7}) {
            const auto& n = hexahedron::corner_neighbours[corner];
            const auto edge = [&](std::size_t i) {
                return difference<Lanes>(c[static_cast<std::size_t>(n[i])], c[corner]);
            };
            smallest = smallest.min(quality::scaled_determinant<Lanes>(edge(0), edge(1), edge(2)));
        }
        fixed_[b] = smallest;
    }
    fixed_known_ = true;
}

bool Star::allows(const Vec3& here, const Vec3& there, double minimum) const {
    const Vector<Lanes> point = broadcast(there);
    allowed_place_.reset();
    allowed_.resize(std::max(allowed_.size(), block_count_));
    for (std::size_t b = 0; b < block_count_; ++b) {
        allowed_[b] = moving(blocks_[b], point);
        if (!(allowed_[b] >= minimum + rounding).all()) return false;
    }
    allowed_place_ = there;
    return minimum > rounding || quality(there).inverted <= quality(here).inverted;
}

StarQuality Star::quality(const Vec3& p) const {
    compute_fixed();
    const Vector<Lanes> point = broadcast(p);
    StarQuality result;
    for (std::size_t b = 0; b < block_count_; ++b) {
        const Lanes values = moving(blocks_[b], point).min(fixed_[b]);
        result.min = std::min(result.min, values.minCoeff());
        for (int lane = 0; lane < blocks_[b].count; ++lane) result.inverted += values[lane] <= rounding;
    }
    return result;
}

void Star::store(const Vec3& p, std::span<double> values) const {
    compute_fixed();
    const bool known = allowed_place_ && *allowed_place_ == p;
    const Vector<Lanes> point = broadcast(p);
    for (std::size_t b = 0; b < block_count_; ++b) {
        const Lanes smallest = (known ? allowed_[b] : moving(blocks_[b], point)).min(fixed_[b]);
        for (int lane = 0; lane < blocks_[b].count; ++lane)
            values[cells_[b * lane_count + static_cast<std::size_t>(lane)].cell] = smallest[lane];
    }
}

void Star::compute_terms(const Vec3& p) {
    terms_.clear();
    lowest_term_ = 1.0;
    for (std::size_t b = 0; b < block_count_; ++b) {
        for (int lane = 0; lane < blocks_[b].count; ++lane) {
            std::array<Vec3, 8> corners;
            corners[0] = p;
            for (std::size_t i = 1; i < 8; ++i) corners[i] = corner_of(blocks_[b].corners, i, lane);
            for (const Term& t : moving_terms(corners)) {
                terms_.push_back(t);
                lowest_term_ = std::min(lowest_term_, t.value);
            }
        }
    }
}

Vec3 Star::weighted_ascent(double softness) const {
    Vec3 direction = Vec3::Zero();
    for (const Term& t : terms_) {
        const double rise = (t.value - lowest_term_) / softness;
        if (rise < 30.0) direction += std::exp(-rise) * t.gradient;
    }
    return direction;
}

Vec3 Star::steepest_ascent(double range, const std::function<Vec3(const Vec3&)>& allowed) {
    gradients_.clear();
    for (const Term& t : terms_)
        if (t.value <= lowest_term_ + range) gradients_.push_back(allowed(t.gradient));
    return gradients_.empty() ? Vec3(Vec3::Zero()) : nearest_of_hull(gradients_);
}

Vec3 Star::volume_centre(const Vec3& p) const {
    const Vector<Lanes> point = broadcast(p);
    Vec3 weighted = Vec3::Zero();
    Vec3 plain = Vec3::Zero();
    double total = 0.0;
    double total_of_sizes = 0.0;
    for (std::size_t b = 0; b < block_count_; ++b) {
        std::array<Vector<Lanes>, 8> corners = blocks_[b].corners;
        corners[0] = point;
        const Lanes volumes = volume(corners);
        Vector<Lanes> sum = corners[0];
        for (std::size_t i = 1; i < 8; ++i) {
            sum.x += corners[i].x;
            sum.y += corners[i].y;
            sum.z += corners[i].z;
        }
        for (int lane = 0; lane < blocks_[b].count; ++lane) {
            const Vec3 centre = Vec3(sum.x[lane], sum.y[lane], sum.z[lane]) / 8.0;
            weighted += volumes[lane] * centre;
            plain += centre;
            total += volumes[lane];
            total_of_sizes += std::abs(volumes[lane]);
        }
    }
    // The paper's code compares the sum with an absolute 1e-6; a share of the sizes does not depend on units.
    if (total <= 1e-6 * total_of_sizes) return plain / static_cast<double>(size());
    return weighted / total;
}

}  // namespace hex::improving
