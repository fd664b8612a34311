#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/io/output_file.h>
#include <spline/io/bezier_vtu.h>

#include <zlib.h>

#include <bit>
#include <cstring>
#include <string>
#include <vector>

namespace spline::io {
namespace {

/// Place of Bezier point (i,j,k) in VTK's order of a cubic hexahedron: corners, edges, faces, body.
constexpr std::size_t vtk_place(std::size_t i, std::size_t j, std::size_t k) {
    const bool iend = i == 0 || i == 3, jend = j == 0 || j == 3, kend = k == 0 || k == 3;
    const int ends = int{iend} + int{jend} + int{kend};
    const std::size_t around = i > 0 ? (j > 0 ? 2 : 1) : (j > 0 ? 3 : 0);  // among the four of a layer
    if (ends == 3) return around + (k > 0 ? 4 : 0);
    if (ends == 2) {
        const std::size_t layer = 8 + (k > 0 ? 8 : 0);
        if (!iend) return layer + (j > 0 ? 4 : 0) + i - 1;
        if (!jend) return layer + (i > 0 ? 2 : 6) + j - 1;
        return 24 + 2 * around + k - 1;
    }
    if (ends == 1) {
        if (iend) return 32 + (i > 0 ? 4 : 0) + (j - 1) + 2 * (k - 1);
        if (jend) return 40 + (j > 0 ? 4 : 0) + (i - 1) + 2 * (k - 1);
        return 48 + (k > 0 ? 4 : 0) + (i - 1) + 2 * (j - 1);
    }
    return 56 + (i - 1) + 2 * (j - 1) + 4 * (k - 1);
}

/// Our point number of each place in VTK's order.
constexpr std::array<std::uint8_t, 64> vtk_order() {
    std::array<std::uint8_t, 64> order{};
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t i = 0; i < 4; ++i)
                order[vtk_place(i, j, k)] = static_cast<std::uint8_t>(i + 4 * j + 16 * k);
    return order;
}

/// Arrays after the XML, packed by zlib in blocks. The XML of an array gives its offset, so all are packed
/// first; only their packed bytes are held.
class AppendedData {
  public:
    explicit AppendedData(std::filesystem::path path) : path_(std::move(path)) {}

    /// Packs `count` values, `make(i)` each, and returns the XML of the array.
    template <class Value, class Make>
    std::string add(const char* name, const char* type, int components, std::size_t count, const Make& make) {
        std::string bytes(count * sizeof(Value), '\0');
        hex::parallel_for(
            count,
            [&](std::size_t i) {
                const Value value = make(i);
                std::memcpy(bytes.data() + i * sizeof(Value), &value, sizeof(Value));
            },
            4096);
        std::string xml = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\"";
        if (components > 1) xml += " NumberOfComponents=\"" + std::to_string(components) + "\"";
        xml += " format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n";
        pack(bytes);
        return xml;
    }
    const std::vector<std::string>& pieces() const { return pieces_; }

  private:
    static constexpr std::size_t block_size = std::size_t{1} << 18;

    void pack(const std::string& bytes) {
        const std::size_t blocks = (bytes.size() + block_size - 1) / block_size;
        std::vector<std::string> packed(blocks);
        hex::parallel_for(
            blocks,
            [&](std::size_t b) {
                const std::size_t begin = b * block_size, size = std::min(block_size, bytes.size() - begin);
                uLongf length = ::compressBound(size);
                packed[b].resize(length);
                const int status =
                    ::compress2(reinterpret_cast<Bytef*>(packed[b].data()), &length,
                                reinterpret_cast<const Bytef*>(bytes.data() + begin), size, Z_BEST_SPEED);
                if (status != Z_OK)
                    throw hex::Error(hex::ErrorKind::output, "an array cannot be packed", path_.string());
                packed[b].resize(length);
            },
            1);
        // Number of blocks, their size, that of the last one when it is smaller, packed sizes.
        std::string header;
        const auto put = [&](std::uint64_t value) {
            char text[sizeof value];
            std::memcpy(text, &value, sizeof value);
            header.append(text, sizeof value);
        };
        put(blocks);
        put(block_size);
        put(bytes.size() % block_size);
        for (const std::string& block : packed) put(block.size());
        packed.insert(packed.begin(), std::move(header));
        for (std::string& piece : packed) {
            offset_ += piece.size();
            pieces_.push_back(std::move(piece));
        }
    }

    std::filesystem::path path_;
    std::size_t offset_ = 0;
    std::vector<std::string> pieces_;
};

}  // namespace

void write_bezier_vtu(const std::filesystem::path& path, const BezierSpline& spline) {
    const std::vector<BezierPoint> points = bezier_points(spline);
    const std::size_t cells = spline.element_count();
    constexpr auto order = vtk_order();

    AppendedData data(path);
    std::string xml =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"2.1\" byte_order=\"";
    xml += std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
    xml += "\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
    xml += "<Piece NumberOfPoints=\"" + std::to_string(points.size()) + "\" NumberOfCells=\"";
    xml += std::to_string(cells) + "\">\n";
    // One statement an array: offsets depend on the order.
    xml += "<PointData RationalWeights=\"RationalWeights\">\n";
    xml += data.add<double>("RationalWeights", "Float64", 1, points.size(),
                            [&](std::size_t i) { return points[i][3]; });
    xml += "</PointData>\n<CellData HigherOrderDegrees=\"HigherOrderDegrees\">\n";
    xml += data.add<double>("HigherOrderDegrees", "Float64", 3, 3 * cells, [](std::size_t) { return 3.0; });
    xml += data.add<std::uint16_t>("level", "UInt16", 1, cells,
                                   [&](std::size_t i) { return spline.element_level[i]; });
    xml += data.add<std::uint32_t>("element", "UInt32", 1, cells,
                                   [&](std::size_t i) { return spline.element_cell[i]; });
    xml += "</CellData>\n<Points>\n";
    xml += data.add<double>("Points", "Float64", 3, 3 * points.size(),
                            [&](std::size_t i) { return points[i / 3][static_cast<Eigen::Index>(i % 3)]; });
    xml += "</Points>\n<Cells>\n";
    xml += data.add<std::int64_t>("connectivity", "Int64", 1, 64 * cells, [&](std::size_t i) {
        return std::int64_t{spline.elements[i / 64][order[i % 64]]};
    });
    xml += data.add<std::int64_t>("offsets", "Int64", 1, cells,
                                  [](std::size_t c) { return static_cast<std::int64_t>(64 * (c + 1)); });
    xml += data.add<std::uint8_t>("types", "UInt8", 1, cells, [](std::size_t) { return std::uint8_t{79}; });
    xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";

    hex::io::OutputFile file(path);
    file.write(xml);
    for (const std::string& piece : data.pieces()) file.write(piece);
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
}

}  // namespace spline::io
