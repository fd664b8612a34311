#include "polycube/integer_polycube.h"

#include <hex/base/error.h>
#include <hex/base/integer_program.h>
#include <hex/base/parallel.h>
#include <hex/surface/polygon_soup.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace hex {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

struct Hit {
    int chart = -1;
    double distance = 0.0;
};

}  // namespace

std::vector<PlaneOrder> side_orders(const ChartGraph& graph) {
    std::vector<PlaneOrder> orders;
    for (std::size_t s = 0; s < graph.sides.size(); ++s) {
        const ChartSide& side = graph.sides[s];
        PlaneOrder order;
        order.low = side.ends[side.direction > 0 ? 0 : 1];
        order.high = side.ends[side.direction > 0 ? 1 : 0];
        // A wavy side is not much longer than its ends are apart; a bent one is.
        order.length = std::max(std::abs(side.rise), 0.5 * side.length);
        order.weight = 1.0;
        order.side = static_cast<int>(s);
        orders.push_back(order);
    }
    return orders;
}

std::vector<PlaneOrder> ray_orders(const TriangleMesh& mesh, const ChartGraph& graph) {
    Triangles triangles;
    for (const auto f : mesh.faces()) {
        std::array<Kernel::Point_3, 3> p;
        std::size_t k = 0;
        for (const auto v : mesh.fv_range(f)) {
            const auto& x = mesh.point(v);
            p[k++] = Kernel::Point_3(x[0], x[1], x[2]);
        }
        triangles.emplace_back(p[0], p[1], p[2]);
    }
    Tree tree(triangles.begin(), triangles.end());
    tree.build();

    std::vector<std::array<Hit, 2>> hits(triangles.size());
    parallel_for(triangles.size(), [&](std::size_t t) {
        const int chart = graph.layout.patch_of_triangle[t];
        const int label = graph.charts[at(chart)].label;
        const Kernel::Point_3 from = CGAL::centroid(triangles[t]);
        for (std::size_t way = 0; way < 2; ++way) {
            const int sign = sign_of(label) * (way == 0 ? -1 : 1);
            std::array<double, 3> d = {0, 0, 0};
            d[at(axis_of(label))] = sign;
            const Kernel::Ray_3 ray(from, Kernel::Vector_3(d[0], d[1], d[2]));
            const auto skip = [&](const Primitive::Id& id) {
                return static_cast<std::size_t>(id - triangles.cbegin()) == t;
            };
            const auto hit = tree.first_intersection(ray, skip);
            if (!hit) continue;
            const auto other = static_cast<std::size_t>(hit->second - triangles.cbegin());
            const int chart_hit = graph.layout.patch_of_triangle[other];
            const int label_hit = graph.charts[at(chart_hit)].label;
            if (label_hit / 2 != label / 2 || label_hit == label) continue;
            const Kernel::Point_3 to = CGAL::centroid(triangles[other]);
            hits[t][way] = {chart_hit, std::abs(to[axis_of(label)] - from[axis_of(label)])};
        }
    });

    struct Sum {
        double area = 0.0;
        double distance = 0.0;
    };
    std::map<std::array<int, 2>, Sum> sums;
    std::vector<double> chart_area(graph.charts.size(), 0.0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const int chart = graph.layout.patch_of_triangle[t];
        const double area = std::sqrt(triangles[t].squared_area());
        chart_area[at(chart)] += area;
        const int label = graph.charts[at(chart)].label;
        for (std::size_t way = 0; way < 2; ++way) {
            const Hit& hit = hits[t][way];
            if (hit.chart < 0) continue;
            const bool above = sign_of(label) * (way == 0 ? -1 : 1) > 0;
            Sum& sum = sums[above ? std::array{chart, hit.chart} : std::array{hit.chart, chart}];
            sum.area += area;
            sum.distance += area * hit.distance;
        }
    }
    std::vector<std::pair<double, PlaneOrder>> ranked;
    for (const auto& [pair, sum] : sums) {
        const double share = sum.area / (chart_area[at(pair[0])] + chart_area[at(pair[1])]);
        if (share < 0.02) continue;
        PlaneOrder order;
        order.low = pair[0];
        order.high = pair[1];
        order.length = sum.distance / sum.area;
        order.weight = share;
        ranked.emplace_back(-share, order);
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<PlaneOrder> orders;
    for (const auto& [rank, order] : ranked) orders.push_back(order);
    return orders;
}

PlaneOrders::PlaneOrders(const ChartGraph& graph) : graph_(&graph), above_(graph.charts.size()) {}

std::vector<int> PlaneOrders::cycle(const PlaneOrder& order) const {
    const int start = graph_->same_plane[at(order.high)];
    const int goal = graph_->same_plane[at(order.low)];
    std::vector<int> came(above_.size(), -1);
    std::vector<int> open = {start};
    came[at(start)] = start;
    for (std::size_t next = 0; next < open.size() && came[at(goal)] < 0; ++next) {
        for (const int plane : above_[at(open[next])]) {
            if (came[at(plane)] >= 0) continue;
            came[at(plane)] = open[next];
            open.push_back(plane);
        }
    }
    if (came[at(goal)] < 0) return {};
    std::vector<int> path = {goal};
    while (path.back() != start) path.push_back(came[at(path.back())]);
    std::reverse(path.begin(), path.end());
    return path;
}

bool PlaneOrders::add(const PlaneOrder& order) {
    if (!cycle(order).empty()) return false;
    above_[at(graph_->same_plane[at(order.low)])].push_back(graph_->same_plane[at(order.high)]);
    orders_.push_back(order);
    return true;
}

std::vector<int> solve_coordinates(const ChartGraph& graph, const PlaneOrders& orders, double unit) {
    IntegerProgram program;
    std::vector<int> variable(graph.charts.size(), -1);
    for (std::size_t c = 0; c < graph.charts.size(); ++c) {
        if (graph.same_plane[c] == static_cast<int>(c))
            variable[c] = program.add_variable({.lower = 0.0, .upper = 1e6, .cost = 1e-6, .integer = true});
    }
    const auto of = [&](int chart) { return variable[at(graph.same_plane[at(chart)])]; };
    for (const PlaneOrder& order : orders.orders()) {
        const std::array<IntegerProgram::Term, 2> terms = {{{of(order.high), 1.0}, {of(order.low), -1.0}}};
        program.add_row(terms, 1.0, IntegerProgram::infinity);
        program.add_distance(terms, std::max(1.0, std::round(order.length / unit)), order.weight);
    }
    const IntegerProgramResult result = program.minimise();
    if (!result.solved())
        throw Error(ErrorKind::no_result, "the integer program of the polycube has no solution");
    std::vector<int> coordinates(graph.charts.size());
    for (std::size_t c = 0; c < coordinates.size(); ++c)
        coordinates[c] = result.integer(of(static_cast<int>(c)));
    return coordinates;
}

}  // namespace hex
