#include "stages.h"

#include "support/test_files.h"

#include <hex/base/parallel.h>
#include <hex/improve/improve.h>
#include <hex/io/hex_file.h>
#include <hex/io/surface_file.h>
#include <hex/map/map.h>
#include <hex/polycube/polycube.h>
#include <hex/quality/scaled_jacobian.h>
#include <hex/segment/segment.h>
#include <hex/surface/polygon_soup.h>
#include <hex/volume/topology.h>
#include <spline/io/bext.h>
#include <spline/spline.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <random>
#include <tuple>

namespace bench {
namespace {

struct GridArrays {
    std::vector<hex::Vec3> points;
    std::vector<hex::HexCell> cells;
};

/// n x n x n cubes. In random order, cells and vertices, they are what a mesh from elsewhere may look like.
enum class Order { natural, random };
GridArrays make_grid(int n, Order order) {
    GridArrays grid;
    const auto m = static_cast<std::size_t>(n) + 1;
    std::mt19937 random(1);
    std::vector<std::size_t> number(m * m * m);
    std::iota(number.begin(), number.end(), std::size_t{0});
    if (order == Order::random) std::shuffle(number.begin(), number.end(), random);
    grid.points.resize(number.size());
    grid.cells.reserve((m - 1) * (m - 1) * (m - 1));
    const auto at = [&](std::size_t i, std::size_t j, std::size_t k) { return number[i + m * (j + m * k)]; };
    for (std::size_t k = 0; k < m; ++k)
        for (std::size_t j = 0; j < m; ++j)
            for (std::size_t i = 0; i < m; ++i) {
                grid.points[at(i, j, k)] =
                    hex::Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
                if (i + 1 == m || j + 1 == m || k + 1 == m) continue;
                hex::HexCell cell;
                for (std::size_t c = 0; c < 8; ++c) {
                    const auto& uvw = hex::hexahedron::corner_uvw[c];
                    cell[c] = hex::VertexId(at(i + static_cast<std::size_t>(uvw[0]),
                                               j + static_cast<std::size_t>(uvw[1]),
                                               k + static_cast<std::size_t>(uvw[2])));
                }
                grid.cells.push_back(cell);
            }
    if (order == Order::random) std::shuffle(grid.cells.begin(), grid.cells.end(), random);
    return grid;
}

hex::HexMesh grid_mesh(int n, Order order) {
    GridArrays grid = make_grid(n, order);
    return {std::move(grid.points), std::move(grid.cells)};
}

hex::HexMesh shuffled_grid_mesh(int n) {
    return grid_mesh(n, Order::random);
}

std::filesystem::path part_file(const std::string& part, const std::string& ending) {
    return hex::test::own_data() / part / (part + ending);
}

hex::TriangleMesh load_surface(const std::string& part, const std::string& ending) {
    return hex::make_triangle_mesh(hex::io::read_surface(part_file(part, ending)).soup);
}

/// The sample part as `map` makes it.
hex::HexMesh mapped(const std::string& part, int level, const hex::Context& context) {
    hex::MapOptions options;
    options.level = level;
    return hex::map(load_surface(part, "_patches.k"),
                    hex::io::read_hex_mesh(part_file(part, "_blocks.k")).mesh, options, context)
        .mesh;
}

Stage structure_stage(const std::string& what, int threads, int n,
                      const std::function<void(const hex::HexMesh&)>& body) {
    return {what, "shuffled grid " + std::to_string(n) + "^3", [=] {
                hex::Context context;
                context.threads = threads;
                return hex::with_threads(context, [&] {
                    const hex::HexMesh mesh = shuffled_grid_mesh(n);
                    return Work{mesh.cell_count(), seconds_of([&] { body(mesh); })};
                });
            }};
}

void add_structures(std::vector<Stage>& all, const hex::Context& context, int n) {
    Stage build{"HexMesh", "shuffled grid " + std::to_string(n) + "^3", [=] {
                    return hex::with_threads(context, [&] {
                        GridArrays grid = make_grid(n, Order::random);
                        const std::size_t count = grid.cells.size();
                        return Work{count, seconds_of([&] {
                                        const hex::HexMesh mesh(std::move(grid.points),
                                                                std::move(grid.cells));
                                    })};
                    });
                }};
    if (n == 100) {
        build.most_seconds = 2;
        build.most_megabytes = 500;
    }
    all.push_back(build);
    all.push_back(structure_stage("edge_table", context.threads, n,
                                  [](const hex::HexMesh& mesh) { hex::edge_table(mesh); }));
    all.push_back(structure_stage("boundary_quads", context.threads, n,
                                  [](const hex::HexMesh& mesh) { hex::boundary_quads(mesh); }));
    for (const Order order : {Order::natural, Order::random}) {
        const std::string name = order == Order::natural ? "grid " : "shuffled grid ";
        all.push_back({"quality", name + std::to_string(n) + "^3", [=] {
                           const hex::HexMesh mesh = grid_mesh(n, order);
                           std::vector<double> values;
                           return Work{mesh.cell_count(),
                                       seconds_of([&] { values = hex::scaled_jacobians(mesh, context); })};
                       }});
    }
}

void add_io(std::vector<Stage>& all, int n) {
    for (const std::string extension : {".vtk", ".vtu", ".mesh", ".k"}) {
        all.push_back({"write " + extension, "shuffled grid " + std::to_string(n) + "^3", [=] {
                           const hex::test::TemporaryFolder folder;
                           const hex::HexMesh mesh = shuffled_grid_mesh(n);
                           return Work{mesh.cell_count(), seconds_of([&] {
                                           hex::io::write_hex_mesh(folder / ("grid" + extension), mesh);
                                       })};
                       }});
        all.push_back({"read " + extension, "shuffled grid " + std::to_string(n) + "^3", [=] {
                           const hex::test::TemporaryFolder folder;
                           const auto file = folder / ("grid" + extension);
                           hex::io::write_hex_mesh(file, shuffled_grid_mesh(n));
                           Work work;
                           work.seconds = seconds_of(
                               [&] { work.elements = hex::io::read_hex_mesh(file).mesh.cell_count(); });
                           return work;
                       }});
    }
}

void add_pipeline(std::vector<Stage>& all, const hex::Context& context, const std::string& part) {
    all.push_back({"segment", part, [=] {
                       const hex::TriangleMesh mesh = load_surface(part, "_tri.k");
                       return Work{mesh.n_faces(), seconds_of([&] { hex::segment(mesh, {}, context); })};
                   }});
    all.push_back({"polycube", part, [=] {
                       const hex::TriangleMesh mesh = load_surface(part, "_patches.k");
                       return Work{mesh.n_faces(), seconds_of([&] { hex::polycube(mesh, {}, context); })};
                   }});
    for (const int level : {2, 4}) {
        // The rod has 106,496 hexahedra at level 4, the blob 151,552.
        all.push_back({"map", part + " -s " + std::to_string(level),
                       [=] {
                           const auto surface = load_surface(part, "_patches.k");
                           const auto blocks = hex::io::read_hex_mesh(part_file(part, "_blocks.k")).mesh;
                           hex::MapOptions options;
                           options.level = level;
                           Work work;
                           work.seconds = seconds_of([&] {
                               work.elements = hex::map(surface, blocks, options, context).mesh.cell_count();
                           });
                           return work;
                       },
                       2.0});
    }
    for (const std::string method : {"laplace", "pillow", "smooth", "optimize"}) {
        all.push_back(
            {"improve -m " + method, part + " -s 3", [=] {
                 const hex::HexMesh mesh = mapped(part, 3, context);
                 hex::ImproveOptions options;
                 options.method = method;
                 options.count = method == "pillow" ? 1 : 10;
                 options.features = hex::FeatureSource::angle;
                 return Work{mesh.cell_count(), seconds_of([&] { hex::improve(mesh, options, context); })};
             }});
    }
}

/// The cost of an element should not depend on how many there are.
void add_spline_curve(std::vector<Stage>& all, const hex::Context& context) {
    for (const int n : {10, 22, 46, 79}) {
        all.push_back(
            {"spline", "shuffled grid " + std::to_string(n) + "^3", [=] {
                 const hex::HexMesh mesh = shuffled_grid_mesh(n);
                 return Work{mesh.cell_count(), seconds_of([&] { spline::build(mesh, {}, context); })};
             }});
    }
}

/// One sweep: what a hundred more take, so that nothing but sweeps is in it.
Work smoothing_sweep(const hex::HexMesh& mesh, const hex::Context& context) {
    hex::ImproveOptions options;
    options.method = "smooth";
    options.step = 0.001;
    options.features = hex::FeatureSource::angle;
    const auto seconds = [&](int sweeps) {
        options.count = sweeps;
        return seconds_of([&] { hex::improve(mesh, options, context); });
    };
    const double few = seconds(10);
    return {mesh.cell_count(), (seconds(110) - few) / 100.0};
}

Stage auto_stage(const std::string& input, const std::function<hex::HexMesh()>& make,
                 const hex::Context& context, double most_seconds, double most_megabytes) {
    return {"improve -m auto", input,
            [=] {
                const hex::HexMesh mesh = make();
                return Work{mesh.cell_count(), seconds_of([&] { hex::improve(mesh, {}, context); })};
            },
            most_seconds, most_megabytes};
}

void add_improve(std::vector<Stage>& all, const hex::Context& context) {
    all.push_back({"improve sweep", "pillowed rod -s 2",
                   [=] {
                       hex::ImproveOptions options;
                       options.method = "pillow";
                       return smoothing_sweep(hex::improve(mapped("rod", 2, context), options, context).mesh,
                                              context);
                   },
                   0.0032});  // 2.6 ms for the 2,272 elements of the pillowed rod of the paper
    for (const auto& [part, level, seconds] :
         {std::tuple("bracket", 3, 10.0), std::tuple("rod", 3, 25.0), std::tuple("rod", 4, 180.0)}) {
        const std::string name = part;
        all.push_back(auto_stage(
            name + " -s " + std::to_string(level),
            [=, level = level] { return mapped(name, level, context); }, context, seconds, 1024.0));
    }
    const auto bunny = hex::test::reference_data() / "hex" / "edgecone_bunny_in.mesh";
    if (exists(bunny))
        all.push_back(auto_stage(
            "bunny", [=] { return hex::io::read_hex_mesh(bunny).mesh; }, context, 60.0, 1024.0));
}

void add_spline(std::vector<Stage>& all, const hex::Context& context, const std::string& part) {
    for (const int level : {2, 3}) {
        const std::string input = part + " -s " + std::to_string(level);
        all.push_back(
            {"spline", input, [=] {
                 const hex::HexMesh mesh = mapped(part, level, context);
                 spline::SplineOptions options;
                 options.features = hex::FeatureSource::angle;
                 return Work{mesh.cell_count(), seconds_of([&] { spline::build(mesh, options, context); })};
             }});
        all.push_back({"write BEXT", input, [=] {
                           const hex::test::TemporaryFolder folder;
                           spline::SplineOptions options;
                           options.features = hex::FeatureSource::angle;
                           const auto built = spline::build(mapped(part, level, context), options, context);
                           return Work{built.report.input_elements, seconds_of([&] {
                                           spline::io::write_bext(folder / "part.bext", built.spline,
                                                                  context);
                                       })};
                       }});
    }
}

}  // namespace

std::vector<Stage> stages(int threads, int grid) {
    hex::Context context;
    context.threads = threads;
    std::vector<Stage> all;
    add_structures(all, context, grid);
    add_io(all, std::max(1, grid / 2));
    for (const std::string part : {"rod", "bracket", "blob"}) add_pipeline(all, context, part);
    add_improve(all, context);
    add_spline(all, context, "rod");
    add_spline_curve(all, context);
    return all;
}

}  // namespace bench
