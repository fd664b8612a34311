/// \file deck.h
/// An LS-DYNA keyword deck beside a BEXT file.
#pragma once

#include <spline/bezier.h>

#include <filesystem>
#include <string>

namespace spline::io {

/// The analysis that a deck asks for.
enum class DeckKind {
    eigen,         ///< the lowest 20 modes of the free solid
    linear_static  ///< fixed on the first patch, loaded on the last one
};

/// What goes into a deck. Material in the units of the model.
struct DeckOptions {
    DeckKind kind = DeckKind::eigen;  ///< the analysis
    /// Name of the BEXT file as the deck includes it (no folder: the deck lies beside it).
    std::string bext;
    bool bext2 = false;  ///< the BEXT file is version 2.0 (*IGA_INCLUDE_BEZIER), else 1 (*INCLUDE_TRANSFORM)
    double density = 1.0;  ///< > 0
    double young = 50.0;   ///< Young's modulus, > 0
    double poisson = 0.3;  ///< Poisson's ratio, in (-1, 0.5)
};

/// Writes part 1 with section 201, elastic material 1, the include, what the analysis needs, and one
/// *SET_NODE_LIST a boundary patch: set p + 1 holds the control points (id + 1) that shape patch p
/// (BezierSpline::boundary_patch). Throws Error{output}, Error{usage} for values out of range,
/// Error{bad_input} for a static deck of a spline with fewer than two known patches.
void write_deck(const std::filesystem::path& path, const BezierSpline& spline, const DeckOptions& options);

}  // namespace spline::io
