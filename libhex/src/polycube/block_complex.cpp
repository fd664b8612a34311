#include "polycube/block_complex.h"

#include <hex/base/components.h>
#include <hex/base/error.h>
#include <hex/volume/hexahedron.h>

#include <algorithm>
#include <map>
#include <set>

namespace hex {
namespace {

using Index = std::array<int, 3>;

Index step(Index i, int axis, int by) {
    i[at(axis)] += by;
    return i;
}

class Builder {
  public:
    Builder(const ChartGraph& graph, const std::vector<int>& coordinates)
        : graph_(graph), coordinates_(coordinates) {}

    BlockComplex build() {
        find_planes();
        cover_faces();
        if (result_.conflicts.empty()) fill();
        if (result_.conflicts.empty()) {
            join_corners();
            mark_walls();
            flood_walls();
            join_cells();
        }
        if (result_.conflicts.empty()) collect_sides();
        if (result_.conflicts.empty()) {
            result_.segments.resize(graph_.charts.size());
            for (std::size_t c = 0; c < graph_.charts.size(); ++c) collect_segments(static_cast<int>(c));
        }
        return std::move(result_);
    }

  private:
    int label(int chart) const { return graph_.charts[at(chart)].label; }
    int plane(int chart) const { return result_.plane_of_chart[at(chart)]; }
    int cells_along(int axis) const { return static_cast<int>(result_.planes[at(axis)].size()) - 1; }

    void conflict(int chart, int other) {
        for (const ChartConflict& known : result_.conflicts)
            if (known.chart == chart && known.other == other) return;
        result_.conflicts.push_back({chart, other});
    }

    void find_planes() {
        for (std::size_t c = 0; c < graph_.charts.size(); ++c)
            result_.planes[at(axis_of(graph_.charts[c].label))].push_back(coordinates_[c]);
        for (auto& planes : result_.planes) {
            std::sort(planes.begin(), planes.end());
            planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
        }
        for (std::size_t c = 0; c < graph_.charts.size(); ++c) {
            const auto& planes = result_.planes[at(axis_of(graph_.charts[c].label))];
            result_.plane_of_chart.push_back(static_cast<int>(
                std::lower_bound(planes.begin(), planes.end(), coordinates_[c]) - planes.begin()));
        }
    }

    /// Unit face of the grid: `plane` along `axis`, cells j and k along the two axes after it.
    std::size_t face_index(int axis, int plane, int j, int k) const {
        return (at(plane) * at(cells_along((axis + 1) % 3)) + at(j)) * at(cells_along((axis + 2) % 3)) +
               at(k);
    }
    int chart_at(int axis, int plane, int j, int k) const {
        if (j < 0 || k < 0 || j >= cells_along((axis + 1) % 3) || k >= cells_along((axis + 2) % 3)) return -1;
        return chart_of_face_[at(axis)][face_index(axis, plane, j, k)];
    }

    /// Which chart covers each unit face: winding numbers of the charts' polygons.
    void cover_faces() {
        for (int axis = 0; axis < 3; ++axis)
            chart_of_face_[at(axis)].assign(result_.planes[at(axis)].size() *
                                                at(cells_along((axis + 1) % 3)) *
                                                at(cells_along((axis + 2) % 3)),
                                            -1);
        for (std::size_t c = 0; c < graph_.charts.size(); ++c) cover(static_cast<int>(c));
    }

