#include "polycube/bodies.h"
#include "polycube/body_blocks.h"
#include "polycube/chart_graph.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/polycube/blocks.h>
#include <hex/surface/patch_layout.h>
#include <hex/surface/polygon_soup.h>
#include <hex/volume/topology.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace hex {
namespace {

/// Numbers of the charts of a body in the whole surface, whose charts are `layout`.
std::vector<int> chart_ids(const Body& body, const PatchLayout& layout) {
    const PatchLayout own = find_patches(body.surface);
    std::vector<int> ids;
    for (const Patch& patch : own.patches)
        ids.push_back(layout.patch_of_triangle[at(body.triangles[at(patch.triangles.front())])]);
    return ids;
}

/// Sets the labels of a body's triangles: those that are turned face the other way of their axes.
void set_labels(Body& body, const Segmentation& segmentation) {
    for (const auto f : body.surface.faces()) {
        const int label = segmentation.labels[at(body.triangles[at(f.idx())])];
        body.surface.data(f).part = (body.turned[at(f.idx())] ? label ^ 1 : label) + 1;
    }
}

/// Puts the blocks of bodies together: the vertices of the surface first, as they are numbered there.
class Assembly {
  public:
    explicit Assembly(const TriangleMesh& surface) {
        for (const auto v : surface.vertices()) soup_.points.push_back(to_eigen(surface.point(v)));
    }

    void add(const Body& body, const BodyBlocks& made) {
        const std::size_t first_patch = report_.patches;
        add_report(made.report);
        if (count_at_least(report_.violations, Severity::error) > 0) return;
        std::vector<int> vertices = body.vertices;
        for (std::size_t i = vertices.size(); i < made.model.points.size(); ++i) {
            vertices.push_back(static_cast<int>(soup_.points.size()));
            soup_.points.push_back(made.model.points[i]);
        }
        for (std::size_t t = 0; t < made.model.triangles.size(); ++t) {
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t k = 0; k < 3; ++k)
                triangle[k] = static_cast<std::uint32_t>(vertices[at(made.model.triangles[t][k])]);
            soup_.add_polygon(triangle, static_cast<int>(first_patch) + made.model.patch[t] + 1);
        }
        const std::size_t first = positions_.size();
        for (const VertexId v : made.model.blocks.vertices()) {
            positions_.push_back(made.model.blocks.position(v));
            const int node = made.model.vertex_of_node[v.index()];
            vertex_of_node_.push_back(node < 0 ? -1 : vertices[at(node)]);
        }
        for (HexCell cell : made.model.blocks.cell_array()) {
            for (VertexId& v : cell) v = VertexId(v.index() + first);
            cells_.push_back(cell);
        }
    }

    void count_turned(std::size_t shells) { report_.turned_shells += shells; }

    BlocksResult give_up(const ChartGraph& graph) {
        report_.charts = graph.charts.size();
        report_.sides = graph.sides.size();
        report_.corners = graph.layout.corners.size();
        report_.violations = graph.violations;
        return finish();
    }

    BlocksResult finish() {
        BlocksResult result;
        result.report = std::move(report_);
        if (count_at_least(result.report.violations, Severity::error) > 0) return result;
        result.patches = make_triangle_mesh(soup_);
        result.blocks = HexMesh(std::move(positions_), std::move(cells_));
        check(result);
        return result;
    }

  private:
    void add_report(const BlocksReport& body) {
        report_.charts += body.charts;
        report_.sides += body.sides;
        report_.corners += body.corners;
        report_.orders += body.orders;
        report_.turned_sides += body.turned_sides;
        report_.rounds = std::max(report_.rounds, body.rounds);
        for (std::size_t a = 0; a < 3; ++a) report_.planes[a] += body.planes[a];
        report_.cells += body.cells;
        report_.patches += body.patches;
        report_.cut_alone += body.cut_alone;
        report_.slides += body.slides;
        report_.unit = body.unit;
        report_.min_scaled_jacobian = report_.bodies == 0
                                          ? body.min_scaled_jacobian
                                          : std::min(report_.min_scaled_jacobian, body.min_scaled_jacobian);
        report_.inverted_corners += body.inverted_corners;
        for (Diagnostic violation : body.violations) {
            if (violation.entity == "block")
                for (std::int64_t& block : violation.ids) block += static_cast<std::int64_t>(report_.blocks);
            report_.violations.push_back(std::move(violation));
        }
        report_.blocks += body.blocks;
        report_.bodies += 1;
    }

