/// \file counting_rows.h
/// Compressed rows by counting: linear, and the same result every time.
#pragma once

#include <hex/volume/topology.h>

namespace hex {

/// Builds rows from `visit(emit)`, which must call `emit(row, value)` for the same pairs in the same order
/// each of the two times it is called. Values keep the order of the calls within a row.
template <class T, class Visit>
CompressedRows<T> rows_by_counting(std::size_t row_count, const Visit& visit) {
    CompressedRows<T> rows;
    rows.offsets.assign(row_count + 1, 0);
    visit([&](std::size_t row, const T&) { ++rows.offsets[row + 1]; });
    for (std::size_t r = 0; r < row_count; ++r) rows.offsets[r + 1] += rows.offsets[r];
    rows.values.resize(rows.offsets.back());
    std::vector<std::size_t> next(rows.offsets.begin(), rows.offsets.end() - 1);
    visit([&](std::size_t row, const T& value) { rows.values[next[row]++] = value; });
    return rows;
}

}  // namespace hex
