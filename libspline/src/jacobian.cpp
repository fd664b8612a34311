#include "tensor_determinant.h"

#include <hex/base/parallel.h>
#include <spline/jacobian.h>

#include <fmt/format.h>

#include <algorithm>

namespace spline {

using hex::Vec3;
namespace hexahedron = hex::hexahedron;

namespace {

/// Part of an element: coefficients there, and where it is in units of 2^-depth.
struct Part {
    std::vector<double> coefficients;
    std::array<std::uint32_t, 3> place{};
    int depth = 0;
};

/// Decides the sign of a polynomial given by n^3 Bernstein coefficients, each wrong by at most `rounding`.
class SignDecision {
  public:
    SignDecision(std::size_t n, double rounding, const JacobianOptions& options)
        : n_(n), rounding_(rounding), options_(options) {}

    ElementJacobian operator()(std::vector<double> coefficients) {
        result_.smallest = coefficients[0];
        find_singular(coefficients);
        result_.lower = 1e300;
        std::vector<Part> stack;
        stack.push_back({std::move(coefficients), {}, 0});
        bool open = false;
        std::size_t parts = 1;
        while (!stack.empty()) {
            Part part = std::move(stack.back());
            stack.pop_back();
            const double least = least_coefficient(part);
            meet_corners(part);
            if (result_.smallest < -rounding_) {
                result_.verdict = JacobianVerdict::negative;
                result_.lower = std::min(result_.lower, least - rounding_);
                for (const Part& rest : stack)
                    result_.lower = std::min(result_.lower, least_coefficient(rest) - rounding_);
                return result_;
            }
            if (least > rounding_) {
                result_.lower = std::min(result_.lower, least - rounding_);
                continue;
            }
            // A corner that is zero within rounding stays so in all of its parts.
            if ((part.depth >= 3 && corner_is_zero(part)) || part.depth >= options_.most_subdivisions ||
                parts + 8 > options_.most_parts) {
                result_.lower = std::min(result_.lower, least - rounding_);
                open = true;
                continue;
            }
            parts += 8;
            divide(part, stack);
        }
        if (result_.singular != 0) result_.lower = std::min(result_.lower, 0.0);
        result_.verdict = open ? JacobianVerdict::undecided : JacobianVerdict::positive;
        return result_;
    }

  private:
    std::size_t index(std::size_t i, std::size_t j, std::size_t k) const { return i + n_ * (j + n_ * k); }
    std::size_t end(int side) const { return side == 0 ? 0 : n_ - 1; }

    /// Edges and corners of the whole element where all coefficients are zero within rounding. An edge is
    /// excused when its coefficients are not negative, so it is zero at such an end, or everywhere, at most.
    void find_singular(const std::vector<double>& c) {
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const auto& at = hexahedron::corner_uvw[corner];
            if (std::abs(c[index(end(at[0]), end(at[1]), end(at[2]))]) <= rounding_)
                result_.singular |= 1U << (12 + corner);
        }
        if (result_.singular == 0) return;
        for (std::size_t e = 0; e < 12; ++e) {
            const auto& a = hexahedron::corner_uvw[static_cast<std::size_t>(hexahedron::edge_corners[e][0])];
            const auto& b = hexahedron::corner_uvw[static_cast<std::size_t>(hexahedron::edge_corners[e][1])];
            double least = 1e300, most = 0.0;
            for (std::size_t s = 0; s < n_; ++s) {
                std::array<std::size_t, 3> at;
                for (std::size_t x = 0; x < 3; ++x) at[x] = a[x] == b[x] ? end(a[x]) : s;
                const double value = c[index(at[0], at[1], at[2])];
                least = std::min(least, value);
                most = std::max(most, std::abs(value));
            }
            if (most <= rounding_) result_.singular |= 1U << e;
            if (least >= -rounding_) excused_edges_ |= 1U << e;
        }
    }

    bool at_end(const Part& part, std::size_t axis, int side) const {
        return side == 0 ? part.place[axis] == 0 : part.place[axis] + 1 == (1U << part.depth);
    }

