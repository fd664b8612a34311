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
    std::span<const std::uint32_t> columns;  ///< control points
    std::span<const double> values;          ///< their coefficients

    /// Number of coefficients.
    std::size_t size() const { return columns.size(); }
};

/// Rows of varying length in three arrays.
struct SparseRows {
    std::vector<std::size_t> offsets = {0};  ///< row r has the entries [offsets[r], offsets[r + 1])
    std::vector<std::uint32_t> columns;      ///< of every entry, in each row ascending and distinct
    std::vector<double> values;              ///< coefficient of every entry

    /// Number of rows.
    std::size_t size() const { return offsets.size() - 1; }
    /// Views into the arrays: valid until they change. `row` is not checked.
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
    /// Takes all terms away, but keeps the memory.
    void clear() { terms_.clear(); }
    /// Adds a term after those that are there.
    void add(std::uint32_t column, Value value) {
        terms_.push_back({column, static_cast<std::uint32_t>(terms_.size()), value});
    }

    /// One summand.
    struct Term {
        std::uint32_t column;    ///< what it is a coefficient of
        std::uint32_t sequence;  ///< place among the terms added
        Value value;             ///< coefficient, or its numerator
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
/// A row whose coefficients are sums of rounded numbers.
using RealRowSum = RowSum<double>;

}  // namespace spline
