#include "descent.h"
#include "face_points.h"
#include "incidence.h"
#include "jacobian_penalty.h"

#include <hex/base/components.h>
#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <spline/repair.h>

#include <algorithm>

namespace spline {

using hex::Vec3;

namespace {

/// Elements that are mended together, and the control points that may move.
struct Group {
    std::vector<std::uint32_t> bad, elements, functions;
};

/// Control points of the bad elements, and all elements that these move; groups that share an element are
/// one.
std::vector<Group> find_groups(const BezierSpline& spline, const Incidence& incidence,
                               const std::vector<std::int64_t>& bad, const std::vector<char>& may_move) {
    hex::Components components(spline.element_count());
    std::vector<char> variable(spline.function_count(), 0);
    ElementFunctions functions_of;
    for (const std::int64_t e : bad) {
        for (const std::uint32_t f : functions_of(spline, static_cast<std::size_t>(e))) {
            if (may_move[f] == 0) continue;
            variable[f] = 1;
            for (const std::uint32_t other : incidence[f])
                components.join(other, static_cast<std::size_t>(e));
        }
    }
    std::vector<std::int32_t> group_of_root(spline.element_count(), -1);
    std::vector<Group> groups;
    for (const std::int64_t e : bad) {
        const std::uint32_t root = components.root(static_cast<std::size_t>(e));
        if (group_of_root[root] < 0) {
            group_of_root[root] = static_cast<std::int32_t>(groups.size());
            groups.emplace_back();
        }
        groups[static_cast<std::size_t>(group_of_root[root])].bad.push_back(static_cast<std::uint32_t>(e));
    }
    for (std::uint32_t e = 0; e < components.size(); ++e) {
        const std::int32_t g = group_of_root[components.root(e)];
        if (g >= 0) groups[static_cast<std::size_t>(g)].elements.push_back(e);
    }
    for (std::uint32_t f = 0; f < variable.size(); ++f) {
        if (variable[f] == 0) continue;
        const std::int32_t g = group_of_root[components.root(incidence[f].front())];
        groups[static_cast<std::size_t>(g)].functions.push_back(f);
    }
    return groups;
}

/// Everything that a round changes from one to the next.
struct Freedom {
    bool boundary = false;
    double margin = 0.02;         ///< of the volume, for elements to mend
    double keep = 0.5;            ///< of the least coefficient, for elements that are good
    double cost_of_moves = 1e-4;  ///< of one local length, squared
    double reach = INFINITY;      ///< of what an element fails by: enough when this is less than the margin
};

class Repair {
  public:
    Repair(BezierSpline& spline, JacobianReport& verdict, const RepairOptions& options,
           const hex::Context& context)
        : spline_(spline),
          verdict_(verdict),
          options_(options),
          context_(context),
          original_(spline.control_points),
          on_boundary_(boundary_functions(spline)),
          incidence_(spline) {
        hex::BoundingBox box;
        for (const Vec3& p : original_) box.add(p);
        diagonal_ = box.diagonal();
        find_lengths();
    }

    RepairReport run() {
        RepairReport report;
        report.negative_before = verdict_.negative.size();
        report.undecided_before = verdict_.undecided.size();
        const std::vector<std::int64_t> bad_before = bad_elements();
        for (int round = 0; round < options_.most_rounds; ++round) {
            const std::vector<std::int64_t> bad = bad_elements();
            if (bad.empty()) break;
            context_.check_cancelled();
            context_.progress("mending Jacobians", static_cast<double>(round) / options_.most_rounds);
            Freedom freedom;
            freedom.boundary = options_.max_deviation > 0.0 && round >= 2;
            freedom.cost_of_moves = round == 0 ? 1e-3 : 1e-4 * std::pow(0.5, round);
            freedom.margin = round < 4 ? 0.02 : 0.04;
            freedom.keep = round < 4 ? 0.5 : 0.25;
            if (round >= 6) freedom.reach = round < 8 ? 10.0 : 1000.0;
            std::vector<char> may_move(on_boundary_.size());
            for (std::size_t f = 0; f < may_move.size(); ++f)
                may_move[f] = on_boundary_[f] == 0 || freedom.boundary;
            std::vector<std::int64_t> worked_on = bad;
            if (round >= 4) worked_on = with_neighbours(bad);
            for (const Group& group : find_groups(spline_, incidence_, worked_on, may_move))
                mend(group, freedom);
        }
        finish(report, bad_before);
        return report;
    }