    /// Whether a coefficient of a part that is zero within rounding lies on an edge where it may be.
    bool excused(const Part& part, const std::array<std::size_t, 3>& at) const {
        const auto on = [&](std::size_t axis, int side) {
            return at[axis] == end(side) && at_end(part, axis, side);
        };
        for (std::size_t e = 0; e < 12; ++e) {
            if ((excused_edges_ >> e & 1U) == 0) continue;
            const auto& a = hexahedron::corner_uvw[static_cast<std::size_t>(hexahedron::edge_corners[e][0])];
            const auto& b = hexahedron::corner_uvw[static_cast<std::size_t>(hexahedron::edge_corners[e][1])];
            bool all = true;
            for (std::size_t x = 0; x < 3; ++x) all = all && (a[x] != b[x] || on(x, a[x]));
            if (all) return true;
        }
        return false;
    }

    double least_coefficient(const Part& part) const {
        if (excused_edges_ == 0) return *std::min_element(part.coefficients.begin(), part.coefficients.end());
        double least = 1e300;
        for (std::size_t k = 0; k < n_; ++k)
            for (std::size_t j = 0; j < n_; ++j)
                for (std::size_t i = 0; i < n_; ++i) {
                    const double c = part.coefficients[index(i, j, k)];
                    if (c < least && (std::abs(c) > rounding_ || !excused(part, {i, j, k}))) least = c;
                }
        return least;
    }

    /// The corners of a part are values.
    void meet_corners(const Part& part) {
        const double size = std::ldexp(1.0, -part.depth);
        for (const auto& corner : hexahedron::corner_uvw) {
            const double value = part.coefficients[index(end(corner[0]), end(corner[1]), end(corner[2]))];
            if (value >= result_.smallest) continue;
            result_.smallest = value;
            for (std::size_t x = 0; x < 3; ++x)
                result_.at[static_cast<Eigen::Index>(x)] = (part.place[x] + corner[x]) * size;
        }
    }

    bool corner_is_zero(const Part& part) const {
        for (const auto& corner : hexahedron::corner_uvw) {
            const std::array<std::size_t, 3> at = {end(corner[0]), end(corner[1]), end(corner[2])};
            if (part.coefficients[index(at[0], at[1], at[2])] <= rounding_ && !excused(part, at)) return true;
        }
        return false;
    }

    /// Both halves along one axis, by de Casteljau.
    std::array<std::vector<double>, 2> halves(const std::vector<double>& c, std::size_t stride) const {
        std::array<std::vector<double>, 2> result = {std::vector<double>(c.size()), c};
        std::vector<double>& upper = result[1];
        std::vector<double>& lower = result[0];
        for (std::size_t start = 0; start < c.size(); ++start) {
            if (start / stride % n_ != 0) continue;
            double* line = upper.data() + start;
            lower[start] = line[0];
            for (std::size_t step = 1; step < n_; ++step) {
                for (std::size_t i = 0; i + step < n_; ++i)
                    line[i * stride] = 0.5 * (line[i * stride] + line[(i + 1) * stride]);
                lower[start + step * stride] = line[0];
            }
        }
        return result;
    }

    void divide(const Part& part, std::vector<Part>& stack) const {
        auto u = halves(part.coefficients, 1);
        for (std::uint32_t i = 0; i < 2; ++i) {
            auto v = halves(u[i], n_);
            for (std::uint32_t j = 0; j < 2; ++j) {
                auto w = halves(v[j], n_ * n_);
                for (std::uint32_t k = 0; k < 2; ++k)
                    stack.push_back({std::move(w[k]),
                                     {2 * part.place[0] + i, 2 * part.place[1] + j, 2 * part.place[2] + k},
                                     part.depth + 1});
            }
        }
    }

