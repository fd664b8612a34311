// A plug-in whose methods fail in every way that a method can fail: for plugin_test.py.
#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/base/plugin.h>
#include <hex/improve/improve.h>
#include <hex/io/reader.h>
#include <hex/map/map.h>
#include <hex/polycube/polycube.h>
#include <hex/segment/segment.h>
#include <spline/spline.h>

#include <array>
#include <limits>
#include <stdexcept>

namespace {

[[noreturn]] void fail(const std::string& how) {
    if (how == "error") throw hex::Error(hex::ErrorKind::no_result, "no luck", "triangle 3", "try again");
    if (how == "number") throw 42;
    if (how == "memory") throw std::bad_alloc();
    if (how == "lines") throw std::runtime_error("no luck\nand no\tmanners");
    if (how == "silent") throw std::runtime_error("");
    if (how == "silent-error") throw hex::Error(hex::ErrorKind::bad_input, "");
    if (how == "colours") throw std::runtime_error("no\x1b[31m luck\x7f");
    throw std::runtime_error("no luck");
}

/// Whether a method that fails like this throws; the others return something wrong.
bool throws(const std::string& how) {
    return how == "number" || how == "silent";
}

hex::Vec3 nowhere() {
    return hex::Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
}

class FaultySegmenter : public hex::Segmenter {
  public:
    explicit FaultySegmenter(std::string how) : how_(std::move(how)) {}
    hex::SegmentResult segment(const hex::TriangleMesh& mesh, const hex::SegmentOptions&,
                               const hex::Context&) const override {
        if (how_ == "labels") {
            hex::SegmentResult result;
            result.segmentation.labels.assign(mesh.n_faces(), 17);
            return result;
        }
        if (how_ == "few") return {};
        if (how_ == "rotation") {
            hex::SegmentResult result;
            result.segmentation.labels.assign(mesh.n_faces(), 0);
            result.rotation(0, 0) = 2.0;
            return result;
        }
        if (how_ == "thread") hex::parallel_for(mesh.n_faces(), [](std::size_t) { fail("standard"); });
        fail(how_);
    }

  private:
    std::string how_;
};

class FaultyImprover : public hex::Improver {
  public:
    explicit FaultyImprover(std::string how) : how_(std::move(how)) {}
    hex::ImproveResult improve(const hex::HexMesh& mesh, const hex::ImproveOptions&,
                               const hex::Context&) const override {
        if (throws(how_)) fail(how_);
        hex::ImproveResult result;
        if (how_ == "empty") return result;
        result.mesh = mesh;
        if (how_ == "infinite") result.mesh.set_position(hex::VertexId(3), nowhere());
        if (how_ == "edges")
            result.report.feature_edges.push_back({0, static_cast<std::int64_t>(mesh.vertex_count())});
        return result;
    }

  private:
    std::string how_;
};

class FaultyMapper : public hex::Mapper {
  public:
    explicit FaultyMapper(std::string how) : how_(std::move(how)) {}
    hex::MapResult map(const hex::TriangleMesh&, const hex::HexMesh& blocks, const hex::MapOptions&,
                       const hex::Context&) const override {
        if (throws(how_)) fail(how_);
        hex::MapResult result;
        if (how_ == "empty") return result;
        const auto cells = blocks.cell_array();
        std::vector<hex::Vec3> positions(blocks.positions().begin(), blocks.positions().end());
        std::vector<int> parts(cells.size(), how_ == "parts" ? 0 : 1);
        if (how_ == "unused") positions.push_back(hex::Vec3::Zero());
        result.mesh = hex::HexMesh(std::move(positions), {cells.begin(), cells.end()}, std::move(parts));
        if (how_ == "infinite") result.mesh.set_position(hex::VertexId(0), nowhere());
        return result;
    }

  private:
    std::string how_;
};

class FaultyPolycube : public hex::PolycubeBuilder {
  public:
    explicit FaultyPolycube(std::string how) : how_(std::move(how)) {}
    hex::PolycubeResult build(const hex::TriangleMesh& mesh, const hex::PolycubeOptions& options,
                              const hex::Context& context) const override {
        if (throws(how_)) fail(how_);
        hex::PolycubeResult result;
        if (how_ == "empty") return result;
        result = hex::polycube_builders().make("patches")->build(mesh, options, context);
        hex::Polycube& cube = result.polycube;
        if (how_ == "infinite") cube.corner_points[0] = nowhere();
        if (how_ == "triangles") cube.layout.patch_of_triangle.pop_back();
        if (how_ == "patch") cube.layout.patch_of_triangle[0] = 1000;
        if (how_ == "loops") cube.layout.patches[0].loops[0][0][0] = -7;
        if (how_ == "corner") cube.corners.back() = static_cast<int>(mesh.n_vertices());
        if (how_ == "points") cube.corner_points.pop_back();
        if (how_ == "quads") cube.quads.pop_back();
        if (how_ == "quad") cube.quads[0][0] = 1 << 30;
        if (how_ == "edge") cube.edges[0][0] = 1 << 30;
        return result;
    }