  private:
    std::vector<std::int64_t> bad_elements() const {
        std::vector<std::int64_t> bad = verdict_.negative;
        bad.insert(bad.end(), verdict_.undecided.begin(), verdict_.undecided.end());
        std::sort(bad.begin(), bad.end());
        return bad;
    }

    /// With the elements that share a corner point with them.
    std::vector<std::int64_t> with_neighbours(const std::vector<std::int64_t>& bad) const {
        std::vector<char> touched(spline_.rows.size(), 0);
        for (const std::int64_t e : bad)
            for (const int p : hex::hexahedron::bezier_corner)
                touched[spline_.elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(p)]] = 1;
        std::vector<std::int64_t> all;
        for (std::size_t e = 0; e < spline_.element_count(); ++e) {
            const auto& corners = hex::hexahedron::bezier_corner;
            if (std::any_of(corners.begin(), corners.end(), [&](int p) {
                    return touched[spline_.elements[e][static_cast<std::size_t>(p)]] != 0;
                }))
                all.push_back(static_cast<std::int64_t>(e));
        }
        return all;
    }

    /// The scale of moves of a control point: the least edge of the Bezier elements in which it is used.
    void find_lengths() {
        std::vector<double> of_element(spline_.element_count());
        hex::parallel_for(of_element.size(), [&](std::size_t e) {
            const auto points = element_points(spline_, e, original_);
            double least = 1e300;
            for (const auto& [a, b] : hex::hexahedron::edge_corners) {
                const auto at = [&](int c) {
                    return points[static_cast<std::size_t>(
                        hex::hexahedron::bezier_corner[static_cast<std::size_t>(c)])];
                };
                least = std::min(least, (at(a) - at(b)).norm());
            }
            of_element[e] = std::max(least, 1e-6 * diagonal_);
        });
        lengths_.assign(original_.size(), 0.0);
        for (std::uint32_t f = 0; f < lengths_.size(); ++f) {
            for (const std::uint32_t e : incidence_[f])
                lengths_[f] = lengths_[f] == 0.0 ? of_element[e] : std::min(lengths_[f], of_element[e]);
        }
    }

    /// The position of control point f for coordinates y in units of its length; those of the boundary stay
    /// within the allowed deviation for any y.
    Vec3 place(std::uint32_t f, const Vec3& y) const {
        if (on_boundary_[f] == 0) return original_[f] + lengths_[f] * y;
        const double reach = limit(f);
        return original_[f] + lengths_[f] * reach / std::sqrt(reach * reach + y.squaredNorm()) * y;
    }
    Vec3 coordinates(std::uint32_t f) const {
        const Vec3 move = (spline_.control_points[f] - original_[f]) / lengths_[f];
        if (on_boundary_[f] == 0) return move;
        const double reach = limit(f);
        return move * reach / std::sqrt(std::max(1e-12 * reach * reach, reach * reach - move.squaredNorm()));
    }
    /// The transpose of the derivative of `place`, applied to g.
    Vec3 pull_back(std::uint32_t f, const Vec3& y, const Vec3& g) const {
        if (on_boundary_[f] == 0) return lengths_[f] * g;
        const double reach = limit(f), root = std::sqrt(reach * reach + y.squaredNorm());
        return lengths_[f] * (reach / root * g - reach / (root * root * root) * y.dot(g) * y);
    }
    double limit(std::uint32_t f) const { return 0.01 * options_.max_deviation * diagonal_ / lengths_[f]; }

    void mend(const Group& group, const Freedom& freedom) {
        if (group.functions.empty()) return;
        std::vector<std::int32_t> variable(spline_.function_count(), -1);
        for (std::size_t i = 0; i < group.functions.size(); ++i)
            variable[group.functions[i]] = static_cast<std::int32_t>(i);
        const JacobianPenalty penalty(spline_, group.elements, verdict_.elements, freedom.margin,
                                      freedom.keep, freedom.reach);
        std::vector<Vec3> positions = spline_.control_points;
        const auto count = static_cast<Eigen::Index>(group.functions.size());
        Eigen::VectorXd x(3 * count);
        for (Eigen::Index i = 0; i < count; ++i)
            x.segment<3>(3 * i) = coordinates(group.functions[static_cast<std::size_t>(i)]);
        std::vector<Vec3> by_position(group.functions.size());
        const auto energy = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
            for (Eigen::Index i = 0; i < count; ++i) {
                const std::uint32_t f = group.functions[static_cast<std::size_t>(i)];
                positions[f] = place(f, at.segment<3>(3 * i));
            }
            std::fill(by_position.begin(), by_position.end(), Vec3::Zero());
            double value = penalty.evaluate(positions, variable, by_position);
            for (Eigen::Index i = 0; i < count; ++i) {
                const auto k = static_cast<std::size_t>(i);
                const Vec3 y = at.segment<3>(3 * i);
                gradient.segment<3>(3 * i) =
                    pull_back(group.functions[k], y, by_position[k]) + 2.0 * freedom.cost_of_moves * y;
            }
            return value + freedom.cost_of_moves * at.squaredNorm();
        };
        minimize(energy, x, {}, [&] { return context_.stop.stop_requested(); });
        for (Eigen::Index i = 0; i < count; ++i) {
            const std::uint32_t f = group.functions[static_cast<std::size_t>(i)];
            positions[f] = place(f, x.segment<3>(3 * i));
        }
        judge(group, positions);
    }