    std::size_t n_;
    double rounding_;
    const JacobianOptions& options_;
    ElementJacobian result_;
    std::uint32_t excused_edges_ = 0;  ///< set only where there is a zero corner
};

/// The determinant at the element's centre and corners is met before anything costly is done.
template <int P>
ElementJacobian bound_polynomial(TensorDeterminant<P>& determinant, const JacobianOptions& options) {
    const double rounding = determinant.rounding_bound();
    const double quick = determinant.quick_lower_bound();
    if (quick > rounding) {
        ElementJacobian result;
        result.verdict = JacobianVerdict::positive;
        result.lower = quick - rounding;
        result.smallest = 1e300;
        // Values at the corners, from the derivatives there.
        constexpr std::size_t m = P + 1;
        for (const auto& corner : hexahedron::corner_uvw) {
            Eigen::Matrix3d jacobian;
            for (std::size_t a = 0; a < 3; ++a) {
                std::array<std::size_t, 3> size = {m, m, m}, at{};
                size[a] = P;
                for (std::size_t x = 0; x < 3; ++x) at[x] = corner[x] == 0 ? 0 : size[x] - 1;
                jacobian.col(static_cast<Eigen::Index>(a)) =
                    determinant.derivative(a, at[0] + size[0] * (at[1] + size[1] * at[2]));
            }
            const double value = jacobian.determinant();
            if (value >= result.smallest) continue;
            result.smallest = value;
            result.at = Vec3(corner[0], corner[1], corner[2]);
        }
        return result;
    }
    std::vector<double> coefficients(TensorDeterminant<P>::coefficient_count);
    determinant.coefficients(coefficients.data());
    return SignDecision(TensorDeterminant<P>::n, rounding, options)(std::move(coefficients));
}

template <class Bound>
JacobianReport certify_all(std::size_t count, const Bound& bound, const hex::Context& context) {
    JacobianReport report;
    report.elements.resize(count);
    constexpr std::size_t wave = 16384;
    for (std::size_t first = 0; first < count; first += wave) {
        context.check_cancelled();
        context.progress("Jacobians", static_cast<double>(first) / static_cast<double>(count));
        hex::parallel_for(
            std::min(wave, count - first),
            [&](std::size_t i) { report.elements[first + i] = bound(first + i); }, 32);
    }
    report.count();
    return report;
}

}  // namespace

void JacobianReport::count() {
    positive = singular = 0;
    negative.clear();
    undecided.clear();
    lower = 0.0;
    worst = -1;
    for (std::size_t e = 0; e < elements.size(); ++e) {
        const ElementJacobian& element = elements[e];
        const auto id = static_cast<std::int64_t>(e);
        switch (element.verdict) {
            case JacobianVerdict::positive:
                ++positive;
                singular += element.singular != 0;
                break;
            case JacobianVerdict::negative:
                negative.push_back(id);
                break;
            case JacobianVerdict::undecided:
                undecided.push_back(id);
                break;
        }
        if (worst < 0 || element.lower < lower) {
            lower = element.lower;
            worst = id;
        }
    }
}

ElementJacobian bound_jacobian(const std::array<Vec3, 8>& corners, const JacobianOptions& options) {
    std::array<Vec3, 8> points;
    for (std::size_t c = 0; c < 8; ++c) {
        const auto& at = hexahedron::corner_uvw[c];
        points[static_cast<std::size_t>(at[0] + 2 * at[1] + 4 * at[2])] = corners[c];
    }
    TensorDeterminant<1> determinant;
    determinant.set_points(points);
    return bound_polynomial(determinant, options);
}

ElementJacobian bound_jacobian(std::span<const Vec3, 64> points, const JacobianOptions& options) {
    TensorDeterminant<3> determinant;
    determinant.set_points(points);
    return bound_polynomial(determinant, options);
}