  private:
    std::string how_;
};

class FaultySpline : public spline::SplineBuilder {
  public:
    explicit FaultySpline(std::string how) : how_(std::move(how)) {}
    spline::SplineResult build(const hex::HexMesh& mesh, const spline::SplineOptions& options,
                               const hex::Context& context) const override {
        if (throws(how_)) fail(how_);
        spline::SplineResult result;
        if (how_ == "empty") return result;
        result = spline::spline_builders().make("thspline3d")->build(mesh, options, context);
        spline::BezierSpline& made = result.spline;
        if (how_ == "infinite") made.control_points[0] = nowhere();
        if (how_ == "weights") made.weights.pop_back();
        if (how_ == "weight") made.weights[0] = -1.0;
        if (how_ == "rows") made.rows.offsets[1] = made.rows.columns.size() + 1;
        if (how_ == "columns") made.rows.columns[0] = 1u << 30;
        if (how_ == "values") made.rows.values[0] = nowhere().x();
        if (how_ == "points") made.elements[0][5] = 1u << 30;
        if (how_ == "lists") made.element_level.pop_back();
        if (how_ == "level") result.levels[0].function[0] = 1u << 30;
        return result;
    }

  private:
    std::string how_;
};

/// The first byte of the file says what goes wrong.
class FaultyReader : public hex::io::Reader {
  public:
    hex::io::MeshData read(const std::string& name, std::string_view bytes) const override {
        hex::io::MeshData data;
        data.points() = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        switch (bytes.front()) {
            case 'e':
                throw hex::Error(hex::ErrorKind::bad_input, "no luck", name + ":1");
            case 's':
                fail("standard");
            case '4':
                fail("number");
            case '0':
                fail("silent");
            case 'i':
                data.add_polygon(std::array<std::uint32_t, 3>{0, 1, 3}, 1);
                break;
            case 'n':
                data.points()[1].x() = std::numeric_limits<double>::quiet_NaN();
                break;
            case 'o':
                data.surface.offsets.push_back(7);
                break;
            case 'p':
                data.add_polygon(std::array<std::uint32_t, 3>{0, 1, 2}, 1);
                data.surface.parts.clear();
                break;
            case 'h':
                data.hexahedra.emplace_back();
                break;
            default:
                break;
        }
        return data;
    }
};

void register_methods() {
    for (const std::string how : {"error", "standard", "number", "memory", "lines", "labels", "few", "thread",
                                  "rotation", "silent", "silent-error", "colours"})
        hex::segmenters().add("faulty-" + how, "fails",
                              [how] { return std::make_unique<FaultySegmenter>(how); });
    for (const std::string how : {"number", "silent", "empty", "infinite", "edges"})
        hex::improvers().add("faulty-" + how, "fails",
                             [how] { return std::make_unique<FaultyImprover>(how); });
    for (const std::string how : {"number", "silent", "empty", "infinite", "parts", "unused"})
        hex::mappers().add("faulty-" + how, "fails", [how] { return std::make_unique<FaultyMapper>(how); });
    for (const std::string how : {"number", "silent", "empty", "infinite", "triangles", "patch", "loops",
                                  "corner", "points", "quads", "quad", "edge"})
        hex::polycube_builders().add("faulty-" + how, "fails",
                                     [how] { return std::make_unique<FaultyPolycube>(how); });
    for (const std::string how : {"number", "silent", "empty", "infinite", "weights", "weight", "rows",
                                  "columns", "values", "points", "lists", "level"})
        spline::spline_builders().add("faulty-" + how, "fails",
                                      [how] { return std::make_unique<FaultySpline>(how); });
    hex::segmenters().add("faulty-null", "fails", [] { return std::unique_ptr<hex::Segmenter>(); });
    hex::segmenters().add("faulty-factory", "fails",
                          []() -> std::unique_ptr<hex::Segmenter> { fail("standard"); });
    hex::io::add_reader(".faulty", "fails", [] { return std::make_unique<FaultyReader>(); });
}

}  // namespace

HEX_PLUGIN("faulty-methods", "1.0", register_methods)
