#include "boundary_samples.h"
#include "descent.h"
#include "jacobian_penalty.h"
#include "spline_rows.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/surface/closest_point.h>
#include <spline/fit.h>
#include <spline/repair.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace spline {

using hex::Vec3;

namespace {

constexpr int samples_a_side = 5;

/// Vertices and triangle centres.
std::vector<Vec3> surface_samples(const hex::TriangleMesh& surface) {
    std::vector<Vec3> points;
    for (const auto v : surface.vertices())
        if (!surface.is_isolated(v)) points.push_back(hex::to_eigen(surface.point(v)));
    for (const auto f : surface.faces()) {
        Vec3 sum = Vec3::Zero();
        for (const auto v : surface.fv_range(f)) sum += hex::to_eigen(surface.point(v));
        points.push_back(sum / 3.0);
    }
    constexpr std::size_t most = 60000;
    if (points.size() <= most) return points;
    std::vector<Vec3> some;
    for (std::size_t i = 0; i < most; ++i) some.push_back(points[i * points.size() / most]);
    return some;
}

std::vector<Vec3> combine_all(const SparseRows& rows, std::span<const Vec3> positions) {
    std::vector<Vec3> points(rows.size());
    hex::parallel_for(points.size(), [&](std::size_t i) { points[i] = combine(rows[i], positions); });
    return points;
}

/// A sum of squares |weight (row . x - target)|^2 along a direction more than across it.
struct Pull {
    SparseRow row;
    Vec3 target;
    Vec3 normal;  ///< unit; zero: all directions alike
    double weight;
};

/// Control points by their elements' edges: the differences of their moves that fairness keeps small.
SparseRows edge_differences(const BezierSpline& spline) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const auto& element : spline.elements) {
        for (const auto& [a, b] : hex::hexahedron::edge_corners) {
            std::array<std::uint32_t, 2> edge = {
                element[static_cast<std::size_t>(
                    hex::hexahedron::bezier_corner[static_cast<std::size_t>(a)])],
                element[static_cast<std::size_t>(
                    hex::hexahedron::bezier_corner[static_cast<std::size_t>(b)])]};
            if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
            edges.push_back(edge);
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return build_rows<RealRowSum>(edges.size(), [&](std::size_t i, RealRowSum& sum) {
        for (std::size_t end = 0; end < 2; ++end) {
            const SparseRow row = spline.rows[edges[i][end]];
            for (std::size_t k = 0; k < row.size(); ++k)
                sum.add(row.columns[k], end == 0 ? row.values[k] : -row.values[k]);
        }
    });
}

class Fit {
  public:
    Fit(BezierSpline& spline, JacobianReport& verdict, const hex::TriangleMesh& surface,
        const FitOptions& options, const hex::Context& context)
        : spline_(spline),
          verdict_(verdict),
          options_(options),
          context_(context),
          surface_(surface),
          samples_(surface_samples(surface)),
          faces_(boundary_faces(spline)),
          grid_(boundary_grid(faces_.size(), samples_a_side)),
          grid_rows_(boundary_rows(spline, faces_, grid_)),
          original_(spline.control_points) {
        for (const ElementJacobian& element : verdict.elements)
            proved_before_.push_back(element.verdict == JacobianVerdict::positive);
    }

    FitReport run() {
        FitReport report;
        report.before = measure();
        const std::vector<char> on_boundary = boundary_functions(spline_);
        std::vector<char> inside(on_boundary.size());
        for (std::size_t f = 0; f < inside.size(); ++f) inside[f] = on_boundary[f] == 0;
        const SparseRows differences = edge_differences(spline_);
        for (int round = 0; round < options_.rounds; ++round) {
            context_.check_cancelled();
            context_.progress("fitting", static_cast<double>(round) / options_.rounds);
            // Stiff at first, so that the shape moves as a whole.
            const double stiffness = options_.fairness * (1.0 + 1000.0 * std::pow(0.3, round));
            move(on_boundary, true, differences, stiffness, 30, false);
        }
        move(inside, false, differences, 1.0, 80, false);
        bool held = keep_positive(original_);
        // What had to be held back is tried again together with the inside, under the penalty on folds.
        const std::vector<char> all(on_boundary.size(), 1);
        for (int attempt = 0; attempt < 3 && held; ++attempt) {
            context_.check_cancelled();
            context_.progress("fitting without folds", attempt / 3.0);
            const std::vector<Vec3> valid = spline_.control_points;
            move(all, true, differences, options_.fairness, 60, true);
            keep_positive(valid);
        }
        for (std::size_t e = 0; e < proved_before_.size(); ++e) {
            if (proved_before_[e] != 0 && verdict_.elements[e].verdict != JacobianVerdict::positive)
                report.folded.push_back(static_cast<std::int64_t>(e));
        }
        report.after = measure();
        report.held_back = held_back_;
        for (std::size_t f = 0; f < original_.size(); ++f) {
            const double length = (spline_.control_points[f] - original_[f]).norm();
            report.moved += length > 0.0;
            report.largest_move = std::max(report.largest_move, length);
        }
        return report;
    }

    FitDistance measure() const {
        FitDistance distance;
        const std::vector<Vec3> points = combine_all(grid_rows_, spline_.control_points);
        const auto summarize = [](const std::vector<double>& squares, double& rms, double& most) {
            double sum = 0.0;
            for (const double s : squares) {
                sum += s;
                most = std::max(most, s);
            }
            rms = std::sqrt(sum / static_cast<double>(squares.size()));
            most = std::sqrt(most);
        };
        std::vector<double> squares(points.size());
        hex::parallel_for(
            points.size(),
            [&](std::size_t i) { squares[i] = (surface_(points[i]).point - points[i]).squaredNorm(); }, 64);
        summarize(squares, distance.to_surface_rms, distance.to_surface_max);
        const SampledBoundary boundary(grid_, samples_a_side, points);
        squares.assign(samples_.size(), 0.0);
        hex::parallel_for(
            samples_.size(),
            [&](std::size_t i) {
                Vec3 closest;
                boundary.closest(samples_[i], closest);
                squares[i] = (closest - samples_[i]).squaredNorm();
            },
            64);
        summarize(squares, distance.from_surface_rms, distance.from_surface_max);
        return distance;
    }

  private:
    /// Targets of the boundary's samples on the surface, and places of the boundary for the surface's
    /// samples.
    std::vector<Pull> find_pulls(SparseRows& reverse_rows) const {
        const std::vector<Vec3> points = combine_all(grid_rows_, spline_.control_points);
        std::vector<Pull> pulls(points.size());
        const double share = 1.0 / static_cast<double>(points.size());
        hex::parallel_for(
            points.size(),
            [&](std::size_t i) {
                const auto answer = surface_(points[i]);
                const auto& [a, b, c] = surface_.triangle(answer.triangle);
                pulls[i] = {grid_rows_[i], answer.point, (b - a).cross(c - a).normalized(), share};
            },
            64);
        const SampledBoundary boundary(grid_, samples_a_side, points);
        std::vector<BoundaryPlace> places(samples_.size());
        hex::parallel_for(
            samples_.size(),
            [&](std::size_t i) {
                Vec3 closest;
                places[i] = boundary.closest(samples_[i], closest);
            },
            64);
        reverse_rows = boundary_rows(spline_, faces_, places);
        const double reverse_share = 0.5 / static_cast<double>(samples_.size());
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const Vec3 across = samples_[i] - combine(reverse_rows[i], spline_.control_points);
            const double length = across.norm();
            pulls.push_back({reverse_rows[i], samples_[i],
                             length > 0.0 ? Vec3(across / length) : Vec3::Zero(), reverse_share});
        }
        return pulls;
    }

    /// Least squares over the flagged control points: pulls (if any), and differences of moves since the
    /// beginning.
    void move(const std::vector<char>& flagged, bool pulled, const SparseRows& differences, double stiffness,
              int steps, bool guarded) {
        SparseRows reverse_rows;
        const std::vector<Pull> pulls = pulled ? find_pulls(reverse_rows) : std::vector<Pull>();
        std::vector<std::int32_t> variable(flagged.size(), -1);
        std::vector<std::uint32_t> functions;
        for (std::size_t f = 0; f < flagged.size(); ++f) {
            if (flagged[f] == 0) continue;
            variable[f] = static_cast<std::int32_t>(functions.size());
            functions.push_back(static_cast<std::uint32_t>(f));
        }
        if (functions.empty()) return;
        std::vector<std::size_t> active;
        for (std::size_t i = 0; i < differences.size(); ++i) {
            const SparseRow row = differences[i];
            if (std::any_of(row.columns.begin(), row.columns.end(),
                            [&](std::uint32_t f) { return flagged[f] != 0; }))
                active.push_back(i);
        }
        const double fair_weight = stiffness / static_cast<double>(std::max<std::size_t>(1, active.size()));
        const double own_weight = 1e-3 * stiffness / static_cast<double>(functions.size());
        std::vector<Vec3> moves(flagged.size()), positions = spline_.control_points;
        for (std::size_t f = 0; f < moves.size(); ++f) moves[f] = positions[f] - original_[f];
        Eigen::VectorXd x(3 * static_cast<Eigen::Index>(functions.size()));
        for (std::size_t i = 0; i < functions.size(); ++i)
            x.segment<3>(3 * static_cast<Eigen::Index>(i)) = moves[functions[i]];
        std::vector<Vec3> gradients(pulls.size() + active.size());
        std::vector<double> values(gradients.size());
        std::optional<JacobianPenalty> penalty;
        double penalty_weight = 0.0;
        std::vector<Vec3> by_position;
        if (guarded) {
            std::vector<std::uint32_t> elements(spline_.element_count());
            std::iota(elements.begin(), elements.end(), 0U);
            penalty.emplace(spline_, std::move(elements), verdict_.elements, 0.01, 0.3);
            for (const Pull& pull : pulls)
                penalty_weight +=
                    100.0 * pull.weight * (combine(pull.row, positions) - pull.target).squaredNorm();
        }
        const auto energy = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
            for (std::size_t i = 0; i < functions.size(); ++i) {
                moves[functions[i]] = at.segment<3>(3 * static_cast<Eigen::Index>(i));
                positions[functions[i]] = original_[functions[i]] + moves[functions[i]];
            }
            hex::parallel_for(gradients.size(), [&](std::size_t i) {
                if (i < pulls.size()) {
                    const Pull& pull = pulls[i];
                    const Vec3 r = combine(pull.row, positions) - pull.target;
                    const double along = pull.normal.dot(r);
                    constexpr double across = 0.1;
                    values[i] = pull.weight * (along * along + across * r.squaredNorm());
                    gradients[i] = 2.0 * pull.weight * (along * pull.normal + across * r);
                } else {
                    const Vec3 r = combine(differences[active[i - pulls.size()]], moves);
                    values[i] = fair_weight * r.squaredNorm();
                    gradients[i] = 2.0 * fair_weight * r;
                }
            });
            gradient = 2.0 * own_weight * at;
            double value = own_weight * at.squaredNorm();
            for (std::size_t i = 0; i < gradients.size(); ++i) {
                value += values[i];
                const SparseRow row = i < pulls.size() ? pulls[i].row : differences[active[i - pulls.size()]];
                for (std::size_t k = 0; k < row.size(); ++k) {
                    const std::int32_t v = variable[row.columns[k]];
                    if (v >= 0) gradient.segment<3>(3 * Eigen::Index{v}) += row.values[k] * gradients[i];
                }
            }
            if (penalty) {
                by_position.assign(functions.size(), Vec3::Zero());
                value += penalty_weight * penalty->evaluate(positions, variable, by_position);
                for (std::size_t i = 0; i < by_position.size(); ++i)
                    gradient.segment<3>(3 * static_cast<Eigen::Index>(i)) += penalty_weight * by_position[i];
            }
            return value;
        };
        DescentOptions descent;
        descent.most_steps = steps;
        descent.first_step = 1e-3 * box().diagonal();
        minimize(energy, x, descent, [&] { return context_.stop.stop_requested(); });
        for (std::size_t i = 0; i < functions.size(); ++i)
            spline_.control_points[functions[i]] =
                original_[functions[i]] + x.segment<3>(3 * static_cast<Eigen::Index>(i));
    }

    hex::BoundingBox box() const {
        hex::BoundingBox bounds;
        for (const Vec3& p : original_) bounds.add(p);
        return bounds;
    }

    /// Elements that were proved positive stay so: what folded is mended from inside, then moves are taken
    /// back where that is not enough, more and more.
    /// Whether something was taken back or moved to mend.
    bool keep_positive(const std::vector<Vec3>& valid) {
        const auto lost = [&] {
            std::vector<std::size_t> elements;
            for (std::size_t e = 0; e < proved_before_.size(); ++e) {
                if (proved_before_[e] != 0 && verdict_.elements[e].verdict != JacobianVerdict::positive)
                    elements.push_back(e);
            }
            return elements;
        };
        verdict_ = certify(spline_, options_.jacobian, context_);
        RepairOptions repair;
        repair.jacobian = options_.jacobian;
        repair.max_deviation = 0.1;
        if (lost().empty()) return false;
        repair_jacobian(spline_, verdict_, repair, context_);
        std::vector<double> kept(original_.size(), 1.0);
        const std::vector<Vec3> fitted = spline_.control_points;
        for (int attempt = 0; attempt < 20; ++attempt) {
            const std::vector<std::size_t> elements = lost();
            if (elements.empty()) break;
            std::vector<char> held(original_.size(), 0);
            for (const std::size_t e : elements)
                for (const std::uint32_t p : spline_.elements[e])
                    for (const std::uint32_t f : spline_.rows[p].columns) held[f] = 1;
            for (std::size_t f = 0; f < held.size(); ++f) {
                if (held[f] == 0 && attempt < 15) continue;
                kept[f] = attempt < 8 ? 0.6 * kept[f] : attempt < 19 ? 0.1 * kept[f] : 0.0;
                spline_.control_points[f] =
                    kept[f] == 0.0 ? valid[f] : Vec3(valid[f] + kept[f] * (fitted[f] - valid[f]));
            }
            verdict_ = certify(spline_, options_.jacobian, context_);
        }
        held_back_ = static_cast<std::size_t>(
            std::count_if(kept.begin(), kept.end(), [](double share) { return share < 1.0; }));
        return true;
    }

    BezierSpline& spline_;
    JacobianReport& verdict_;
    const FitOptions& options_;
    const hex::Context& context_;
    const hex::ClosestPoint surface_;
    const std::vector<Vec3> samples_;
    const std::vector<BoundaryFace> faces_;
    const std::vector<BoundaryPlace> grid_;
    const SparseRows grid_rows_;
    const std::vector<Vec3> original_;
    std::vector<char> proved_before_;
    std::size_t held_back_ = 0;  ///< control points, in the last attempt
};

void check(const BezierSpline& spline) {
    if (spline.rational())
        throw hex::Error(hex::ErrorKind::unsupported, "rational splines cannot be fitted to a surface");
    if (boundary_faces(spline).empty())
        throw hex::Error(hex::ErrorKind::unsupported, "the boundary of the spline is not known");
}

}  // namespace

FitReport fit(BezierSpline& spline, JacobianReport& verdict, const hex::TriangleMesh& surface,
              const FitOptions& options, const hex::Context& context) {
    check(spline);
    return hex::with_threads(context, [&] { return Fit(spline, verdict, surface, options, context).run(); });
}

FitDistance fit_distance(const BezierSpline& spline, const hex::TriangleMesh& surface,
                         const hex::Context& context) {
    check(spline);
    return hex::with_threads(context, [&] {
        BezierSpline copy = spline;
        JacobianReport verdict;
        const FitOptions options;
        return Fit(copy, verdict, surface, options, context).measure();
    });
}

}  // namespace spline
