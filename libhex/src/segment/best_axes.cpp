#include "segment/best_axes.h"

#include <numbers>

namespace hex {
namespace {

/// How well the turned normals agree with the axes: a third at worst for even normals, 1 at best.
double agreement(const Eigen::Matrix3d& rotation, const std::vector<Vec3>& normals,
                 const std::vector<double>& areas) {
    double sum = 0.0;
    for (std::size_t t = 0; t < normals.size(); ++t)
        sum += areas[t] * (rotation * normals[t]).array().square().square().sum();
    return sum;
}

/// Turns about the coordinate axes by smaller and smaller angles while that helps.
double climb(Eigen::Matrix3d& rotation, double angle, const std::vector<Vec3>& normals,
             const std::vector<double>& areas) {
    constexpr double least_angle = 1e-4;
    double best = agreement(rotation, normals, areas);
    while (angle > least_angle) {
        bool turned = false;
        for (int axis = 0; axis < 3; ++axis) {
            for (const double sign : {1.0, -1.0}) {
                const Eigen::Matrix3d next =
                    Eigen::AngleAxisd(sign * angle, Vec3::Unit(axis)).toRotationMatrix() * rotation;
                const double value = agreement(next, normals, areas);
                if (!(value > best + 1e-12)) continue;
                best = value;
                rotation = next;
                turned = true;
            }
        }
        if (!turned) angle /= 2;
    }
    return best;
}

}  // namespace

Eigen::Matrix3d best_axes(const std::vector<Vec3>& normals, const std::vector<double>& areas) {
    constexpr double least_gain = 1e-3;
    constexpr double step = std::numbers::pi / 8;
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    double best = agreement(identity, normals, areas) + least_gain;
    Eigen::Matrix3d found = identity;
    // The agreement has the symmetry of a cube: a quarter turn about each axis covers all rotations.
    Eigen::Matrix3d start = identity;
    double best_start = -1.0;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            for (int k = 0; k < 4; ++k) {
                const Eigen::Matrix3d r =
                    (Eigen::AngleAxisd(i * step, Vec3::UnitX()) * Eigen::AngleAxisd(j * step, Vec3::UnitY()) *
                     Eigen::AngleAxisd(k * step, Vec3::UnitZ()))
                        .toRotationMatrix();
                const double value = agreement(r, normals, areas);
                if (value > best_start + 1e-12) {
                    best_start = value;
                    start = r;
                }
            }
        }
    }
    for (Eigen::Matrix3d r : {identity, start}) {
        const double value = climb(r, step / 2, normals, areas);
        if (value <= best + 1e-12) continue;
        best = value;
        found = r;
    }
    return found;
}

}  // namespace hex
