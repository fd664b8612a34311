#include "polycube/bodies.h"
#include "polycube/voxel_target.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/polycube/voxel.h>
#include <hex/surface/polygon_soup.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

namespace hex {
namespace {

using voxels::Cell;
using voxels::CellSet;
using voxels::Grid;
using voxels::samples_per_cell;
using voxels::Target;

/// Cells are no larger than this share of the diagonal unless the caller says so.
constexpr double largest_cell = 1.0 / 30.0;
/// And no larger than this share of that of their own body.
constexpr double largest_of_body = 1.0 / 6.0;
/// From try to try cells get smaller by this factor.
constexpr double shrink = 0.88;
/// A cell is taken when it has at least so many samples inside. The second and third are tried when the
/// first gives another topology: thin walls want the one, thin gaps the other.
constexpr std::array<int, 3> thresholds = {14, 9, 19};
/// Surface farther from the boundary of the cells than this share of their size is followed by single cells.
constexpr double reach = 0.5;
/// Distance of the points at which that is asked, in shares of the cell size.
constexpr double point_spacing = 0.5;
constexpr int most_passes = 60;
/// Cells that leave parts of the surface farther away than this share of their size are too large.
constexpr double too_far = 1.0;

std::string text_of(const Vec3& p) {
    char text[96];
    std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", p.x(), p.y(), p.z());
    return text;
}

/// Points of the surface not farther apart than `spacing`.
std::vector<Vec3> points_on(const TriangleMesh& surface, double spacing) {
    std::vector<Vec3> points;
    for (const auto f : surface.faces()) {
        std::array<Vec3, 3> p;
        std::size_t i = 0;
        for (const auto v : surface.fv_range(f)) p[i++] = to_eigen(surface.point(v));
        const double longest = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
        const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, 400);
        for (int a = 0; a <= n; ++a)
            for (int b = 0; a + b <= n; ++b)
                points.push_back(p[0] + (p[1] - p[0]) * a / n + (p[2] - p[0]) * b / n);
    }
    return points;
}

/// Distance of a point in cell c to the nearest cell of the other kind among its 26 neighbours, infinite if
/// there is none.
double distance_to_other(const CellSet& cells, const Cell& c, const Vec3& p) {
    const Grid& grid = cells.grid();
    const bool own = cells.taken(grid.index(c));
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 27; ++k) {
        const Cell n = {c[0] - 1 + k % 3, c[1] - 1 + k / 3 % 3, c[2] - 1 + k / 9};
        bool within = true;
        for (std::size_t axis = 0; axis < 3; ++axis) within &= n[axis] >= 0 && n[axis] < grid.count(axis);
        if (!within || cells.taken(grid.index(n)) == own) continue;
        const Vec3 low = grid.node(n);
        const Vec3 high = grid.node({n[0] + 1, n[1] + 1, n[2] + 1});
        nearest = std::min(nearest, (p - p.cwiseMax(low).cwiseMin(high)).norm());
    }
    return nearest;
}

/// Largest distance of the points to the boundary of the cells; points without a cell of the other kind
/// around theirs count as two cells away.
double distance_to_boundary(const CellSet& cells, const std::vector<Vec3>& points, double size) {
    return parallel_reduce(
        points.size(), 0.0,
        [&](double most, std::size_t i) {
            const Cell c = cells.grid().find(points[i]);
            return std::max(most, std::min(2.0 * size, distance_to_other(cells, c, points[i])));
        },
        [](double a, double b) { return std::max(a, b); });
}

/// One grid, from its samples to cells that may be right.
struct Try {
    Grid grid;
    std::vector<std::uint8_t> shares;
    std::optional<CellSet> cells;
    VoxelReport report;
    std::string problem;  ///< empty: the cells are right
    std::string place;
};

bool repair(Try& attempt) {
    const int changed = attempt.cells->repair(attempt.shares);
    if (changed < 0) {
        attempt.problem = "no manifold boundary was found";
        return false;
    }
    attempt.report.repairs += static_cast<std::size_t>(changed);
    return true;
}

