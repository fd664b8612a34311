#include "spline_result.h"

#include <hex/base/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace spline {
namespace {

[[noreturn]] void refuse(const std::string& what) {
    throw hex::Error(hex::ErrorKind::bad_input, what);
}

/// Rows over so many control points.
void require_rows(const SparseRows& rows, std::size_t control_points) {
    if (rows.offsets.empty() || rows.offsets.front() != 0 || rows.offsets.back() != rows.columns.size() ||
        rows.columns.size() != rows.values.size() ||
        !std::is_sorted(rows.offsets.begin(), rows.offsets.end()))
        refuse("the rows of its Bezier points do not fit their lists");
    if (std::any_of(rows.columns.begin(), rows.columns.end(),
                    [&](std::uint32_t column) { return column >= control_points; }))
        refuse("a Bezier point uses a control point that is not there");
    if (!std::all_of(rows.values.begin(), rows.values.end(), [](double v) { return std::isfinite(v); }))
        refuse("a Bezier point has a coefficient that is not finite");
}

void require_level(const ControlMesh& level, std::size_t control_points) {
    const std::size_t vertices = level.mesh.vertex_count();
    if (level.function.size() != vertices || level.function_active.size() != vertices ||
        level.element_active.size() != level.mesh.cell_count())
        refuse("the lists of a level do not fit its mesh");
    for (std::size_t v = 0; v < vertices; ++v)
        if (level.function_active[v] != 0 && level.function[v] >= control_points)
            refuse("a level has a control point that is not there");
    for (const hex::CellId c : level.refined)
        if (!c.valid() || c.index() >= level.mesh.cell_count())
            refuse("a level divides an element that is not there");
}

}  // namespace

void require_spline(const SplineResult& result) {
    const BezierSpline& spline = result.spline;
    if (spline.elements.empty()) refuse("it has no elements");
    const std::size_t control_points = spline.control_points.size();
    for (std::size_t v = 0; v < control_points; ++v)
        if (!spline.control_points[v].allFinite())
            refuse("control point " + std::to_string(v) + " has a coordinate that is not finite");
    if (spline.weights.size() != control_points)
        refuse(std::to_string(control_points) + " control points have " +
               std::to_string(spline.weights.size()) + " weights");
    if (!std::all_of(spline.weights.begin(), spline.weights.end(),
                     [](double w) { return std::isfinite(w) && w > 0.0; }))
        refuse("a weight is not positive");
    require_rows(spline.rows, control_points);
    for (const auto& element : spline.elements)
        if (std::any_of(element.begin(), element.end(),
                        [&](std::uint32_t point) { return point >= spline.rows.size(); }))
            refuse("an element has a Bezier point that is not there");
    const std::size_t elements = spline.element_count();
    if (spline.element_level.size() != elements || spline.element_cell.size() != elements ||
        (!spline.boundary_patch.empty() && spline.boundary_patch.size() != elements))
        refuse("the lists of its elements do not fit each other");
    for (const ControlMesh& level : result.levels) require_level(level, control_points);
}

}  // namespace spline
