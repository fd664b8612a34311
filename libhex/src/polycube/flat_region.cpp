#include "polycube/flat_region.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <algorithm>
#include <array>
#include <cmath>

namespace hex {
namespace {

using Point2 = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
using Matrix = Eigen::SparseMatrix<double>;

enum class Weights { cotangent, mean_value, uniform };

class Flattener {
  public:
    Flattener(const TriangleMesh& mesh, const std::vector<TriangleMesh::FaceHandle>& faces,
              const std::vector<char>& fixed)
        : mesh_(mesh), row_(mesh.n_vertices(), -2) {
        for (const auto f : faces) {
            auto& t = triangles_.emplace_back();
            std::size_t k = 0;
            for (const auto v : mesh.fv_range(f)) {
                t[k++] = v.idx();
                int& row = row_[static_cast<std::size_t>(v.idx())];
                if (row == -2) row = fixed[static_cast<std::size_t>(v.idx())] ? -1 : unknowns_++;
            }
        }
    }

    bool solve(Weights weights, std::vector<Vec2>& uv) const {
        Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(unknowns_, 2);
        std::vector<Eigen::Triplet<double>> entries;
        const auto add = [&](int i, int j, double w) {
            const int row = row_[static_cast<std::size_t>(i)];
            if (row < 0) return;
            entries.emplace_back(row, row, w);
            const int column = row_[static_cast<std::size_t>(j)];
            if (column >= 0)
                entries.emplace_back(row, column, -w);
            else
                right.row(row) += w * uv[static_cast<std::size_t>(j)].transpose();
        };
        for (const auto& t : triangles_) {
            std::array<Vec3, 3> p;
            for (std::size_t k = 0; k < 3; ++k)
                p[k] = to_eigen(mesh_.point(TriangleMesh::VertexHandle(t[k])));
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t i = k, j = (k + 1) % 3, o = (k + 2) % 3;
                if (weights == Weights::uniform) {
                    add(t[i], t[j], 1.0);
                    add(t[j], t[i], 1.0);
                } else if (weights == Weights::cotangent) {
                    const Vec3 a = p[i] - p[o];
                    const Vec3 b = p[j] - p[o];
                    const double w = a.dot(b) / std::max(a.cross(b).norm(), 1e-300);
                    add(t[i], t[j], w);
                    add(t[j], t[i], w);
                } else {
                    // tan(angle / 2) at vertex i, for its two edges in this triangle.
                    const Vec3 a = p[j] - p[i];
                    const Vec3 b = p[o] - p[i];
                    const double la = std::max(a.norm(), 1e-300);
                    const double lb = std::max(b.norm(), 1e-300);
                    const double half = a.cross(b).norm() / (la * lb + a.dot(b));
                    const double bounded = std::isfinite(half) ? std::clamp(half, 1e-9, 1e9) : 1e9;
                    add(t[i], t[j], bounded / la);
                    add(t[i], t[o], bounded / lb);
                }
            }
        }
        if (unknowns_ > 0) {
            Matrix matrix(unknowns_, unknowns_);
            matrix.setFromTriplets(entries.begin(), entries.end());
            Eigen::MatrixX2d x;
            if (weights == Weights::mean_value) {
                Eigen::SparseLU<Matrix> solver(matrix);
                if (solver.info() != Eigen::Success) return false;
                x = solver.solve(right);
            } else {
                Eigen::SimplicialLDLT<Matrix> solver(matrix);
                if (solver.info() != Eigen::Success) return false;
                x = solver.solve(right);
            }
            if (!x.allFinite()) return false;
            for (std::size_t v = 0; v < row_.size(); ++v)
                if (row_[v] >= 0) uv[v] = x.row(row_[v]).transpose();
        }
        return std::all_of(triangles_.begin(), triangles_.end(), [&](const auto& t) {
            return counter_clockwise(uv[static_cast<std::size_t>(t[0])], uv[static_cast<std::size_t>(t[1])],
                                     uv[static_cast<std::size_t>(t[2])]);
        });
    }

  private:
    const TriangleMesh& mesh_;
    std::vector<std::array<int, 3>> triangles_;
    std::vector<int> row_;  ///< -2: not in the region, -1: fixed
    int unknowns_ = 0;
};

}  // namespace

bool flatten_region(const TriangleMesh& mesh, const std::vector<TriangleMesh::FaceHandle>& faces,
                    const std::vector<char>& fixed, std::vector<Vec2>& uv) {
    const Flattener flattener(mesh, faces, fixed);
    return flattener.solve(Weights::cotangent, uv) || flattener.solve(Weights::mean_value, uv) ||
           flattener.solve(Weights::uniform, uv);
}

bool counter_clockwise(const Vec2& a, const Vec2& b, const Vec2& c) {
    return side_of_line(a, b, c) > 0;
}

int side_of_line(const Vec2& a, const Vec2& b, const Vec2& c) {
    return static_cast<int>(
        CGAL::orientation(Point2(a.x(), a.y()), Point2(b.x(), b.y()), Point2(c.x(), c.y())));
}

}  // namespace hex