    void cover(int chart) {
        const int axis = axis_of(label(chart));
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        const int nu = cells_along(u);
        const int nv = cells_along(v);
        std::vector<int> winding(at(nu) * at(nv), 0);
        for (const auto& loop : graph_.charts[at(chart)].loops) {
            for (const SideUse& use : loop) {
                const ChartSide& side = graph_.sides[at(use.side)];
                if (side.axis != v) continue;
                const int from = plane(side.ends[use.reversed ? 1 : 0]);
                const int to = plane(side.ends[use.reversed ? 0 : 1]);
                const int neighbour = side.charts[use.reversed ? 0 : 1];
                for (int i = 0; i < plane(neighbour); ++i)
                    for (int j = std::min(from, to); j < std::max(from, to); ++j)
                        winding[at(i) * at(nv) + at(j)] += to > from ? 1 : -1;
            }
        }
        for (int i = 0; i < nu; ++i) {
            for (int j = 0; j < nv; ++j) {
                const int w = winding[at(i) * at(nv) + at(j)] * sign_of(label(chart));
                if (w == 0) continue;
                if (w != 1) {
                    conflict(chart, chart);
                    return;
                }
                int& owner = chart_of_face_[at(axis)][face_index(axis, plane(chart), i, j)];
                if (owner >= 0) conflict(owner, chart);
                owner = chart;
            }
        }
    }

    std::size_t cell_index(const Index& c) const {
        return (at(c[0]) * at(cells_along(1)) + at(c[1])) * at(cells_along(2)) + at(c[2]);
    }
    bool inside(const Index& c) const {
        for (int a = 0; a < 3; ++a)
            if (c[at(a)] < 0 || c[at(a)] >= cells_along(a)) return false;
        return inside_[cell_index(c)] != 0;
    }
    template <class Body>
    void for_each_inside(const Body& body) const {
        for (int i = 0; i < cells_along(0); ++i)
            for (int j = 0; j < cells_along(1); ++j)
                for (int k = 0; k < cells_along(2); ++k)
                    if (inside_[cell_index({i, j, k})]) body(Index{i, j, k});
    }

    /// Walks along x through every column: in at -X faces, out at +X faces.
    void fill() {
        inside_.assign(at(cells_along(0)) * at(cells_along(1)) * at(cells_along(2)), 0);
        for (int j = 0; j < cells_along(1); ++j) {
            for (int k = 0; k < cells_along(2); ++k) {
                int depth = 0;
                int last = -1;
                for (int i = 0; i <= cells_along(0); ++i) {
                    const int chart = chart_at(0, i, j, k);
                    if (chart >= 0) {
                        depth -= sign_of(label(chart));
                        if (depth < 0 || depth > 1) {
                            conflict(std::max(last, 0), chart);
                            depth = std::clamp(depth, 0, 1);
                        }
                        last = chart;
                    }
                    if (depth == 1 && i < cells_along(0)) {
                        inside_[cell_index({i, j, k})] = 1;
                        ++result_.cells;
                    }
                }
            }
        }
        if (result_.conflicts.empty()) check_faces();
    }

    /// Every unit face between inside and outside must be covered, and no other.
    void check_faces() {
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            for (int p = 0; p <= cells_along(axis); ++p) {
                for (int j = 0; j < cells_along(u); ++j) {
                    for (int k = 0; k < cells_along(v); ++k) {
                        Index above{};
                        above[at(axis)] = p;
                        above[at(u)] = j;
                        above[at(v)] = k;
                        const bool in_above = inside(above);
                        const bool in_below = inside(step(above, axis, -1));
                        const int chart = chart_at(axis, p, j, k);
                        const bool expected =
                            chart >= 0 &&
                            (sign_of(label(chart)) > 0 ? in_below && !in_above : in_above && !in_below);
                        if (chart >= 0 ? !expected : in_above != in_below)
                            conflict(std::max(chart, 0), std::max(chart, 0));
                    }
                }
            }
        }
    }

    /// Corner (0 or 1 along each axis) of an inside cell, before corners are joined.
    std::size_t corner_slot(const Index& cell, const Index& offset) const {
        return 8 * cell_index(cell) + at(4 * offset[0] + 2 * offset[1] + offset[2]);
    }
    int corner_class(const Index& cell, const Index& position) {
        return static_cast<int>(corners_.root(
            corner_slot(cell, {position[0] - cell[0], position[1] - cell[1], position[2] - cell[2]})));
    }

