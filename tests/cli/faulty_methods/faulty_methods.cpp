// A plug-in whose methods fail in every way that a method can fail: for plugin_test.py.
#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/base/plugin.h>
#include <hex/improve/improve.h>
#include <hex/io/reader.h>
#include <hex/segment/segment.h>

#include <array>
#include <limits>
#include <stdexcept>

namespace {

[[noreturn]] void fail(const std::string& how) {
    if (how == "error") throw hex::Error(hex::ErrorKind::no_result, "no luck", "triangle 3", "try again");
    if (how == "number") throw 42;
    if (how == "memory") throw std::bad_alloc();
    if (how == "lines") throw std::runtime_error("no luck\nand no\tmanners");
    throw std::runtime_error("no luck");
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
        if (how_ == "thread") hex::parallel_for(mesh.n_faces(), [](std::size_t) { fail("standard"); });
        fail(how_);
    }

  private:
    std::string how_;
};

class FaultyImprover : public hex::Improver {
  public:
    hex::ImproveResult improve(const hex::HexMesh&, const hex::ImproveOptions&,
                               const hex::Context&) const override {
        fail("number");
    }
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
    for (const std::string how :
         {"error", "standard", "number", "memory", "lines", "labels", "few", "thread"})
        hex::segmenters().add("faulty-" + how, "fails",
                              [how] { return std::make_unique<FaultySegmenter>(how); });
    hex::improvers().add("faulty", "fails", [] { return std::make_unique<FaultyImprover>(); });
    hex::segmenters().add("faulty-factory", "fails",
                          []() -> std::unique_ptr<hex::Segmenter> { fail("standard"); });
    hex::io::add_reader(".faulty", "fails", [] { return std::make_unique<FaultyReader>(); });
}

}  // namespace

HEX_PLUGIN("faulty-methods", "1.0", register_methods)
