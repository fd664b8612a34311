/// \file star_ascent.h
/// The local end of maximising the smallest scaled Jacobian: one vertex after the other.
#pragma once

#include "improve/sliding_descent.h"

namespace hex::improving {

struct AscentOptions {
    int most_sweeps = 30;
    /// Vertices of cells up to this much better than the worst are moved as well.
    double margin = 0.1;
    /// Ends when the minimum is at least this.
    double target = 1.0;
    /// Ends when `patience` sweeps together raised the minimum by less than `gain`.
    double gain = 1e-3;
    int patience = 3;
    /// Asked before every sweep; true ends the ascent.
    std::function<bool()> satisfied;
};

/// Each vertex of a bad cell tries steps along the directions in which its bad cells improve together, along
/// its tangents, and to the kinks of its curve, and takes the place with the best star minimum, if that is
/// better than where it is. By colour classes, so the same for any number of threads. The smallest scaled
/// Jacobian around no vertex falls. Returns the number of sweeps.
int raise_star_minima(SlidingMesh& mesh, const AscentOptions& options, const Context& context);

}  // namespace hex::improving
