/// \file scaled_jacobian_range.h
/// Scaled Jacobians of many elements, with the widest numbers that the processor has.
#pragma once

#include <hex/volume/hex_mesh.h>

#include <span>

namespace hex::quality {

/// Scaled Jacobians of the cells [first, last) into `values[first] ..`.
using RangeFunction = void (*)(const HexMesh& mesh, std::size_t first, std::size_t last,
                               std::span<double> values);

/// For any processor of the kind that the library was built for.
void scaled_jacobians_portable(const HexMesh& mesh, std::size_t first, std::size_t last,
                               std::span<double> values);

/// With 256-bit instructions (AVX2), or nullptr where this processor has none. The same bits.
RangeFunction scaled_jacobians_avx2();

}  // namespace hex::quality
