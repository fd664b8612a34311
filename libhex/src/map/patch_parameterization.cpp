// Triangles without area make CGAL's weights meaningless, which its assertions report in debug builds only.
// Here every build takes what the weights give and judges it by the flipped triangles, so that all builds
// give the same result.
#ifndef CGAL_NDEBUG
#define CGAL_NDEBUG
#endif

#include "map/dirichlet_solver.h"

#include <hex/base/error.h>
#include <hex/map/patch_map.h>
#include <hex/surface/cgal_bridge.h>

#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Discrete_conformal_map_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Square_border_parameterizer_3.h>
#include <CGAL/predicates_on_points_2.h>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

namespace hex {
namespace {

namespace smp = CGAL::Surface_mesh_parameterization;

using Point2 = CgalKernel::Point_2;
using VertexHandle = TriangleMesh::VertexHandle;
using HalfedgeHandle = TriangleMesh::HalfedgeHandle;

using Border = smp::Square_border_arc_length_parameterizer_3<TriangleMesh>;
// Cotangents make the stiffness matrix of linear elements, uniform weights a graph Laplacian: both positive
// definite once the border is fixed. Mean-value weights are not symmetric.
using Cholesky = DirichletSolver<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>;
using GaussianElimination = DirichletSolver<Eigen::SparseLU<Eigen::SparseMatrix<double>>>;
using DiscreteConformal = smp::Discrete_conformal_map_parameterizer_3<TriangleMesh, Border, Cholesky>;
using MeanValue = smp::Mean_value_coordinates_parameterizer_3<TriangleMesh, Border, GaussianElimination>;
using Uniform = smp::Barycentric_mapping_parameterizer_3<TriangleMesh, Border, Cholesky>;

/// A property map of CGAL's over the vertices of a mesh, kept outside the mesh.
template <class Value>
struct VertexValues {
    using key_type = VertexHandle;
    using value_type = Value;
    using reference = Value;
    using category = boost::read_write_property_map_tag;

    std::deque<Value>* values;

    friend Value get(const VertexValues& map, VertexHandle v) {
        return (*map.values)[static_cast<std::size_t>(v.idx())];
    }
    friend void put(const VertexValues& map, VertexHandle v, const Value& value) {
        (*map.values)[static_cast<std::size_t>(v.idx())] = value;
    }
};

struct VertexIndex {
    using key_type = VertexHandle;
    using value_type = int;
    using reference = int;
    using category = boost::readable_property_map_tag;

    friend int get(const VertexIndex&, VertexHandle v) { return v.idx(); }
};

/// The triangles of one patch as a mesh of its own, with the four corners.
struct PatchMesh {
    TriangleMesh mesh;
    std::array<VertexHandle, 4> corners;
    std::vector<unsigned> sides;  ///< bit k of a vertex: it lies on the chain from corner k to corner k + 1
    std::size_t split_edges = 0;
};

PatchMesh extract(const TriangleMesh& surface, const Patch& patch) {
    PatchMesh result;
    std::vector<int> vertices;
    for (const int t : patch.triangles)
        for (const auto v : surface.fv_range(TriangleMesh::FaceHandle(t))) vertices.push_back(v.idx());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto local = [&](int v) {
        return VertexHandle(
            static_cast<int>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin()));
    };

