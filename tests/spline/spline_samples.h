/// \file spline_samples.h
/// Meshes and row algebra for the tests of the spline construction.
#pragma once

#include "support/meshes.h"

#include <hex/feature/feature_set.h>
#include <spline/blending.h>
#include <spline/hierarchy.h>
#include <spline/level_mesh.h>
#include <spline/spline.h>
#include <spline/subdivision.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace spline::test {

/// Level 0 of a mesh, with features by angle or without.
inline LevelMesh level_of(const hex::HexMesh& mesh, bool sharp) {
    hex::EdgeTable edges = hex::edge_table(mesh);
    hex::BoundaryQuads boundary = hex::boundary_quads(mesh);
    hex::FeatureSet features =
        sharp ? hex::features_by_angle(mesh, edges, boundary, 0.8) : hex::no_features(mesh, edges, boundary);
    return coarsest_level(mesh, std::move(edges), std::move(boundary), std::move(features));
}

/// A sample of meshes: irregular edges of valence 3, 5, 6 inside and on the boundary, a regular grid, each
/// with and without sharp features; refined once so that there are inner elements.
struct Sample {
    std::string name;
    int valence;  ///< of the extraordinary edges; 4: a regular grid
    bool sharp;
};

inline const std::vector<Sample>& samples() {
    static const std::vector<Sample> all = {
        {"grid_smooth", 4, false}, {"grid_sharp", 4, true},   {"fan3_smooth", 3, false},
        {"fan3_sharp", 3, true},   {"fan5_smooth", 5, false}, {"fan5_sharp", 5, true},
        {"fan6_smooth", 6, false}, {"fan6_sharp", 6, true},
    };
    return all;
}

inline hex::HexMesh sample_mesh(const Sample& sample) {
    return sample.valence == 4
               ? hex::test::shuffled_grid(4, 4, 4, 7)
               : subdivide(level_of(hex::test::fan(sample.valence, 2), sample.sharp)).fine.mesh;
}

/// The level-0 mesh of a sample, features inherited from the unrefined fan.
inline LevelMesh sample_level(const Sample& sample) {
    if (sample.valence == 4) return level_of(hex::test::shuffled_grid(4, 4, 4, 7), sample.sharp);
    return subdivide(level_of(hex::test::fan(sample.valence, 2), sample.sharp)).fine;
}

/// Columns ascending and distinct.
using Row = std::vector<std::pair<std::uint32_t, double>>;
using ElementRows = std::array<Row, 64>;

/// Sum of multiples of rows.
class Sum {
  public:
    void add(std::uint32_t column, double value) {
        if (column >= values_.size()) values_.resize(column + 1, 0.0), touched_.resize(column + 1, 0);
        if (touched_[column] == 0) columns_.push_back(column);
        touched_[column] = 1;
        values_[column] += value;
    }
    void add(const Row& row, double factor) {
        for (const auto& [column, value] : row) add(column, factor * value);
    }
    void add(SparseRow row, double factor) {
        for (std::size_t i = 0; i < row.size(); ++i) add(row.columns[i], factor * row.values[i]);
    }
    /// The sum; this object is empty again.
    Row take() {
        std::sort(columns_.begin(), columns_.end());
        Row row;
        for (const std::uint32_t column : columns_) {
            row.emplace_back(column, values_[column]);
            values_[column] = 0.0;
            touched_[column] = 0;
        }
        columns_.clear();
        return row;
    }

  private:
    std::vector<double> values_;
    std::vector<char> touched_;
    std::vector<std::uint32_t> columns_;
};

/// Largest difference of two rows in a column.
inline double difference(const Row& a, const Row& b) {
    double largest = 0.0;
    auto i = a.begin();
    auto j = b.begin();
    while (i != a.end() || j != b.end()) {
        if (j == b.end() || (i != a.end() && i->first < j->first)) {
            largest = std::max(largest, std::abs((i++)->second));
        } else if (i == a.end() || j->first < i->first) {
            largest = std::max(largest, std::abs((j++)->second));
        } else {
            largest = std::max(largest, std::abs((i++)->second - (j++)->second));
        }
    }
    return largest;
}

inline double sum_of(const Row& row) {
    double sum = 0.0;
    for (const auto& [column, value] : row) sum += value;
    return sum;
}

inline Row as_row(SparseRow row) {
    Row result;
    for (std::size_t i = 0; i < row.size(); ++i) result.emplace_back(row.columns[i], row.values[i]);
    return result;
}

/// Rows of M of one element.
inline ElementRows blending_rows(const LevelMesh& level, hex::CellId cell) {
    const BlendingOperator blending(level);
    const auto points = blending.element_points(cell);
    ElementRows rows;
    RationalRowSum sum;
    for (std::size_t p = 0; p < 64; ++p) {
        const auto denominator = static_cast<double>(blending.row(points[p], sum));
        for (const auto& term : sum.merged())
            rows[p].emplace_back(term.column, static_cast<double>(term.value) / denominator);
    }
    return rows;
}