/// Removes pieces of cells, and fills cavities, that stand for no component of the surface.
void drop_specks(Try& attempt, const Target& target) {
    CellSet& cells = *attempt.cells;
    for (;;) {
        const voxels::Pieces pieces = cells.pieces();
        const voxels::Correspondence found = voxels::correspond(cells, pieces, target);
        std::vector<int> degree(static_cast<std::size_t>(pieces.count), 0);
        for (const auto& b : pieces.boundaries) {
            ++degree[static_cast<std::size_t>(b.inner)];
            ++degree[static_cast<std::size_t>(b.outer)];
        }
        std::vector<char> doomed(static_cast<std::size_t>(pieces.count), 0);
        bool any = false;
        for (std::size_t b = 0; b < pieces.boundaries.size(); ++b) {
            if (found.component[b] >= 0) continue;
            const auto inner = static_cast<std::size_t>(pieces.boundaries[b].inner);
            const auto outer = static_cast<std::size_t>(pieces.boundaries[b].outer);
            const std::size_t leaf = degree[inner] == 1 ? inner : outer;
            if (leaf == 0 || degree[leaf] != 1) continue;
            doomed[leaf] = 1;
            any = true;
        }
        if (!any) return;
        for (std::size_t i = 0; i < pieces.piece.size(); ++i) {
            if (!doomed[static_cast<std::size_t>(pieces.piece[i])]) continue;
            cells.flip(i);
            ++attempt.report.specks;
        }
    }
}

/// Follows parts of the surface that are far from the boundary, a simple cell at a time.
void follow_thin_parts(Try& attempt, const std::vector<Vec3>& points, double size) {
    CellSet& cells = *attempt.cells;
    const Grid& grid = attempt.grid;
    std::vector<std::size_t> home(points.size());
    parallel_for(points.size(), [&](std::size_t i) { home[i] = grid.index(grid.find(points[i])); });
    std::vector<char> settled(grid.cell_count(), 0);
    for (int pass = 0; pass < most_passes; ++pass) {
        std::vector<char> far(points.size(), 0);
        parallel_for(points.size(), [&](std::size_t i) {
            far[i] = distance_to_other(cells, grid.cell(home[i]), points[i]) > reach * size;
        });
        std::vector<std::size_t> candidates;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (far[i]) candidates.push_back(home[i]);
        std::sort(candidates.begin(), candidates.end());
        candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
        std::size_t changed = 0;
        for (const std::size_t c : candidates) {
            if (settled[c] || !cells.simple(grid.cell(c))) continue;
            settled[c] = 1;  // or a sheet of surface between two cells would move them for ever
            ++(cells.taken(c) ? attempt.report.carved : attempt.report.grown);
            cells.flip(c);
            ++changed;
        }
        if (changed == 0) return;
    }
}

/// A place where one cell more or less makes another topology: the one whose share is nearest to one half.
std::string critical_place(const Try& attempt) {
    const CellSet& cells = *attempt.cells;
    int best = samples_per_cell;
    std::string place;
    for (std::size_t i = 0; i < attempt.shares.size(); ++i) {
        const int share = attempt.shares[i];
        if (share == 0 || share == samples_per_cell) continue;
        const int off = std::abs(2 * share - samples_per_cell);
        const Cell c = attempt.grid.cell(i);
        if (off >= best || !cells.changeable(c) || cells.simple(c)) continue;
        best = off;
        place = text_of(0.5 * (attempt.grid.node(c) + attempt.grid.node({c[0] + 1, c[1] + 1, c[2] + 1})));
    }
    return place;
}

void compare(Try& attempt, const Target& target) {
    const voxels::Pieces pieces = attempt.cells->pieces();
    const voxels::Correspondence found = voxels::correspond(*attempt.cells, pieces, target);
    for (std::size_t s = 0; s < target.size(); ++s) {
        const int b = found.boundary[s];
        if (b < 0) {
            const BoundingBox& box = target.box(s);
            attempt.problem = "component " + std::to_string(s) + " of the surface is thinner than a cell";
            attempt.place = text_of(0.5 * (box.lower + box.upper));
            return;
        }
        const int euler = pieces.boundaries[static_cast<std::size_t>(b)].euler_characteristic();
        if (euler == target.euler(s)) continue;
        attempt.problem = "component " + std::to_string(s) + " of the surface has " +
                          std::to_string((2 - target.euler(s)) / 2) + " handles, its cells " +
                          std::to_string((2 - euler) / 2);
        attempt.place = critical_place(attempt);
        return;
    }
    if (pieces.boundaries.size() != target.size()) {
        attempt.problem = "the cells have " + std::to_string(pieces.boundaries.size()) +
                          " boundaries, the surface has " + std::to_string(target.size()) + " components";
        attempt.place = critical_place(attempt);
        return;
    }
    for (const auto& b : pieces.boundaries) attempt.report.euler_characteristic += b.euler_characteristic();
    attempt.report.surfaces = pieces.boundaries.size();
}