    /// Cells that share a face share its four corners; cells that only touch do not.
    void join_corners() {
        corners_ = Components(8 * inside_.size());
        for_each_inside([&](const Index& cell) {
            for (int axis = 0; axis < 3; ++axis) {
                const Index next = step(cell, axis, 1);
                if (!inside(next)) continue;
                for (int j = 0; j < 2; ++j) {
                    for (int k = 0; k < 2; ++k) {
                        Index offset{};
                        offset[at((axis + 1) % 3)] = j;
                        offset[at((axis + 2) % 3)] = k;
                        Index far = offset;
                        far[at(axis)] = 1;
                        corners_.join(corner_slot(cell, far), corner_slot(next, offset));
                    }
                }
            }
        });
    }

    /// A wall between `cell` and the next one along `axis`.
    char& wall(const Index& cell, int axis) { return walls_[3 * cell_index(cell) + at(axis)]; }

    void put_wall(const Index& cell, int axis) {
        if (wall(cell, axis)) return;
        wall(cell, axis) = 1;
        open_walls_.push_back({cell, axis});
    }

    /// Around a concave edge three of the four cells are inside; both faces between them are walls.
    void mark_walls() {
        walls_.assign(3 * inside_.size(), 0);
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            for (int i = 1; i < cells_along(u); ++i) {
                for (int j = 1; j < cells_along(v); ++j) {
                    for (int k = 0; k < cells_along(axis); ++k) {
                        Index c00{};
                        c00[at(axis)] = k;
                        c00[at(u)] = i - 1;
                        c00[at(v)] = j - 1;
                        const Index c10 = step(c00, u, 1);
                        const Index c01 = step(c00, v, 1);
                        const Index c11 = step(c10, v, 1);
                        const int count = inside(c00) + inside(c10) + inside(c01) + inside(c11);
                        if (count != 3) continue;
                        if (inside(c00) && inside(c10)) put_wall(c00, u);
                        if (inside(c01) && inside(c11)) put_wall(c01, u);
                        if (inside(c00) && inside(c01)) put_wall(c00, v);
                        if (inside(c10) && inside(c11)) put_wall(c10, v);
                    }
                }
            }
        }
    }

    /// A wall goes on straight across every edge that has four cells inside.
    void flood_walls() {
        while (!open_walls_.empty()) {
            const auto [cell, axis] = open_walls_.back();
            open_walls_.pop_back();
            const Index behind = step(cell, axis, 1);
            for (int other = 0; other < 3; ++other) {
                if (other == axis) continue;
                for (const int way : {-1, 1}) {
                    const Index next = step(cell, other, way);
                    if (inside(next) && inside(step(behind, other, way))) put_wall(next, axis);
                }
            }
        }
    }

    void join_cells() {
        Components blocks(inside_.size());
        for_each_inside([&](const Index& cell) {
            for (int axis = 0; axis < 3; ++axis) {
                const Index next = step(cell, axis, 1);
                if (inside(next) && !wall(cell, axis)) blocks.join(cell_index(cell), cell_index(next));
            }
        });
        struct Box {
            Index low;
            Index high;
            std::size_t cells = 0;
        };
        std::map<std::size_t, Box> boxes;
        for_each_inside([&](const Index& cell) {
            auto [entry, fresh] = boxes.try_emplace(blocks.root(cell_index(cell)), Box{cell, cell, 0});
            Box& box = entry->second;
            ++box.cells;
            for (std::size_t a = 0; a < 3; ++a) {
                box.low[a] = std::min(box.low[a], cell[a]);
                box.high[a] = std::max(box.high[a], cell[a]);
            }
        });
        for (const auto& [root, box] : boxes) {
            std::size_t volume = 1;
            for (std::size_t a = 0; a < 3; ++a) volume *= at(box.high[a] - box.low[a] + 1);
            if (volume != box.cells) throw Error(ErrorKind::no_result, "a block of the polycube is no box");
            std::array<int, 8> block{};
            for (std::size_t k = 0; k < 8; ++k) {
                const auto& uvw = hexahedron::corner_uvw[k];
                Index cell{};
                Index position{};
                for (std::size_t a = 0; a < 3; ++a) {
                    cell[a] = uvw[a] ? box.high[a] : box.low[a];
                    position[a] = cell[a] + uvw[a];
                }
                block[k] = vertex_of(corner_class(cell, position), position);
            }
            result_.blocks.push_back(block);
        }
    }

