#include <hex/io/number_text.h>
#include <hex/io/output_file.h>
#include <spline/io/bezier_vtu.h>

#include <bit>
#include <cstring>
#include <string>

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

/// Writes the arrays after the XML in one pass: every array's size is known before its bytes are.
class AppendedData {
  public:
    /// The XML of an array, which then starts at the present offset.
    std::string declare(const char* name, const char* type, int components, std::size_t bytes) {
        std::string xml = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\"";
        if (components > 1) xml += " NumberOfComponents=\"" + std::to_string(components) + "\"";
        xml += " format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n";
        offset_ += sizeof(std::uint64_t) + bytes;
        return xml;
    }

  private:
    std::size_t offset_ = 0;
};

template <class Value>
void put(hex::io::OutputFile& file, Value value) {
    char bytes[sizeof(Value)];
    std::memcpy(bytes, &value, sizeof(Value));
    file.buffer().append(bytes, sizeof(Value));
    file.flush_if_large();
}

}  // namespace

void write_bezier_vtu(const std::filesystem::path& path, const BezierSpline& spline) {
    const std::vector<BezierPoint> points = bezier_points(spline);
    const std::size_t cells = spline.element_count();
    const auto sizes = [&](std::size_t count, std::size_t each) { return std::uint64_t{count * each}; };

    AppendedData data;
    hex::io::OutputFile file(path);
    std::string xml =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"2.1\" byte_order=\"";
    xml += std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
    xml += "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
           std::to_string(points.size()) + "\" NumberOfCells=\"" + std::to_string(cells) + "\">\n";
    // One statement an array: offsets depend on the order of declaration.
    xml += "<PointData RationalWeights=\"RationalWeights\">\n";
    xml += data.declare("RationalWeights", "Float64", 1, sizes(points.size(), 8));
    xml += "</PointData>\n<CellData HigherOrderDegrees=\"HigherOrderDegrees\">\n";
    xml += data.declare("HigherOrderDegrees", "Float64", 3, sizes(cells, 24));
    xml += data.declare("level", "UInt16", 1, sizes(cells, 2));
    xml += data.declare("element", "UInt32", 1, sizes(cells, 4));
    xml += "</CellData>\n<Points>\n";
    xml += data.declare("Points", "Float64", 3, sizes(points.size(), 24));
    xml += "</Points>\n<Cells>\n";
    xml += data.declare("connectivity", "Int64", 1, sizes(cells, 64 * 8));
    xml += data.declare("offsets", "Int64", 1, sizes(cells, 8));
    xml += data.declare("types", "UInt8", 1, cells);
    xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    file.write(xml);

    put(file, sizes(points.size(), 8));
    for (const BezierPoint& p : points) put(file, p[3]);
    put(file, sizes(cells, 24));
    for (std::size_t i = 0; i < 3 * cells; ++i) put(file, 3.0);
    put(file, sizes(cells, 2));
    for (const std::uint16_t level : spline.element_level) put(file, level);
    put(file, sizes(cells, 4));
    for (const std::uint32_t cell : spline.element_cell) put(file, cell);
    put(file, sizes(points.size(), 24));
    for (const BezierPoint& p : points) {
        for (Eigen::Index a = 0; a < 3; ++a) put(file, p[a]);
    }
    put(file, sizes(cells, 64 * 8));
    constexpr auto order = vtk_order();
    for (const auto& element : spline.elements) {
        for (const std::uint8_t p : order) put(file, std::int64_t{element[p]});
    }
    put(file, sizes(cells, 8));
    for (std::size_t c = 1; c <= cells; ++c) put(file, static_cast<std::int64_t>(64 * c));
    put(file, std::uint64_t{cells});
    for (std::size_t c = 0; c < cells; ++c) put(file, std::uint8_t{79});
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
}

}  // namespace spline::io
