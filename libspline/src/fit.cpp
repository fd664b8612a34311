#include "boundary_fit.h"
#include "descent.h"
#include "incidence.h"
#include "jacobian_penalty.h"
#include "spline_rows.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <spline/fit.h>
#include <spline/repair.h>

#include <algorithm>
#include <cmath>

namespace spline {

using hex::Vec3;

namespace {

/// Control points that may move, numbered.
struct Variables {
    std::vector<std::int32_t> number;  ///< of each control point, -1: stays
    std::vector<std::uint32_t> functions;

    explicit Variables(const std::vector<char>& may_move) : number(may_move.size(), -1) {
        for (std::size_t f = 0; f < may_move.size(); ++f) {
            if (may_move[f] == 0) continue;
            number[f] = static_cast<std::int32_t>(functions.size());
            functions.push_back(static_cast<std::uint32_t>(f));
        }
    }
};

class Fit {
  public:
    Fit(BezierSpline& spline, JacobianReport& verdict, const hex::TriangleMesh& surface,
        const FitOptions& options, const hex::Context& context)
        : spline_(spline),
          verdict_(verdict),
          options_(options),
          context_(context),
          boundary_(spline, surface),
          incidence_(spline),
          original_(spline.control_points) {
        for (const ElementJacobian& element : verdict.elements)
            proved_before_.push_back(element.verdict == JacobianVerdict::positive);
    }

    FitReport run() {
        FitReport report;
        report.before = boundary_.measure(spline_.control_points);
        fit_boundary();
        fit_inside();
        keep_positive(report);
        for (std::size_t e = 0; e < proved_before_.size(); ++e) {
            if (proved_before_[e] != 0 && verdict_.elements[e].verdict != JacobianVerdict::positive)
                report.folded.push_back(static_cast<std::int64_t>(e));
        }
        report.after = boundary_.measure(spline_.control_points);
        for (std::size_t f = 0; f < original_.size(); ++f) {
            const double length = (spline_.control_points[f] - original_[f]).norm();
            report.moved += length > 0.0;
            report.largest_move = std::max(report.largest_move, length);
        }
        return report;
    }

  private:
    /// The moves since the beginning, and what the rows make of them: what fairness keeps small.
    void add_fairness(const SparseRows& differences, double stiffness, SquareTerms& terms) const {
        std::vector<Vec3> moves(original_.size());
        for (std::size_t f = 0; f < moves.size(); ++f) moves[f] = spline_.control_points[f] - original_[f];
        const double weight = stiffness / static_cast<double>(std::max<std::size_t>(1, differences.size()));
        append(terms.rows, differences);
        for (std::size_t i = 0; i < differences.size(); ++i) {
            terms.residuals.push_back(combine(differences[i], moves));
            terms.metrics.push_back({Vec3::Zero(), weight, 0.0});
        }
    }

    void move(const Variables& variables, const SquareTerms& terms, double damping, int steps,
              double tolerance) {
        const LeastSquares system(terms.rows, variables.number, variables.functions.size());
        const auto moves = system.solve(terms.residuals, terms.metrics, damping, steps, tolerance);
        for (std::size_t i = 0; i < moves.size(); ++i)
            spline_.control_points[variables.functions[i]] += moves[i];
    }

    void fit_boundary() {
        const Variables variables(boundary_functions(spline_));
        const SparseRows differences = edge_differences(spline_, true);
        for (int round = 0; round < options_.rounds; ++round) {
            context_.check_cancelled();
            context_.progress("fitting", static_cast<double>(round) / options_.rounds);
            // Stiff at first, so that the shape moves as a whole.
            const double stiffness = options_.fairness * (1.0 + 1000.0 * std::pow(0.2, round));
            SquareTerms terms = boundary_.pulls(spline_.control_points, 1.0);
            add_fairness(differences, stiffness, terms);
            move(variables, terms, 1e-3 * stiffness / static_cast<double>(variables.functions.size()), 60,
                 1e-3);
        }
    }

    void fit_inside() {
        std::vector<char> inside = boundary_functions(spline_);
        for (char& flag : inside) flag = flag == 0;
        SquareTerms terms;
        add_fairness(edge_differences(spline_, false), 1.0, terms);
        move(Variables(inside), terms, 0.0, 300, 1e-4);
    }

    std::vector<char> lost_flags() const {
        std::vector<char> flags(proved_before_.size(), 0);
        for (const std::size_t e : lost()) flags[e] = 1;
        return flags;
    }
    std::vector<std::size_t> lost() const {
        std::vector<std::size_t> elements;
        for (std::size_t e = 0; e < proved_before_.size(); ++e) {
            if (proved_before_[e] != 0 && verdict_.elements[e].verdict != JacobianVerdict::positive)
                elements.push_back(e);
        }
        return elements;
    }

    /// Elements that were proved positive stay so. What folded is fitted again with a penalty on folds; then
    /// mended from inside; then moves are taken back where that is not enough, more and more.
    void keep_positive(FitReport& report) {
        verdict_ = certify(spline_, options_.jacobian, context_);
        std::vector<char> in_danger(proved_before_.size(), 0);
        for (int attempt = 0; attempt < 4 && !lost().empty(); ++attempt) {
            context_.check_cancelled();
            context_.progress("fitting without folds", attempt / 4.0);
            for (const std::size_t e : lost()) in_danger[e] = 1;
            fit_without_folds(variables_of(lost_flags()), std::pow(10.0, 1 + attempt));
        }
        if (lost().empty()) return polish(in_danger);
        RepairOptions repair;
        repair.jacobian = options_.jacobian;
        repair.max_deviation = 0.1;
        repair_jacobian(spline_, verdict_, repair, context_);
        report.held_back = take_back(original_);
    }