    int vertex_of(int corner_class, const Index& position) {
        const auto [entry, fresh] =
            vertex_of_class_.try_emplace(corner_class, static_cast<int>(result_.positions.size()));
        if (fresh) result_.positions.push_back(position);
        return entry->second;
    }

    /// The cell inside behind a unit face of a chart.
    Index cell_behind(int chart, int j, int k) const {
        const int axis = axis_of(label(chart));
        Index cell{};
        cell[at(axis)] = plane(chart) - (sign_of(label(chart)) > 0 ? 1 : 0);
        cell[at((axis + 1) % 3)] = j;
        cell[at((axis + 2) % 3)] = k;
        return cell;
    }

    /// The class of a grid position on a side, seen from the chart on one side of the unit edge that starts
    /// (ends, for `before`) there; -1 when the chart does not cover the face beside that edge.
    int side_class(const ChartSide& side, std::size_t which, int k, bool before) {
        const int chart = side.charts[which];
        const int other = side.charts[1 - which];
        const int axis = axis_of(label(chart));
        const int across = axis_of(label(other));
        // Left of the direction of travel, seen from outside, is normal x direction.
        const int cyclic = (axis + 1) % 3 == side.axis ? 1 : -1;
        const int left = sign_of(label(chart)) * cyclic * side.direction * (which == 0 ? 1 : -1);
        Index face{};
        face[at(side.axis)] = before == (side.direction > 0) ? k - 1 : k;
        face[at(across)] = left > 0 ? plane(other) : plane(other) - 1;
        const int j = face[at((axis + 1) % 3)];
        const int i = face[at((axis + 2) % 3)];
        if (chart_at(axis, plane(chart), j, i) != chart) return -1;
        Index position{};
        position[at(axis)] = plane(chart);
        position[at(across)] = plane(other);
        position[at(side.axis)] = k;
        return corner_class(cell_behind(chart, j, i), position);
    }

    void collect_sides() {
        std::map<int, int> class_of_corner;  // by surface vertex
        for (std::size_t s = 0; s < graph_.sides.size(); ++s) {
            const ChartSide& side = graph_.sides[s];
            auto& nodes = result_.side_nodes.emplace_back();
            const int from = plane(side.ends[0]);
            const int to = plane(side.ends[1]);
            for (int k = from;; k += side.direction) {
                std::set<int> classes;
                for (std::size_t which = 0; which < 2; ++which) {
                    if (k != from) classes.insert(side_class(side, which, k, true));
                    if (k != to) classes.insert(side_class(side, which, k, false));
                }
                if (classes.size() != 1 || *classes.begin() < 0) {
                    conflict(side.charts[0], side.charts[1]);
                    return;
                }
                const int here = *classes.begin();
                if (k == from || k == to) {
                    const int corner = k == from ? side.chain.front() : side.chain.back();
                    const auto [entry, fresh] = class_of_corner.emplace(corner, here);
                    if (entry->second != here || !vertex_of_class_.contains(here)) {
                        conflict(side.charts[0], side.charts[1]);
                        return;
                    }
                }
                boundary_classes_.insert(here);
                // A corner is known by its vertex, other places by their side.
                const int place = k == from ? side.chain.front()
                                  : k == to ? side.chain.back()
                                            : -1 - static_cast<int>(s);
                if (!claim(here, place, side)) return;
                const auto found = vertex_of_class_.find(here);
                if (found != vertex_of_class_.end()) nodes.push_back({k, found->second});
                if (k == to) break;
            }
        }
    }

    /// Different places of the surface must not meet in one vertex of the grid. Conflict when they do.
    bool claim(int corner_class, int place, const ChartSide& side) {
        const auto [entry, fresh] = claims_.try_emplace(corner_class, Claim{place, side.charts});
        if (entry->second.place == place) return true;
        for (const int one : entry->second.charts)
            for (const int other : side.charts) conflict(one, other);
        return false;
    }

