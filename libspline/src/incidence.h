/// \file incidence.h
/// Which elements a control point shapes.
#pragma once

#include <spline/bezier.h>

#include <cstdint>
#include <span>
#include <vector>

namespace spline {

/// Elements in which each control point is used.
struct Incidence {
    std::vector<std::size_t> offsets;
    std::vector<std::uint32_t> elements;

    explicit Incidence(const BezierSpline& spline);
    std::span<const std::uint32_t> operator[](std::uint32_t function) const {
        return {elements.data() + offsets[function], offsets[function + 1] - offsets[function]};
    }
};

}  // namespace spline