/// rows times matrix.
inline ElementRows times(const ElementRows& rows, const SparseRows& matrix) {
    ElementRows result;
    Sum sum;
    for (std::size_t p = 0; p < 64; ++p) {
        for (const auto& [column, value] : rows[p]) sum.add(matrix[column], value);
        result[p] = sum.take();
    }
    return result;
}

/// Rows of the Bezier points of child c of an element, by de Casteljau in the three directions.
inline ElementRows split(const ElementRows& rows, std::size_t child) {
    constexpr double left[4][4] = {{1, 0, 0, 0}, {.5, .5, 0, 0}, {.25, .5, .25, 0}, {.125, .375, .375, .125}};
    ElementRows result = rows;
    Sum sum;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool upper = hex::hexahedron::corner_uvw[child][axis] == 1;
        const std::size_t stride = axis == 0 ? 1 : axis == 1 ? 4 : 16;
        ElementRows next;
        for (std::size_t p = 0; p < 64; ++p) {
            const std::size_t i = p / stride % 4;
            for (std::size_t k = 0; k < 4; ++k) {
                const double weight = upper ? left[3 - i][3 - k] : left[i][k];
                if (weight != 0.0) sum.add(result[p - i * stride + k * stride], weight);
            }
            next[p] = sum.take();
        }
        result = std::move(next);
    }
    return result;
}

inline double difference(const ElementRows& a, const ElementRows& b) {
    double largest = 0.0;
    for (std::size_t p = 0; p < 64; ++p) largest = std::max(largest, difference(a[p], b[p]));
    return largest;
}

/// The Bezier points of a local face.
inline std::vector<std::size_t> face_points(int face) {
    const auto axis = static_cast<std::size_t>(face == 4 || face == 2 ? 0 : face == 1 || face == 3 ? 1 : 2);
    const std::size_t end = face == 2 || face == 3 || face == 5 ? 3 : 0;
    const std::size_t stride = axis == 0 ? 1 : axis == 1 ? 4 : 16;
    std::vector<std::size_t> points;
    for (std::size_t p = 0; p < 64; ++p) {
        if (p / stride % 4 == end) points.push_back(p);
    }
    return points;
}

/// Valence 5, sharp edges by angle; refined: to two levels.
inline BezierSpline small_spline(bool refined) {
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    if (refined) options.refinement = {{0, 1, 2}, {0, 9}};
    return build(hex::test::fan(5, 3), options).spline;
}

/// The same control points, and rows of all Bezier points of all elements.
inline void expect_same_extraction(const BezierSpline& a, const BezierSpline& b) {
    EXPECT_EQ(a.control_points, b.control_points);
    EXPECT_EQ(a.weights, b.weights);
    ASSERT_EQ(a.element_count(), b.element_count());
    for (std::size_t e = 0; e < a.element_count(); ++e) {
        for (std::size_t p = 0; p < 64; ++p)
            EXPECT_EQ(as_row(a.rows[a.elements[e][p]]), as_row(b.rows[b.elements[e][p]]));
    }
}

/// Largest jump of an active function between a refined element's children and its unrefined neighbours.
inline double interface_jump(const Hierarchy& hierarchy) {
    const std::vector<SparseRows> truncation = truncation_operators(hierarchy);
    double jump = 0.0;
    for (std::size_t l = 0; l + 1 < hierarchy.levels.size(); ++l) {
        const HierarchyLevel& level = hierarchy.levels[l];
        std::vector<char> refined(level.control.mesh.cell_count(), 0);
        for (const hex::CellId e : level.refined) refined[e.index()] = 1;
        for (std::size_t k = 0; k < level.refined.size(); ++k) {
            const hex::CellId e = level.refined[k];
            for (int f = 0; f < 6; ++f) {
                const hex::CellId other = level.control.mesh.neighbour(e, f);
                if (!other.valid() || refined[other.index()] != 0 || level.element_active[other.index()] == 0)
                    continue;
                const ElementRows coarse = times(blending_rows(level.control, e), truncation[l]);
                for (const int corner : hex::hexahedron::face_corners[static_cast<std::size_t>(f)]) {
                    const auto child = static_cast<std::size_t>(corner);
                    const ElementRows from_coarse = split(coarse, child);
                    const ElementRows fine =
                        times(blending_rows(hierarchy.levels[l + 1].control, hex::CellId(8 * k + child)),
                              truncation[l + 1]);
                    for (const std::size_t p : face_points(f))
                        jump = std::max(jump, difference(from_coarse[p], fine[p]));
                }
            }
        }
    }
    return jump;
}

}  // namespace spline::test