    /// Lines of a chart: unit edges between two of its faces with a wall behind them.
    void collect_segments(int chart) {
        const int axis = axis_of(label(chart));
        for (const int along : {(axis + 1) % 3, (axis + 2) % 3}) {
            const int across = third_axis(axis, along);
            for (int p = 1; p < cells_along(across); ++p) {
                ChartSegment segment;
                bool open = false;
                for (int k = 0; k < cells_along(along); ++k) {
                    if (!wall_behind(chart, along, across, p, k)) {
                        if (open) fail_line(chart);
                        continue;
                    }
                    if (!open) {
                        segment = {along, p, {k, k}, {line_vertex(chart, along, across, p, k, k), -1}, {}};
                        open = true;
                        if (!boundary_classes_.contains(last_class_)) fail_line(chart);
                    }
                    const int vertex = line_vertex(chart, along, across, p, k, k + 1);
                    if (boundary_classes_.contains(last_class_)) {
                        segment.ends[1] = k + 1;
                        segment.vertices[1] = vertex;
                        result_.segments[at(chart)].push_back(segment);
                        open = false;
                    } else if (vertex >= 0) {
                        segment.crossings.push_back({k + 1, vertex});
                        const auto [entry, fresh] = crossing_chart_.emplace(vertex, chart);
                        if (entry->second != chart) conflict(entry->second, chart);
                    }
                }
                if (open) fail_line(chart);
            }
        }
    }

    [[noreturn]] void fail_line(int chart) const {
        throw Error(ErrorKind::no_result,
                    "a block line ends inside chart " + std::to_string(chart) + " of the polycube");
    }

    /// Faces k along `along` on both sides of plane p of `across` belong to the chart, and a wall parts the
    /// cells behind them.
    bool wall_behind(int chart, int along, int across, int p, int k) {
        const Index below = line_cell(chart, along, across, p - 1, k);
        const Index above = line_cell(chart, along, across, p, k);
        const int axis = axis_of(label(chart));
        const auto covered = [&](const Index& cell) {
            return chart_at(axis, plane(chart), cell[at((axis + 1) % 3)], cell[at((axis + 2) % 3)]) == chart;
        };
        return covered(below) && covered(above) && wall(below, across) != 0;
    }
    Index line_cell(int chart, int along, int across, int j, int k) const {
        const int axis = axis_of(label(chart));
        Index face{};
        face[at(across)] = j;
        face[at(along)] = k;
        return cell_behind(chart, face[at((axis + 1) % 3)], face[at((axis + 2) % 3)]);
    }
    /// The block vertex at plane `position` of `along`, or -1; notes the corner class.
    int line_vertex(int chart, int along, int across, int p, int k, int position) {
        Index place{};
        place[at(axis_of(label(chart)))] = plane(chart);
        place[at(across)] = p;
        place[at(along)] = position;
        last_class_ = corner_class(line_cell(chart, along, across, p, k), place);
        const auto found = vertex_of_class_.find(last_class_);
        return found == vertex_of_class_.end() ? -1 : found->second;
    }

    const ChartGraph& graph_;
    const std::vector<int>& coordinates_;
    BlockComplex result_;
    std::array<std::vector<int>, 3> chart_of_face_;
    std::vector<char> inside_;
    Components corners_{0};
    struct OpenWall {
        Index cell;
        int axis;
    };
    std::vector<char> walls_;
    std::vector<OpenWall> open_walls_;
    struct Claim {
        int place = 0;
        std::array<int, 2> charts = {-1, -1};
    };
    std::map<int, Claim> claims_;
    std::map<int, int> vertex_of_class_;
    std::map<int, int> crossing_chart_;  ///< by block vertex
    std::set<int> boundary_classes_;
    int last_class_ = -1;
};

}  // namespace

BlockComplex build_blocks(const ChartGraph& graph, const std::vector<int>& coordinates) {
    return Builder(graph, coordinates).build();
}

}  // namespace hex
