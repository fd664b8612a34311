/// \file dirichlet_solver.h
/// A linear solver for CGAL's fixed border parameterizers that knows what their systems look like.
#pragma once

#include <CGAL/Eigen_matrix.h>
#include <CGAL/Eigen_vector.h>
#include <Eigen/SparseCore>

#include <cstddef>
#include <memory>
#include <vector>

namespace hex {

/// Model of CGAL's concept SparseLinearAlgebraTraits_d, as far as Fixed_border_parameterizer_3 uses it.
///
/// CGAL keeps a row `x_i = b_i` for every border vertex, which makes its matrix unsymmetric, and solves it
/// once for u and once for v, factorising twice. Here the border is eliminated, A_II x_I = b_I - A_IB b_B, so
/// that `Factorization` may be one for symmetric positive definite matrices, and the factorisation of the
/// first call serves the second. Therefore one object solves one parameterization only.
template <class Factorization>
class DirichletSolver {
  public:
    using NT = double;
    using Matrix = CGAL::Eigen_sparse_matrix<double>;
    using Vector = CGAL::Eigen_vector<double>;

    bool linear_solver(const Matrix& a, const Vector& b, Vector& x, NT& denominator) {
        denominator = 1.0;
        if (!prepared_) prepare(a.eigen_object());
        if (!usable_) return false;

        for (std::size_t i = 0; i < inner_of_.size(); ++i)
            if (inner_of_[i] < 0) x[static_cast<Eigen::Index>(i)] = b[static_cast<Eigen::Index>(i)];
        if (inner_count_ == 0) return true;
        Eigen::VectorXd right(inner_count_);
        for (std::size_t i = 0; i < inner_of_.size(); ++i)
            if (inner_of_[i] >= 0) right[inner_of_[i]] = b[static_cast<Eigen::Index>(i)];
        for (const Coupling& c : couplings_) right[c.inner] -= c.weight * b[c.border];
        const Eigen::VectorXd inner = factorization_->solve(right);
        if (factorization_->info() != Eigen::Success) return false;
        for (std::size_t i = 0; i < inner_of_.size(); ++i)
            if (inner_of_[i] >= 0) x[static_cast<Eigen::Index>(i)] = inner[inner_of_[i]];
        return true;
    }

  private:
    struct Coupling {
        Eigen::Index inner;
        Eigen::Index border;
        double weight;
    };

    /// Border rows are those without an entry off the diagonal: an inner vertex has at least two neighbours.
    void prepare(const Matrix::EigenType& a) {
        prepared_ = true;
        inner_of_.assign(static_cast<std::size_t>(a.rows()), -1);
        for_each_entry(a, [&](Eigen::Index row, Eigen::Index column, double) {
            if (row != column) inner_of_[static_cast<std::size_t>(row)] = 0;
        });
        for (Eigen::Index& number : inner_of_)
            if (number == 0) number = inner_count_++;
        std::vector<Eigen::Triplet<double, int>> entries;
        for_each_entry(a, [&](Eigen::Index row, Eigen::Index column, double value) {
            const Eigen::Index i = inner_of_[static_cast<std::size_t>(row)];
            const Eigen::Index j = inner_of_[static_cast<std::size_t>(column)];
            if (i < 0) return;
            if (j < 0)
                couplings_.push_back({i, column, value});
            else
                entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
        });
        usable_ = true;
        if (inner_count_ == 0) return;
        Eigen::SparseMatrix<double> inner(inner_count_, inner_count_);
        inner.setFromTriplets(entries.begin(), entries.end());
        factorization_->compute(inner);
        usable_ = factorization_->info() == Eigen::Success;
    }

    template <class Visit>
    static void for_each_entry(const Matrix::EigenType& a, const Visit& visit) {
        for (Eigen::Index outer = 0; outer < a.outerSize(); ++outer)
            for (Matrix::EigenType::InnerIterator entry(a, outer); entry; ++entry)
                visit(entry.row(), entry.col(), entry.value());
    }

    bool prepared_ = false;
    bool usable_ = false;
    Eigen::Index inner_count_ = 0;
    std::vector<Eigen::Index> inner_of_;  ///< number of each vertex among the inner ones, or -1
    std::vector<Coupling> couplings_;
    /// Shared because CGAL copies its solver, and factorisations of Eigen cannot be copied.
    std::shared_ptr<Factorization> factorization_ = std::make_shared<Factorization>();
};

}  // namespace hex