    Variables variables_of(const std::vector<char>& elements) const {
        std::vector<char> may_move(original_.size(), 0);
        ElementFunctions functions_of;
        for (std::size_t e = 0; e < elements.size(); ++e) {
            if (elements[e] == 0) continue;
            for (const std::uint32_t f : functions_of(spline_, e)) may_move[f] = 1;
        }
        return Variables(may_move);
    }

    /// Again where elements had been lost, as long as that brings the boundary nearer and none is lost.
    void polish(const std::vector<char>& elements) {
        const Variables variables = variables_of(elements);
        if (variables.functions.empty()) return;
        double best = boundary_.measure(spline_.control_points).to_surface_rms;
        for (int attempt = 0; attempt < 3; ++attempt) {
            context_.check_cancelled();
            const std::vector<Vec3> before = spline_.control_points;
            const JacobianReport verdict_before = verdict_;
            fit_without_folds(variables, 100.0);
            for (int mend = 0; mend < 3 && !lost().empty(); ++mend)
                fit_without_folds(variables_of(lost_flags()), std::pow(10.0, 3 + mend));
            const double distance = boundary_.measure(spline_.control_points).to_surface_rms;
            if (!lost().empty() || distance >= best) {
                spline_.control_points = before;
                verdict_ = verdict_before;
                return;
            }
            if (distance > 0.98 * best) return;
            best = distance;
        }
    }

    /// The given control points, towards the part and away from folds.
    void fit_without_folds(const Variables& variables, double weight_of_folds) {
        std::vector<std::uint32_t> elements;
        for (const std::uint32_t f : variables.functions)
            elements.insert(elements.end(), incidence_[f].begin(), incidence_[f].end());
        std::sort(elements.begin(), elements.end());
        elements.erase(std::unique(elements.begin(), elements.end()), elements.end());

        SquareTerms terms = boundary_.pulls(spline_.control_points, 1.0);
        double weight = 0.0;
        for (std::size_t i = 0; i < terms.residuals.size(); ++i)
            weight += weight_of_folds * terms.residuals[i].dot(terms.metrics[i](terms.residuals[i]));
        add_fairness(edge_differences(spline_, false), options_.fairness, terms);
        const LeastSquares system(terms.rows, variables.number, variables.functions.size());
        const JacobianPenalty penalty(spline_, elements, verdict_.elements, 0.01, 0.3);
        std::vector<Vec3> positions = spline_.control_points, moves(variables.functions.size());
        std::vector<Vec3> by_move(moves.size()), by_position(moves.size());
        const auto place = [&](const Eigen::VectorXd& at) {
            for (std::size_t i = 0; i < moves.size(); ++i) {
                moves[i] = at.segment<3>(3 * static_cast<Eigen::Index>(i));
                positions[variables.functions[i]] = spline_.control_points[variables.functions[i]] + moves[i];
            }
        };
        const auto energy = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
            place(at);
            double value = system.evaluate(terms.residuals, terms.metrics, 0.0, moves, by_move);
            std::fill(by_position.begin(), by_position.end(), Vec3::Zero());
            value += weight * penalty.evaluate(positions, variables.number, by_position);
            for (std::size_t i = 0; i < moves.size(); ++i)
                gradient.segment<3>(3 * static_cast<Eigen::Index>(i)) =
                    2.0 * by_move[i] + weight * by_position[i];
            return value;
        };
        hex::BoundingBox box;
        for (const Vec3& p : original_) box.add(p);
        DescentOptions descent;
        descent.most_steps = 80;
        descent.first_step = 1e-3 * box.diagonal();
        Eigen::VectorXd x = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(moves.size()));
        minimize(energy, x, descent, [&] { return context_.stop.stop_requested(); });
        place(x);
        spline_.control_points = positions;
        judge(elements);
    }

    void judge(const std::vector<std::uint32_t>& elements) {
        hex::parallel_for(
            elements.size(),
            [&](std::size_t i) {
                const auto points = element_points(spline_, elements[i], spline_.control_points);
                verdict_.elements[elements[i]] =
                    bound_jacobian(std::span<const Vec3, 64>(points), options_.jacobian);
            },
            4);
        verdict_.count();
    }

    /// Returns how many control points were brought nearer to `valid`.
    std::size_t take_back(const std::vector<Vec3>& valid) {
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
        return static_cast<std::size_t>(
            std::count_if(kept.begin(), kept.end(), [](double share) { return share < 1.0; }));
    }

    BezierSpline& spline_;
    JacobianReport& verdict_;
    const FitOptions& options_;
    const hex::Context& context_;
    BoundaryFit boundary_;
    const Incidence incidence_;
    const std::vector<Vec3> original_;
    std::vector<char> proved_before_;
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
    if (options.rounds < 1)
        throw hex::Error(hex::ErrorKind::usage, "the number of rounds of a fit must be at least 1");
    if (!(options.fairness > 0.0))
        throw hex::Error(hex::ErrorKind::usage, "the weight of fairness must be positive");
    return hex::with_threads(context, [&] { return Fit(spline, verdict, surface, options, context).run(); });
}

std::vector<double> fit_errors(const BezierSpline& spline, const hex::TriangleMesh& surface,
                               const hex::Context& context) {
    check(spline);
    return hex::with_threads(
        context, [&] { return BoundaryFit(spline, surface).errors_of_elements(spline.control_points); });
}

FitDistance fit_distance(const BezierSpline& spline, const hex::TriangleMesh& surface,
                         const hex::Context& context) {
    check(spline);
    return hex::with_threads(context,
                             [&] { return BoundaryFit(spline, surface).measure(spline.control_points); });
}

}  // namespace spline