    /// Boundary quads and patches must pair by their corners.
    void check(const BlocksResult& result) const {
        const PatchLayout layout = find_patches(result.patches);
        const Diagnostics wrong = diagnose_layout(layout);
        if (!wrong.empty()) fail("a patch of the blocks is not four-sided: " + wrong.front().message);
        std::set<std::array<int, 4>> patches;
        for (const Patch& patch : layout.patches) {
            auto corners = patch.corners;
            std::sort(corners.begin(), corners.end());
            if (!patches.insert(corners).second) fail("two patches of the blocks share all corners");
        }
        const BoundaryQuads quads = boundary_quads(result.blocks);
        if (quads.size() != patches.size())
            fail("the blocks have " + std::to_string(quads.size()) + " boundary quads and the surface " +
                 std::to_string(patches.size()) + " patches");
        for (const auto& quad : quads.vertices) {
            std::array<int, 4> corners{};
            for (std::size_t k = 0; k < 4; ++k) corners[k] = vertex_of_node_[quad[k].index()];
            std::sort(corners.begin(), corners.end());
            if (!patches.contains(corners)) fail("a boundary quad of the blocks is no patch");
        }
    }
    [[noreturn]] static void fail(const std::string& what) {
        throw Error(ErrorKind::no_result, what, {}, "mend the labels there, or try another unit");
    }

    BlocksReport report_;
    PolygonSoup soup_;
    std::vector<Vec3> positions_;
    std::vector<HexCell> cells_;
    std::vector<int> vertex_of_node_;  ///< surface vertex of each block vertex, or -1
};

BlocksResult make(const TriangleMesh& mesh, const Segmentation& segmentation, double unit,
                  const Context& context) {
    const TriangleMesh labelled = with_labels(mesh, segmentation);
    std::vector<Body> bodies = bodies_of(labelled);
    Assembly assembly(mesh);
    double volume = 0.0;
    for (Body& body : bodies) {
        volume += enclosed_volume(body.surface);
        set_labels(body, segmentation);
        assembly.count_turned(body.turned_shells);
    }
    if (!(unit > 0.0)) unit = std::cbrt(volume / 1500.0);
    const PatchLayout charts = find_patches(labelled);
    // What the labels alone forbid is told with the vertices of the whole surface.
    if (bodies.size() > 1) {
        const ChartGraph graph = build_chart_graph(labelled);
        if (!graph.violations.empty()) return assembly.give_up(graph);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        Context part = context;
        part.on_progress = [&](std::string_view step, double share) {
            context.progress(step, (static_cast<double>(b) + share) / static_cast<double>(bodies.size()));
        };
        std::vector<int> ids = chart_ids(bodies[b], charts);
        assembly.add(bodies[b], make_body_blocks(bodies[b].surface, unit, std::move(ids), part));
    }
    return assembly.finish();
}

}  // namespace

BlocksResult make_blocks(const TriangleMesh& mesh, const Segmentation& segmentation,
                         const BlocksOptions& options, const Context& context) {
    require_labels(segmentation, mesh.n_faces());
    if (!(options.unit >= 0.0) || !std::isfinite(options.unit))
        throw Error(ErrorKind::usage, "the unit of the integer polycube must be a positive number");
    return with_threads(context, [&] { return make(mesh, segmentation, options.unit, context); });
}

std::vector<int> labels_of_parts(const TriangleMesh& mesh) {
    const PatchLayout layout = find_patches(mesh);
    std::vector<int> labels(mesh.n_faces());
    for (const Patch& patch : layout.patches) {
        if (patch.part < 1 || patch.part > 6) return {};
        Vec3 facing = Vec3::Zero();
        for (const int t : patch.triangles) {
            std::array<Vec3, 3> p;
            std::size_t k = 0;
            for (const auto v : mesh.fv_range(TriangleMesh::FaceHandle(t))) p[k++] = to_eigen(mesh.point(v));
            facing += (p[1] - p[0]).cross(p[2] - p[0]);
            labels[at(t)] = patch.part - 1;
        }
        if (facing.dot(label_axis(patch.part - 1)) <= 0.0) return {};
    }
    return labels;
}

}  // namespace hex
