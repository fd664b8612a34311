/// \file descent.h
/// L-BFGS for smooth functions of many points, without constraints.
/// Source: Nocedal, Wright: Numerical Optimization, 2006, algorithms 7.4 and 7.5.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <deque>

namespace spline {

struct DescentOptions {
    int most_steps = 60;
    double first_step = 0.1;       ///< length of the largest component's first move
    double least_decrease = 1e-6;  ///< stops when ten steps gain less than this share
};

/// Minimises `function(x, gradient)`, which returns the value (infinity where x is not allowed) and fills the
/// gradient. `x` is the best point found. `stop()` may end it early. Returns the value.
template <class Function, class Stop>
double minimize(const Function& function, Eigen::VectorXd& x, const DescentOptions& options,
                const Stop& stop) {
    constexpr std::size_t memory = 12;
    struct Pair {
        Eigen::VectorXd s, y;
        double scale;
    };
    std::deque<Pair> pairs;
    Eigen::VectorXd gradient(x.size()), trial_gradient(x.size()), trial(x.size());
    double value = function(x, gradient);
    double earlier = value;
    for (int step = 0; step < options.most_steps && value > 0.0 && !stop(); ++step) {
        Eigen::VectorXd direction = gradient;
        std::array<double, memory> alpha{};
        for (std::size_t i = pairs.size(); i-- > 0;) {
            alpha[i] = pairs[i].scale * pairs[i].s.dot(direction);
            direction -= alpha[i] * pairs[i].y;
        }
        if (!pairs.empty()) {
            direction /= pairs.back().scale * pairs.back().y.squaredNorm();
        } else {
            const double largest = direction.cwiseAbs().maxCoeff();
            if (!(largest > 0.0)) break;
            direction *= options.first_step / largest;
        }
        for (std::size_t i = 0; i < pairs.size(); ++i)
            direction += (alpha[i] - pairs[i].scale * pairs[i].y.dot(direction)) * pairs[i].s;
        double slope = -gradient.dot(direction);
        if (!(slope < 0.0)) {
            if (pairs.empty()) break;
            pairs.clear();
            continue;
        }
        double length = 1.0, trial_value = 0.0;
        bool found = false;
        for (int attempt = 0; attempt < 25 && !found; ++attempt) {
            trial = x - length * direction;
            trial_value = function(trial, trial_gradient);
            found = trial_value <= value + 1e-4 * length * slope;
            if (found) break;
            // The minimum of the parabola through what is known, kept within sane bounds.
            const double curve = trial_value - value - length * slope;
            const double guess =
                std::isfinite(curve) && curve > 0.0 ? -slope * length * length / (2.0 * curve) : 0.0;
            length = std::min(std::max(guess, 0.1 * length), 0.5 * length);
        }
        if (!found) {
            if (pairs.empty()) break;
            pairs.clear();
            continue;
        }
        Pair pair{trial - x, trial_gradient - gradient, 0.0};
        const double product = pair.s.dot(pair.y);
        if (product > 1e-12 * pair.y.squaredNorm()) {
            pair.scale = 1.0 / product;
            if (pairs.size() == memory) pairs.pop_front();
            pairs.push_back(std::move(pair));
        }
        x.swap(trial);
        gradient.swap(trial_gradient);
        value = trial_value;
        if (step % 10 == 9) {
            if (earlier - value < options.least_decrease * std::abs(earlier)) break;
            earlier = value;
        }
    }
    return value;
}

}  // namespace spline
