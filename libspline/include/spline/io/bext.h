/// \file bext.h
/// BEXT version 1: Bezier extraction as LS-DYNA reads it (docs/bext.md).
#pragma once

#include <hex/base/context.h>
#include <spline/bezier.h>

#include <filesystem>

namespace spline::io {

/// Writes a spline as BEXT 1 text, streaming: the text is never held. Numbers are in the shortest form that
/// reads back to the same double. A row with at most 20 non-zeros is sparse, else dense. Functions of an
/// element are in ascending order.
///
/// Throws Error{output}.
void write_bext(const std::filesystem::path& path, const BezierSpline& spline,
                const hex::Context& context = {});

/// Reads BEXT 1. Every element gets 64 Bezier points of its own; levels are not in the file. A function whose
/// row has no coefficient is left out.
///
/// Throws Error{bad_input} with `file:line` for anything that is not as docs/bext.md says, counts that
/// disagree, ids out of range, numbers that are not finite, weights <= 0; Error{unsupported} for other
/// element types and other degrees. A BEXT 2.0 file is read by read_bext2 and to_spline (bext2.h).
BezierSpline read_bext(const std::filesystem::path& path);

}  // namespace spline::io