void fill(Try& attempt, const Target& target, const std::vector<Vec3>& points, double size, int threshold) {
    attempt.report.repairs = attempt.report.specks = attempt.report.grown = attempt.report.carved = 0;
    attempt.report.euler_characteristic = 0;
    attempt.problem.clear();
    attempt.place.clear();
    std::vector<char> taken(attempt.shares.size());
    for (std::size_t i = 0; i < taken.size(); ++i) taken[i] = attempt.shares[i] >= threshold;
    attempt.cells.emplace(attempt.grid, std::move(taken));
    if (!repair(attempt)) return;
    drop_specks(attempt, target);
    compare(attempt, target);
    if (!attempt.problem.empty()) return;
    attempt.report.euler_characteristic = 0;
    follow_thin_parts(attempt, points, size);
    compare(attempt, target);
    attempt.report.distance = distance_to_boundary(*attempt.cells, points, size);
}

HexMesh to_mesh(const CellSet& cells) {
    const Grid& grid = cells.grid();
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> number(grid.node_count(), none);
    std::vector<Vec3> positions;
    std::vector<HexCell> hexes;
    for (std::size_t i = 0; i < grid.cell_count(); ++i) {
        if (!cells.taken(i)) continue;
        const Cell c = grid.cell(i);
        HexCell hex;
        for (std::size_t k = 0; k < 8; ++k) {
            const auto& uvw = hexahedron::corner_uvw[k];
            const Cell node = {c[0] + uvw[0], c[1] + uvw[1], c[2] + uvw[2]};
            std::size_t& n = number[grid.node_index(node)];
            if (n == none) {
                n = positions.size();
                positions.push_back(grid.node(node));
            }
            hex[k] = VertexId(n);
        }
        hexes.push_back(hex);
    }
    return {std::move(positions), std::move(hexes)};
}

std::size_t with_layer(const CellSet& cells) {
    std::size_t count = cells.size();
    for (const auto& b : cells.pieces().boundaries) count += b.faces;
    return count;
}

/// The cell size at which a solid of this volume and area has about so many cells, layer included.
double size_for(std::size_t cells, double volume, double area, double diagonal) {
    double low = 1e-4 * diagonal;
    double high = largest_cell * diagonal;
    for (int i = 0; i < 60; ++i) {
        const double middle = std::sqrt(low * high);
        // The boundary of a set of cells is about 1.5 times as large as the surface.
        const double count = volume / (middle * middle * middle) + 1.5 * area / (middle * middle);
        (count > static_cast<double>(cells) ? low : high) = middle;
    }
    return high;
}

double area_of(const TriangleMesh& surface) {
    double area = 0.0;
    for (const auto f : surface.faces()) area += surface.calc_face_area(f);
    return area;
}

/// The volume of the solid, whatever the orientation of its shells.
double volume_of(const TriangleMesh& surface, double diagonal) {
    const Grid grid = voxels::make_grid(surface, largest_cell * diagonal);
    const std::vector<std::uint8_t> shares = voxels::samples_inside(grid, surface);
    double volume = 0.0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        if (shares[i] == 0) continue;
        const Cell c = grid.cell(i);
        volume +=
            (grid.node({c[0] + 1, c[1] + 1, c[2] + 1}) - grid.node(c)).prod() * shares[i] / samples_per_cell;
    }
    return volume;
}

VoxelResult build_body(const TriangleMesh& surface, double size, const VoxelOptions& options,
                       const Context& context) {
    const Target target(surface);
    std::optional<VoxelResult> best;
    std::size_t tries = 0;
    for (;; size *= shrink) {
        context.check_cancelled();
        Try attempt;
        attempt.grid = voxels::make_grid(surface, size);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            attempt.report.grid[axis] = attempt.grid.count(axis) - 2;
            attempt.report.planes[axis] = attempt.grid.aligned[axis];
        }
        attempt.report.cell_size = size;
        attempt.shares = voxels::samples_inside(attempt.grid, surface);
        const std::vector<Vec3> points = points_on(surface, point_spacing * size);
        std::string problem;
        std::string place;
        std::size_t count = 0;
        for (const int threshold : thresholds) {
            ++tries;
            fill(attempt, target, points, size, threshold);
            count = with_layer(*attempt.cells);
            if (!attempt.problem.empty()) {
                if (problem.empty() || place.empty()) {
                    problem = attempt.problem;
                    place = attempt.place;
                }
                continue;
            }
            if (best && best->report.distance <= attempt.report.distance) continue;
            if (best && count > options.most_cells_for_distance) continue;
            attempt.report.cells = attempt.cells->size();
            best.emplace(VoxelResult{to_mesh(*attempt.cells), attempt.report});
            if (attempt.report.distance <= too_far * size) break;
        }
        context.log(LogLevel::debug,
                    "voxel: cells of size " + std::to_string(size) + ", " + std::to_string(count) +
                        " with a layer; " + (problem.empty() ? std::string("topology right") : problem) +
                        (best ? ", best distance " + std::to_string(best->report.distance / size) + " cells"
                              : std::string()));
        const bool grown_enough =
            static_cast<double>(count) >
            std::pow(shrink, 2.5) *
                static_cast<double>(best ? options.most_cells_for_distance : options.most_cells);
        if (best && (best->report.distance <= too_far * best->report.cell_size || grown_enough)) {
            best->report.tries = tries;
            return std::move(*best);
        }
        if (grown_enough)
            throw Error(ErrorKind::no_result,
                        "no grid of up to " + std::to_string(options.most_cells) +
                            " cells has the topology of the surface: with cells of size " +
                            std::to_string(size) + ", " + problem,
                        place.empty() ? std::string() : "near " + place,
                        "allow more cells, or thicken what is thinner than a cell there");
    }
}

