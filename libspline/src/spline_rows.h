/// \file spline_rows.h
/// Building sparse rows in parallel, and applying them.
#pragma once

#include <hex/base/linear_algebra.h>
#include <hex/base/parallel.h>
#include <spline/sparse_rows.h>

#include <type_traits>

namespace spline {

/// Rows 0 .. count - 1. `make(i, sum)` fills an empty sum: numerators, and returns the denominator
/// (RationalRowSum), or values (RealRowSum), and returns nothing. Chunks of fixed size are built in parallel
/// and joined in order.
template <class Sum = RationalRowSum, class Make>
SparseRows build_rows(std::size_t count, const Make& make) {
    constexpr std::size_t chunk_size = 1024;
    const std::size_t chunks = (count + chunk_size - 1) / chunk_size;
    std::vector<SparseRows> parts(chunks);
    hex::parallel_for(
        chunks,
        [&](std::size_t chunk) {
            SparseRows& rows = parts[chunk];
            Sum sum;
            const std::size_t end = std::min(count, (chunk + 1) * chunk_size);
            rows.offsets.reserve(end - chunk * chunk_size + 1);
            for (std::size_t i = chunk * chunk_size; i < end; ++i) {
                sum.clear();
                if constexpr (std::is_same_v<Sum, RationalRowSum>) {
                    const auto denominator = static_cast<double>(make(i, sum));
                    for (const auto& term : sum.merged()) {
                        if (term.value == 0) continue;
                        rows.columns.push_back(term.column);
                        rows.values.push_back(static_cast<double>(term.value) / denominator);
                    }
                } else {
                    make(i, sum);
                    for (const auto& term : sum.merged()) {
                        rows.columns.push_back(term.column);
                        rows.values.push_back(term.value);
                    }
                }
                rows.offsets.push_back(rows.columns.size());
            }
        },
        1);

    SparseRows rows;
    std::vector<std::size_t> first(chunks + 1, 0);
    for (std::size_t c = 0; c < chunks; ++c) first[c + 1] = first[c] + parts[c].columns.size();
    rows.offsets.resize(count + 1);
    rows.columns.resize(first[chunks]);
    rows.values.resize(first[chunks]);
    hex::parallel_for(
        chunks,
        [&](std::size_t chunk) {
            SparseRows& part = parts[chunk];
            std::copy(part.columns.begin(), part.columns.end(),
                      rows.columns.begin() + static_cast<std::ptrdiff_t>(first[chunk]));
            std::copy(part.values.begin(), part.values.end(),
                      rows.values.begin() + static_cast<std::ptrdiff_t>(first[chunk]));
            for (std::size_t i = 1; i < part.offsets.size(); ++i)
                rows.offsets[chunk * chunk_size + i] = first[chunk] + part.offsets[i];
            part = {};
        },
        1);
    return rows;
}

/// Adds rows at the end.
inline void append(SparseRows& rows, const SparseRows& more) {
    const std::size_t offset = rows.columns.size();
    rows.columns.insert(rows.columns.end(), more.columns.begin(), more.columns.end());
    rows.values.insert(rows.values.end(), more.values.begin(), more.values.end());
    for (std::size_t i = 1; i < more.offsets.size(); ++i) rows.offsets.push_back(offset + more.offsets[i]);
}

/// Sum of the row's coefficients times points.
inline hex::Vec3 combine(SparseRow row, std::span<const hex::Vec3> points) {
    hex::Vec3 sum = hex::Vec3::Zero();
    for (std::size_t i = 0; i < row.size(); ++i) sum += row.values[i] * points[row.columns[i]];
    return sum;
}

}  // namespace spline