ElementJacobian bound_jacobian(std::span<const BezierPoint, 64> points, const JacobianOptions& options) {
    // With X = (W x, W y, W z) and W the weight: det [W W_u W_v W_w; X X_u X_v X_w] = W^4 det(x_u x_v x_w),
    // by Laplace expansion in the minors of the first and the last two columns.
    // Translation changes nothing but keeps the numbers small.
    using Value = TensorShape<4, 4, 4>;
    using Du = TensorShape<3, 4, 4>;
    using Dv = TensorShape<4, 3, 4>;
    using Dw = TensorShape<4, 4, 3>;
    using First = ProductShape<Value, Du>;
    using Last = ProductShape<Dv, Dw>;
    using Result = ProductShape<First, Last>;
    std::array<std::array<double, 64>, 4> value;
    std::array<std::array<double, 48>, 4> du, dv, dw;
    std::array<double, 4> largest{};
    const Vec3 origin = points[0].head<3>();
    for (std::size_t c = 0; c < 4; ++c) {
        auto& h = value[c];
        for (std::size_t p = 0; p < 64; ++p) {
            const auto x = static_cast<Eigen::Index>(c) - 1;
            h[p] = c == 0 ? points[p][3] : points[p][3] * (points[p][x] - origin[x]);
        }
        std::size_t nu = 0, nv = 0, nw = 0;
        for (std::size_t p = 0; p < 64; ++p) {
            if (p % 4 < 3) du[c][nu++] = 3 * (h[p + 1] - h[p]);
            if (p / 4 % 4 < 3) dv[c][nv++] = 3 * (h[p + 4] - h[p]);
            if (p / 16 < 3) dw[c][nw++] = 3 * (h[p + 16] - h[p]);
        }
        const auto square = [](const auto& values) {
            double most = 0.0;
            for (const double x : values) most = std::max(most, x * x);
            return most;
        };
        const std::array<double, 4> squares = {square(h), square(du[c]), square(dv[c]), square(dw[c])};
        for (std::size_t a = 0; a < 4; ++a) largest[a] += squares[a];
        for (std::size_t i = 0; i < 64; ++i) h[i] *= binomials<Value>[i];
        for (std::size_t i = 0; i < 48; ++i) {
            du[c][i] *= binomials<Du>[i];
            dv[c][i] *= binomials<Dv>[i];
            dw[c][i] *= binomials<Dw>[i];
        }
    }
    // Rows of the first minor, of the complementary one, and the sign of the permutation.
    constexpr std::array<std::array<int, 5>, 6> pairs = {{{0, 1, 2, 3, 1},
                                                          {0, 2, 1, 3, -1},
                                                          {0, 3, 1, 2, 1},
                                                          {1, 2, 0, 3, 1},
                                                          {1, 3, 0, 2, -1},
                                                          {2, 3, 0, 1, 1}}};
    std::vector<double> coefficients(Result::count, 0.0);
    for (const auto& [a, b, c, d, sign] : pairs) {
        const auto at = [](int i) { return static_cast<std::size_t>(i); };
        std::array<double, First::count> first{};
        std::array<double, Last::count> last{};
        multiply_add<Value, Du>(1.0, value[at(a)].data(), du[at(b)].data(), first.data());
        multiply_add<Value, Du>(-1.0, value[at(b)].data(), du[at(a)].data(), first.data());
        multiply_add<Dv, Dw>(1.0, dv[at(c)].data(), dw[at(d)].data(), last.data());
        multiply_add<Dv, Dw>(-1.0, dv[at(d)].data(), dw[at(c)].data(), last.data());
        multiply_add<First, Last>(sign, first.data(), last.data(), coefficients.data());
    }
    for (std::size_t i = 0; i < Result::count; ++i) coefficients[i] /= binomials<Result>[i];
    const double rounding = 2.3e-16 * 4000.0 * std::sqrt(largest[0] * largest[1] * largest[2] * largest[3]);
    return SignDecision(Result::u, rounding, options)(std::move(coefficients));
}

JacobianReport certify(const BezierSpline& spline, const JacobianOptions& options,
                       const hex::Context& context) {
    return hex::with_threads(context, [&] {
        const std::vector<BezierPoint> points = bezier_points(spline);
        const bool rational = spline.rational();
        return certify_all(
            spline.element_count(),
            [&](std::size_t e) {
                if (rational) {
                    std::array<BezierPoint, 64> element;
                    for (std::size_t p = 0; p < 64; ++p) element[p] = points[spline.elements[e][p]];
                    return bound_jacobian(element, options);
                }
                std::array<Vec3, 64> element;
                for (std::size_t p = 0; p < 64; ++p) element[p] = points[spline.elements[e][p]].head<3>();
                return bound_jacobian(std::span<const Vec3, 64>(element), options);
            },
            context);
    });
}

JacobianReport certify(const hex::HexMesh& mesh, const JacobianOptions& options,
                       const hex::Context& context) {
    return hex::with_threads(context, [&] {
        return certify_all(
            mesh.cell_count(),
            [&](std::size_t c) { return bound_jacobian(mesh.corner_positions(hex::CellId(c)), options); },
            context);
    });
}

std::string describe_negative(const JacobianReport& report, std::size_t most) {
    std::string text;
    for (std::size_t i = 0; i < std::min(most, report.negative.size()); ++i) {
        const std::int64_t e = report.negative[i];
        const ElementJacobian& element = report.elements[static_cast<std::size_t>(e)];
        if (i > 0) text += ", ";
        text += fmt::format("element {} at ({:g}, {:g}, {:g}): {:.3g}", e, element.at[0], element.at[1],
                            element.at[2], element.smallest);
    }
    if (report.negative.size() > most) text += ", ...";
    return text;
}

}  // namespace spline
