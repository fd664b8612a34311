/// \file inner_points.h
/// Walks over the inner points of faces and blocks with their parameters, for the blends.
#pragma once

#include <hex/map/transfinite.h>

namespace hex {

/// Calls visit(i, j, u, v) with u = i / nu and v = j / nv, both in (0, 1).
template <class Visit>
void for_each_inner_point(const FaceGrid& face, Visit visit) {
    for (int j = 1; j < face.nv(); ++j) {
        const double v = static_cast<double>(j) / face.nv();
        for (int i = 1; i < face.nu(); ++i) visit(i, j, static_cast<double>(i) / face.nu(), v);
    }
}

/// Calls visit(i, j, k, u, v, w).
template <class Visit>
void for_each_inner_point(const BlockGrid& block, Visit visit) {
    for (int k = 1; k < block.nw(); ++k) {
        const double w = static_cast<double>(k) / block.nw();
        for (int j = 1; j < block.nv(); ++j) {
            const double v = static_cast<double>(j) / block.nv();
            for (int i = 1; i < block.nu(); ++i) visit(i, j, k, static_cast<double>(i) / block.nu(), v, w);
        }
    }
}

}  // namespace hex
