/// \file hierarchy.h
/// Levels of a truncated hierarchical spline (TH-spline3D): which elements and functions are active, and the
/// operator that truncates.
///
/// Omega(0) is the whole mesh; Omega(l+1) the union of the level-l elements chosen for refinement. The
/// support of a function is its 2-ring of elements. D(l): functions of level l with their support in
/// Omega(l). Active: functions in D(l) whose support is not all in Omega(l+1); elements of Omega(l) not in
/// Omega(l+1). With T(l) the map from the active functions' coefficients to level-l coefficients,
///     T(0) = E(0),   T(l) = (I - diag D(l)) C(l-1) T(l-1) + E(l),
/// column f of T(l) is the truncated function f. E(l) is the identity on the active functions of level l.
/// Sources: Wei, Zhang, Hughes, 2017 (TH-spline3D); Giannelli, Juettler, Speleers: THB-splines, 2012.
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <spline/level_mesh.h>
#include <spline/sparse_rows.h>

#include <cstdint>
#include <vector>

namespace spline {

/// Cell c of a level above 0 is child c % 8 of the (c / 8)-th of: the refined cells of the level below, then
/// its buffer cells.
struct HierarchyLevel {
    LevelMesh control;                 ///< mesh of the level: first its domain, then the buffer around it
    SparseRows coefficients;           ///< C from the level below; empty at level 0
    std::size_t domain_cells = 0;      ///< cells [0, domain_cells) make up Omega(l); the others are a buffer
    std::vector<hex::CellId> refined;  ///< chosen for refinement: first as listed, then added by closure
    std::vector<hex::CellId> buffer;   ///< the other cells around refined ones, in the published order
    std::vector<char> element_active;  ///< one flag a cell: in Omega(l), not refined
    std::vector<char> function_determined;  ///< one flag a vertex: in D(l)
    std::vector<char> function_active;      ///< one flag a vertex: in D(l), support not all in Omega(l+1)
    std::vector<std::uint32_t> function;    ///< number of an active function in the spline, else no_function
};

/// Stands for the number of a function that is not active (HierarchyLevel::function).
inline constexpr std::uint32_t no_function = 0xffffffffU;

/// All levels of a spline, and the numbers of its functions.
struct Hierarchy {
    std::vector<HierarchyLevel> levels;  ///< coarsest first, one more than lists that name an element
    std::size_t function_count = 0;      ///< active functions of all levels; numbered by level, then vertex
    /// Elements that closure or grading added to the list of each level: how many, one number a list.
    std::vector<std::size_t> added;
    hex::Diagnostics diagnostics;  ///< their codes are listed at build_hierarchy
};

/// Refines `coarsest` by `refinement`: entry l lists the elements of level l, 0-based in the cell order of
/// the mesh of level l, as read from lev_rfid.txt. Ids at a level depend on the lists of the levels below,
/// not on what closure adds.
///
/// With `closure`, lists are completed until
/// - around every irregular vertex of a refined element all elements are refined: then the truncated
///   functions are continuous across every interface;
/// - all elements around a refined element of level l are in Omega(l): neighbours differ by one level.
///
/// Throws Error{bad_input} for an id out of range, and for an element whose parent is not refined.
/// Diagnostics: `duplicate-refinement`, `closure`, `no-new-function`.
Hierarchy build_hierarchy(LevelMesh coarsest, const std::vector<std::vector<std::int64_t>>& refinement,
                          bool closure, const hex::Context& context = {});

/// Rows of T(l) for every vertex of each level, over the functions of the spline.
std::vector<SparseRows> truncation_operators(const Hierarchy& hierarchy);

}  // namespace spline