    /// Takes the new positions unless more elements would be unproved, or worse as a whole.
    void judge(const Group& group, const std::vector<Vec3>& positions) {
        std::vector<ElementJacobian> after(group.elements.size());
        hex::parallel_for(
            after.size(),
            [&](std::size_t i) {
                const auto points = element_points(spline_, group.elements[i], positions);
                after[i] = bound_jacobian(std::span<const Vec3, 64>(points), options_.jacobian);
            },
            4);
        std::size_t bad_before = 0, bad_after = 0;
        double worst_before = 0.0, worst_after = 0.0;
        for (std::size_t i = 0; i < after.size(); ++i) {
            const ElementJacobian& old = verdict_.elements[group.elements[i]];
            if (old.verdict != JacobianVerdict::positive) ++bad_before, worst_before += old.lower;
            if (after[i].verdict != JacobianVerdict::positive) ++bad_after, worst_after += after[i].lower;
        }
        if (bad_after > bad_before || (bad_after == bad_before && worst_after <= worst_before)) return;
        for (const std::uint32_t f : group.functions) spline_.control_points[f] = positions[f];
        for (std::size_t i = 0; i < after.size(); ++i) verdict_.elements[group.elements[i]] = after[i];
        verdict_.count();
    }

    void finish(RepairReport& report, const std::vector<std::int64_t>& bad_before) const {
        report.negative_after = verdict_.negative.size();
        report.undecided_after = verdict_.undecided.size();
        report.unmended = bad_elements();
        std::set_difference(bad_before.begin(), bad_before.end(), report.unmended.begin(),
                            report.unmended.end(), std::back_inserter(report.mended));
        for (std::size_t f = 0; f < original_.size(); ++f) {
            const double move = (spline_.control_points[f] - original_[f]).norm() / diagonal_ * 100.0;
            if (!(move > 0.0)) continue;
            ++(on_boundary_[f] != 0 ? report.moved_boundary : report.moved_inside);
            double& largest = on_boundary_[f] != 0 ? report.largest_boundary : report.largest_inside;
            largest = std::max(largest, move);
        }
    }

    BezierSpline& spline_;
    JacobianReport& verdict_;
    const RepairOptions& options_;
    const hex::Context& context_;
    const std::vector<Vec3> original_;
    std::vector<char> on_boundary_;
    Incidence incidence_;
    std::vector<double> lengths_;
    double diagonal_ = 0.0;
};

}  // namespace

std::vector<char> boundary_functions(const BezierSpline& spline) {
    std::vector<char> flags(spline.function_count(), 0);
    for (std::size_t e = 0; e < spline.boundary_patch.size(); ++e) {
        for (std::size_t f = 0; f < 6; ++f) {
            if (spline.boundary_patch[e][f] < 0) continue;
            for (const std::size_t p : face_points(f)) {
                for (const std::uint32_t function : spline.rows[spline.elements[e][p]].columns)
                    flags[function] = 1;
            }
        }
    }
    return flags;
}

RepairReport repair_jacobian(BezierSpline& spline, JacobianReport& verdict, const RepairOptions& options,
                             const hex::Context& context) {
    if (!(options.max_deviation >= 0.0))
        throw hex::Error(hex::ErrorKind::usage, "how far the boundary may move must not be negative");
    if (options.most_rounds < 1)
        throw hex::Error(hex::ErrorKind::usage, "the number of rounds of a repair must be at least 1");
    RepairReport report;
    if (verdict.proved() || spline.rational()) {
        report.negative_before = report.negative_after = verdict.negative.size();
        report.undecided_before = report.undecided_after = verdict.undecided.size();
        report.unmended = verdict.negative;
        report.unmended.insert(report.unmended.end(), verdict.undecided.begin(), verdict.undecided.end());
        return report;
    }
    return hex::with_threads(context, [&] { return Repair(spline, verdict, options, context).run(); });
}

}  // namespace spline
