/// \file bext2.h
/// BEXT version 2.0: Bezier extraction with coefficient vectors that elements share (docs/bext.md).
#pragma once

#include <hex/base/context.h>
#include <hex/base/linear_algebra.h>
#include <spline/bezier.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace spline::io {

/// A BEXT 2.0 file as it is: other degrees, surfaces and rational weights included.
struct Bext2 {
    /// Elements of one kind, one after the other.
    struct Block {
        int type = 1;                        ///< ETYPE; 1 is the only one that docs/bext.md knows
        std::vector<int> degrees;            ///< two for surfaces, three for solids
        std::size_t elements = 0;            ///< how many
        std::size_t functions = 0;           ///< of each element
        std::vector<std::uint32_t> nodes;    ///< 0-based control points, `functions` an element
        std::vector<std::uint32_t> vectors;  ///< 0-based coefficient vectors of these, in the same order
    };
    /// Coefficient vectors of one length; numbered through all groups.
    struct Group {
        std::size_t length = 0;      ///< coefficients of a vector: product of (degree + 1)
        std::vector<double> values;  ///< vector by vector, u fastest
        /// Number of vectors.
        std::size_t count() const { return length == 0 ? 0 : values.size() / length; }
    };
    std::int64_t patch = 1;         ///< PID
    std::int64_t weight_flag = 1;   ///< WFL; kept as it is: weights are read and written whatever it says
    std::vector<hex::Vec3> points;  ///< control points
    std::vector<double> weights;    ///< > 0, one a control point
    std::vector<Block> blocks;      ///< all elements, in the order of the file
    std::vector<Group> groups;      ///< all coefficient vectors, in the order of the file

    /// Number of elements of all blocks.
    std::size_t element_count() const;
    /// Number of coefficient vectors of all groups.
    std::size_t vector_count() const;
};

/// Throws Error{bad_input} with `file:line`; Error{unsupported} for another version, for sparse coefficient
/// vectors, whose layout is not public, for elements with more or fewer vectors than control points, and for
/// degrees above 20.
Bext2 read_bext2(const std::filesystem::path& path);
/// Numbers in the shortest form that reads back to the same double, in columns of 24; ids in columns of 8.
/// Throws Error{output}; Error{unsupported} for more control points or vectors than eight digits can count.
void write_bext2(const std::filesystem::path& path, const Bext2& data);

/// Elements keep their order; equal rows of all elements are one coefficient vector.
Bext2 to_bext2(const BezierSpline& spline, const hex::Context& context = {});
/// Writes `to_bext2` of a spline; throws as above.
void write_bext2(const std::filesystem::path& path, const BezierSpline& spline,
                 const hex::Context& context = {});

/// The solid elements as tricubic ones: lower degrees are raised, which changes no function. Throws
/// Error{unsupported} for surfaces and for degrees above 3 or below 1; Error{bad_input} for a control point
/// twice in an element and for a Bezier point without coefficient.
BezierSpline to_spline(const Bext2& data);

}  // namespace spline::io
