// Writes a seed corpus: fuzz_seeds FOLDER makes FOLDER/<reader>/ with one small file of each kind of content,
// and of the layouts that our writers do not make.
#include <hex/io/mesh_file.h>
#include <hex/io/output_file.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace {

hex::PolygonSoup tetrahedron() {
    hex::PolygonSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}, {0, 0, 1e-3}};
    soup.corners = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    soup.offsets = {0, 3, 6, 9, 12};
    soup.parts = {1, 2, 2, 3};
    return soup;
}

hex::HexMesh two_cubes() {
    std::vector<hex::Vec3> points;
    for (int k = 0; k < 3; ++k) {
        for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)})
            points.emplace_back(x, y, k);
    }
    std::vector<hex::HexCell> cells(2);
    for (std::size_t i = 0; i < 8; ++i) {
        cells[0][i] = hex::VertexId(i);
        cells[1][i] = hex::VertexId(i + 4);
    }
    return {points, cells, {1, 2}};
}

struct Seed {
    const char* file;
    std::string_view text;
};

using namespace std::string_view_literals;

const std::array seeds = {
    Seed{"ls_dyna/fixed.k",
         "*KEYWORD\n*ELEMENT_SHELL\n       1       1       1       2       3       3       0       0       0 "
         "      0\n*NODE\n"
         "       1             0.0             0.0             0.0       0       0\n       2             1.0 "
         "            0.0             0.0\n"
         "       3             1.0             1.0             0.0\n*END\n"sv},
    Seed{
        "ls_dyna/two_lines.k",
        "*KEYWORD\n*ELEMENT_SOLID\n1 2\n1 2 3 4 5 6 7 8\n*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n*END\n"sv},
    Seed{
        "legacy_vtk/version5.vtk",
        "# vtk DataFile Version 5.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 "
        "0\nMETADATA\nINFORMATION 0\n\nPOLYGONS 2 3\nOFFSETS "
        "vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1 2\nCELL_DATA 1\nFIELD FieldData 1\npart 1 1 int\n4\nPOINT_DATA 3\nVECTORS v float\n1 2 3 4 5 6 7 8 9\n"sv},
    Seed{"legacy_vtk/binary.vtk",
         "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 1 "
         "float\n\0\0\0\0\0\0\0\0\0\0\0\0\nPOLYGONS 1 4\n\0\0\0\3\0\0\0\0\0\0\0\0\0\0\0\0\nCELL_DATA "
         "1\nSCALARS pid short 1\nLOOKUP_TABLE default\n\0\7\n"sv},
    Seed{"vtu/base64.vtu",
         "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"3\" "
         "NumberOfCells=\"1\"><Points><DataArray type=\"Float32\" "
         "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0</DataArray></Points><Cells><DataArray "
         "type=\"Int32\" Name=\"connectivity\">0 1 "
         "2</DataArray><DataArray type=\"UInt8\" Name=\"offsets\" "
         "format=\"binary\">AQAAAAM=</DataArray><DataArray type=\"UInt8\" Name=\"types\" "
         "format=\"binary\">AQAAAA==BQ==</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"sv},
    Seed{
        "stl/binary.stl",
        "12345678901234567890123456789012345678901234567890123456789012345678901234567890\1\0\0\0"
        "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200?\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200?\0\0\0\0\0\0"sv},
    Seed{"obj/all.obj", "v 0 0 0\nvt 0 0\nv 1 0 0 1\nv 0 1 0\ng part_4\nf 1/1/1 2//1 \\\n -1\nl 1 2\n"sv},
    Seed{"off/colours.off", "COFF 3 1 0\n# c\n0 0 0 1 1 1 1\n1 0 0 1\n0 1 0\n3 0 1 2 255 0 0\n"sv},
    Seed{"ply/binary.ply",
         "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty uchar y\nproperty "
         "double z\nelement face 1\nproperty list uchar short "
         "vertex_indices\nproperty char pid\nend_header\n\0\0\0\0\0\0\0\0\0\0\0\0\0\3\0\0\0\0\0\0\2"sv},
    Seed{"abaqus/part.inp",
         "*HEADING\n** c\n*PART, NAME=a\n*NODE\n5, 0., 0.\n6, 1, 0, 0\n9, 0, 1, 0\n*ELEMENT, TYPE=S3R,\n "
         "ELSET=\"b "
         "c\"\n2, 5, 6,\n9\n*ELEMENT, TYPE=B31\n1, 5, 6\n*ELSET, ELSET=d, GENERATE\n1, 9, 1\n*END PART\n"sv},
    Seed{"gmsh/two.msh",
         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"a "
         "b\"\n$EndPhysicalNames\n$Nodes\n3\n1 0 0 0\n4 1 0 0\n2 0 1 0\n$EndNodes\n$Elements\n2\n1 15 2 0 1 "
         "1\n2 2 2 "
         "7 1 1 4 2\n$EndElements\n$NodeData\n1\n$EndNodeData\n"sv},
    Seed{"mfem/surface.mfem",
         "MFEM mesh v1.0\n# c\ndimension\n2\nelements\n1\n3 2 0 1 2\nboundary\n1\n1 1 0 1\nvertices\n3\n3\n0 "
         "0 0\n1 "
         "0 0\n0 1 0\n"sv},
    Seed{"open_volume_mesh/properties.ovm",
         "OVM ASCII\nVertices\n3\n0 0 0\n1 0 0\n0 1 0\nEdges\n3\n0 1\n1 2\n2 0\nFaces\n1\n3 0 2 "
         "4\nPolyhedra\n0\nVProp "
         "double \"a\"\n1\n2\n3\nFProp int \"part_id\"\n4\n"sv},
    Seed{
        "medit/skip.mesh",
        "MeshVersionFormatted 1\nDimension\n3\nVertices 3\n0 0 0 0 1 0 0 0 0 1 0 0\nEdges 1 1 2 0\nTriangles\n1 1 2 3 # c\n 4\nEnd\n"sv},
};

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fputs("usage: fuzz_seeds FOLDER\n", stderr);
        return 2;
    }
    const std::filesystem::path folder = arguments[1];
    const std::array<std::string, 12> readers = {"ls_dyna", "legacy_vtk", "vtu",  "medit",
                                                 "mfem",    "abaqus",     "gmsh", "open_volume_mesh",
                                                 "stl",     "obj",        "off",  "ply"};
    for (std::size_t i = 0; i < readers.size(); ++i) {
        const auto& format = hex::io::formats()[i];
        const std::string extension(format.extensions.front());
        std::filesystem::create_directories(folder / readers[i]);
        hex::io::write_surface(folder / readers[i] / ("surface" + extension), tetrahedron());
        if (format.writes_hexahedra)
            hex::io::write_hex_mesh(folder / readers[i] / ("hexahedra" + extension), two_cubes());
    }
    for (const Seed& seed : seeds) hex::io::write_file(folder / seed.file, seed.text);
    return 0;
}
