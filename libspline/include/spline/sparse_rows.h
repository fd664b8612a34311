/// \file sparse_rows.h
/// Sparse matrices by rows, as the spline construction uses them: every row a combination of control points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spline {

/// One row: `columns` ascending and distinct, `values` beside them.
struct SparseRow {
    std::span<const std::uint32_t> columns;
    std::span<const double> values;

    std::size_t size() const { return columns.size(); }
};

/// Rows of varying length in three arrays.
struct SparseRows {
    std::vector<std::size_t> offsets = {0};
    std::vector<std::uint32_t> columns;
    std::vector<double> values;

    std::size_t size() const { return offsets.size() - 1; }
    SparseRow operator[](std::size_t row) const {
        const std::size_t begin = offsets[row];
        const std::size_t length = offsets[row + 1] - begin;
        return {{columns.data() + begin, length}, {values.data() + begin, length}};
    }
};

/// Sum of (column, value) terms that become one row. Terms of equal column are added in the order in which
/// they came, so the same terms give the same bits wherever the row is built.
template <class Value>
class RowSum {
  public:
    void clear() { terms_.clear(); }
    void add(std::uint32_t column, Value value) {
        terms_.push_back({column, static_cast<std::uint32_t>(terms_.size()), value});
    }

    struct Term {
        std::uint32_t column;
        std::uint32_t sequence;  ///< place among the terms added
        Value value;
    };

    /// Sorts and merges; the terms are then distinct and ascending. Clearing is left to the caller.
    std::span<const Term> merged() {
        std::sort(terms_.begin(), terms_.end(), [](const Term& a, const Term& b) {
            return a.column != b.column ? a.column < b.column : a.sequence < b.sequence;
        });
        std::size_t kept = 0;
        for (std::size_t i = 0; i < terms_.size(); ++i) {
            if (kept > 0 && terms_[kept - 1].column == terms_[i].column)
                terms_[kept - 1].value += terms_[i].value;
            else
                terms_[kept++] = terms_[i];
        }
        terms_.resize(kept);
        return terms_;
    }

  private:
    std::vector<Term> terms_;
};

/// A row whose coefficients are rational numbers with one denominator: sums are exact and each coefficient is
/// rounded once.
using RationalRowSum = RowSum<std::int64_t>;
using RealRowSum = RowSum<double>;

}  // namespace spline