/// The cells of another body, which have nothing in common with those that are there.
void append(VoxelResult& all, const VoxelResult& body) {
    std::vector<Vec3> positions(all.cells.positions().begin(), all.cells.positions().end());
    std::vector<HexCell> cells(all.cells.cell_array().begin(), all.cells.cell_array().end());
    for (HexCell cell : body.cells.cell_array()) {
        for (VertexId& v : cell) v = VertexId(v.index() + positions.size());
        cells.push_back(cell);
    }
    positions.insert(positions.end(), body.cells.positions().begin(), body.cells.positions().end());
    all.cells = HexMesh(std::move(positions), std::move(cells));
    VoxelReport& report = all.report;
    report.cell_size = std::min(report.cell_size, body.report.cell_size);
    report.cells += body.report.cells;
    report.tries += body.report.tries;
    report.repairs += body.report.repairs;
    report.specks += body.report.specks;
    report.grown += body.report.grown;
    report.carved += body.report.carved;
    report.distance = std::max(report.distance, body.report.distance);
    report.bodies += body.report.bodies;
    report.surfaces += body.report.surfaces;
    report.euler_characteristic += body.report.euler_characteristic;
}

/// Refuses grids that would not end.
void require_bearable(const TriangleMesh& surface, double size) {
    constexpr double most_cells = 2e8;
    const BoundingBox box = bounding_box(surface);
    const double cells = ((box.upper - box.lower) / size).array().max(1.0).prod();
    if (cells > most_cells)
        throw Error(
            ErrorKind::unsupported,
            "so small cells make a grid of more than " + std::to_string(static_cast<std::size_t>(most_cells)),
            {}, "choose larger cells");
}

VoxelResult build(const TriangleMesh& surface, const VoxelOptions& options, const Context& context) {
    const std::vector<Body> bodies = bodies_of(surface);
    double volume = 0.0;
    for (const Body& body : bodies) {
        const BoundingBox box = bounding_box(body.surface);
        if (!((box.upper - box.lower).minCoeff() > 1e-9 * box.diagonal()))
            throw Error(ErrorKind::bad_input, "a component of the surface is flat",
                        "near " + text_of(0.5 * (box.lower + box.upper)), "give one that encloses a volume");
        volume += volume_of(body.surface, box.diagonal());
    }
    const double size = options.cell_size > 0.0 ? options.cell_size
                                                : size_for(options.target_cells, volume, area_of(surface),
                                                           bounding_box(surface).diagonal());
    for (const Body& body : bodies) require_bearable(body.surface, size);
    std::optional<VoxelResult> all;
    std::size_t most_cells = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        context.progress("voxel", static_cast<double>(b) / static_cast<double>(bodies.size()));
        const double largest = largest_of_body * bounding_box(bodies[b].surface).diagonal();
        VoxelResult one = build_body(bodies[b].surface, std::min(size, largest), options, context);
        const bool largest_yet =
            one.report.cells > std::exchange(most_cells, std::max(most_cells, one.report.cells));
        if (!all) {
            all.emplace(std::move(one));
            continue;
        }
        append(*all, one);
        if (largest_yet) {
            all->report.grid = one.report.grid;
            all->report.planes = one.report.planes;
        }
    }
    return std::move(*all);
}

}  // namespace

VoxelResult voxel_blocks(const TriangleMesh& surface, const VoxelOptions& options, const Context& context) {
    if (surface.n_faces() == 0) throw Error(ErrorKind::bad_input, "the surface has no triangles");
    if (!(options.cell_size >= 0.0) || !std::isfinite(options.cell_size))
        throw Error(ErrorKind::usage, "the cell size is negative or no number", {},
                    "give 0 for one found automatically");
    if (options.target_cells == 0 || options.most_cells == 0)
        throw Error(ErrorKind::usage, "the number of cells is zero");
    return with_threads(context, [&] { return build(surface, options, context); });
}

}  // namespace hex