    for (const int v : vertices) result.mesh.add_vertex(surface.point(VertexHandle(v)));
    for (const int t : patch.triangles) {
        std::array<VertexHandle, 3> corners;
        std::size_t k = 0;
        for (const auto v : surface.fv_range(TriangleMesh::FaceHandle(t))) corners[k++] = local(v.idx());
        result.mesh.add_face(corners[0], corners[1], corners[2]);
    }
    result.sides.assign(vertices.size(), 0);
    for (std::size_t k = 0; k < 4; ++k) {
        result.corners[k] = local(patch.corners[k]);
        for (const int v : patch.loops.front()[k])
            result.sides[static_cast<std::size_t>(local(v).idx())] |= 1U << k;
    }
    return result;
}

/// Cuts the inner edges that join two vertices of one side; the new vertices are inner ones, so the new edges
/// never need it.
void split_edges_along_sides(PatchMesh& patch) {
    const std::size_t count = patch.mesh.n_edges();
    for (std::size_t i = 0; i < count; ++i) {
        const TriangleMesh::EdgeHandle e(static_cast<int>(i));
        if (patch.mesh.is_boundary(e)) continue;
        const HalfedgeHandle h = patch.mesh.halfedge_handle(e, 0);
        const VertexHandle a = patch.mesh.from_vertex_handle(h);
        const VertexHandle b = patch.mesh.to_vertex_handle(h);
        if ((patch.sides[static_cast<std::size_t>(a.idx())] &
             patch.sides[static_cast<std::size_t>(b.idx())]) == 0)
            continue;
        patch.mesh.split(e, (patch.mesh.point(a) + patch.mesh.point(b)) * 0.5);
        patch.sides.push_back(0);
        ++patch.split_edges;
    }
}

/// The half-edge of the border that starts at corner 0.
HalfedgeHandle border_at_first_corner(const PatchMesh& patch) {
    for (const auto h : patch.mesh.voh_range(patch.corners[0]))
        if (patch.mesh.is_boundary(h)) return h;
    return HalfedgeHandle();
}

template <class Parameterizer>
std::optional<std::vector<Vec2>> flatten(PatchMesh& patch) {
    // CGAL walks the border of the hole, that is clockwise around the patch: c0 c3 c2 c1 come to (0,0),
    // (1,0), (1,1), (0,1). Exchanging u and v puts them where they belong and turns the triangles the right
    // way round.
    const Border border(patch.corners[0], patch.corners[3], patch.corners[2], patch.corners[1]);
    std::deque<Point2> uv(patch.mesh.n_vertices(), Point2(0, 0));
    std::deque<bool> done(patch.mesh.n_vertices(), false);
    Parameterizer parameterizer(border);
    if (parameterizer.parameterize(patch.mesh, border_at_first_corner(patch), VertexValues<Point2>{&uv},
                                   VertexIndex(), VertexValues<bool>{&done}) != smp::OK)
        return std::nullopt;
    std::vector<Vec2> result;
    result.reserve(uv.size());
    for (const Point2& p : uv) {
        if (!std::isfinite(p.x()) || !std::isfinite(p.y())) return std::nullopt;
        result.emplace_back(p.y(), p.x());
    }
    return result;
}

std::size_t count_flipped(const std::vector<Vec2>& uv, const std::vector<std::array<int, 3>>& triangles) {
    const auto at = [&](int v) {
        const Vec2& p = uv[static_cast<std::size_t>(v)];
        return Point2(p.x(), p.y());
    };
    return static_cast<std::size_t>(std::count_if(triangles.begin(), triangles.end(), [&](const auto& t) {
        return CGAL::orientation(at(t[0]), at(t[1]), at(t[2])) != CGAL::LEFT_TURN;
    }));
}

}  // namespace

std::string name_of(PatchWeights weights) {
    switch (weights) {
        case PatchWeights::discrete_conformal:
            return "discrete-conformal";
        case PatchWeights::mean_value:
            return "mean-value";
        case PatchWeights::uniform:
            return "uniform";
    }
    return {};
}

PatchParameterization parameterize(const TriangleMesh& surface, const Patch& patch) {
    if (!patch.four_sided)
        throw Error(ErrorKind::bad_input,
                    fmt::format("a patch of part {} is not a disk with four corners", patch.part));
    PatchMesh cut = extract(surface, patch);
    split_edges_along_sides(cut);

    PatchParameterization result;
    result.split_edges = cut.split_edges;
    for (const auto v : cut.mesh.vertices()) result.points.push_back(to_eigen(cut.mesh.point(v)));
    for (const auto f : cut.mesh.faces()) {
        std::array<int, 3> corners{};
        std::size_t k = 0;
        for (const auto v : cut.mesh.fv_range(f)) corners[k++] = v.idx();
        result.triangles.push_back(corners);
    }

    for (const PatchWeights weights :
         {PatchWeights::discrete_conformal, PatchWeights::mean_value, PatchWeights::uniform}) {
        std::optional<std::vector<Vec2>> uv = weights == PatchWeights::discrete_conformal
                                                  ? flatten<DiscreteConformal>(cut)
                                              : weights == PatchWeights::mean_value ? flatten<MeanValue>(cut)
                                                                                    : flatten<Uniform>(cut);
        if (!uv) continue;
        const std::size_t flipped = count_flipped(*uv, result.triangles);
        if (!result.uv.empty() && flipped >= result.flipped) continue;
        result.uv = std::move(*uv);
        result.weights = weights;
        result.flipped = flipped;
        if (flipped == 0) break;
    }
    if (result.uv.empty())
        throw Error(ErrorKind::no_result, fmt::format("a patch of part {} cannot be flattened", patch.part),
                    {}, "look for degenerate triangles in it");
    return result;
}

}  // namespace hex
