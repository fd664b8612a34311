// Broken files: one clear message with the place, never a crash, never a huge allocation.
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/mesh_file.h>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <ostream>

namespace hex::io {
namespace {

using test::TemporaryFolder;

struct Malformed {
    const char* name;
    const char* extension;
    std::string text;
    /// Where the error is: ":LINE" or ":byte N"; and words of the message.
    const char* place;
    const char* words;
    ErrorKind kind = ErrorKind::bad_input;
};

std::string le32(std::uint32_t value) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>(value >> (8 * i) & 255);
    return text;
}

const std::string vtk = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const std::string vtk_points = vtk + "POINTS 3 float\n0 0 0\n1 0 0\n0 1 0\n";
const std::string medit = "MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 0 0\n1 0 0 0\n0 1 0 0\n";
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string ply_faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

const std::string inp = "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n";
const std::string msh2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string mfem = "MFEM mesh v1.0\ndimension\n3\nelements\n1\n";
const std::string ovm = "OVM ASCII\nVertices\n3\n0 0 0\n1 0 0\n0 1 0\n";

std::string vtu(const std::string& points, const std::string& connectivity,
                const std::string& counts = "NumberOfPoints=\"3\" NumberOfCells=\"1\"") {
    return "<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid>\n<Piece " + counts +
           ">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" + points +
           "</DataArray>\n</Points>\n<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\" "
           "format=\"ascii\">" +
           connectivity +
           "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray>\n"
           "<DataArray type=\"UInt8\" Name=\"types\" "
           "format=\"ascii\">5</DataArray>\n</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

const std::vector<Malformed> cases = {
    // LS-DYNA
    {"k_no_keyword", ".k", "hello\n", ":1", "outside of any keyword"},
    {"k_only_comments", ".k", "$ nothing\n", ":1", "no LS-DYNA keyword"},
    {"k_short_node", ".k", "*KEYWORD\n*NODE\n1,0,0\n*END\n", ":3", "three coordinates"},
    {"k_nan", ".k", "*KEYWORD\n*NODE\n1,0,nan,0\n*END\n", ":3", "finite number, not 'nan'"},
    {"k_infinite", ".k", "*KEYWORD\n*NODE\n1,0,1e999,0\n*END\n", ":3", "finite number"},
    {"k_node_twice", ".k", "*KEYWORD\n*NODE\n1,0,0,0\n2,0,0,0\n1,1,1,1\n*END\n", ":5",
     "node 1 is defined twice"},
    {"k_shell_twice", ".k",
     "*KEYWORD\n*ELEMENT_SHELL\n7,1,1,2,3,3\n7,1,1,2,3,3\n*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n*END\n", ":4",
     "shell element 7 is defined twice"},
    {"k_missing_node", ".k", "*KEYWORD\n*ELEMENT_SHELL\n1,1,1,2,9,9\n*NODE\n1,0,0,0\n2,1,0,0\n*END\n", ":3",
     "element 1 uses node 9"},
    {"k_bad_integer", ".k", "*KEYWORD\n*ELEMENT_SHELL\n1,1,1,2.5,3,3\n*END\n", ":3", "integer, not '2.5'"},
    {"k_negative_id", ".k", "*KEYWORD\n*ELEMENT_SHELL\n1,1,-1,2,3,3\n*END\n", ":3", "not positive"},
    {"k_short_solid", ".k", "*KEYWORD\n*ELEMENT_SOLID\n1,1,1,2,3,4,5,6,7\n*END\n", ":3",
     "needs eight nodes and has 7"},
    {"k_solid_without_nodes", ".k", "*KEYWORD\n*ELEMENT_SOLID\n1,1\n*NODE\n", ":4",
     "nodes of solid element 1 are missing"},
    {"k_solid_cut_off", ".k", "*KEYWORD\n*ELEMENT_SOLID\n1,1\n", ":3", "ends before the nodes"},
    {"k_degenerate_solid", ".k",
     "*KEYWORD\n*ELEMENT_SOLID\n5,1,1,2,3,3,4,4,4,4\n*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*END\n", ":3",
     "solid element 5 uses node 3 twice"},
    {"k_quadratic_shell", ".k", "*KEYWORD\n*ELEMENT_SHELL\n1,1,1,2,3,4,5,6,7,8\n*END\n", ":3",
     "nodes on their edges", ErrorKind::unsupported},
    {"k_other_elements", ".k", "*KEYWORD\n*ELEMENT_BEAM_SECTION\n1,1\n*NODE\n1,0,0,0\n*END\n", "",
     "holds no polygons: keyword '*ELEMENT_BEAM_SECTION' in line 2"},
    {"k_no_elements", ".k", "*KEYWORD\n*NODE\n1,0,0,0\n*END\n", "", "holds no polygons"},
    // VTK legacy
    {"vtk_no_header", ".vtk", "solid\n", ":1", "not a legacy VTK file"},
    {"vtk_encoding", ".vtk", "# vtk DataFile Version 3.0\nt\nEBCDIC\n", ":3", "ASCII or BINARY"},
    {"vtk_data_set", ".vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n", ":4",
     "STRUCTURED_POINTS", ErrorKind::unsupported},
    {"vtk_huge_count", ".vtk", vtk + "POINTS 999999999999 float\n0 0 0\n", ":5",
     "more than the rest of the file"},
    {"vtk_negative_count", ".vtk", vtk + "POINTS -1 float\n", ":5", "negative"},
    {"vtk_count_overflow", ".vtk", vtk + "POINTS 99999999999999999999 float\n", ":5", "integer"},
    {"vtk_nan", ".vtk", vtk + "POINTS 2 float\n0 0 0\n0 nan 0\n", ":7", "finite"},
    {"vtk_cut_off", ".vtk", vtk + "POINTS 2 float\n0 0 0\n0 0", ":5", "more than the rest"},
    {"vtk_unknown_type", ".vtk", vtk + "POINTS 2 quadruple\n", ":5", "'quadruple'", ErrorKind::unsupported},
    {"vtk_index", ".vtk", vtk_points + "CELLS 1 4\n3 0 1 3\nCELL_TYPES 1\n5\n", ":10",
     "point index 3 is not in 0..2"},
    {"vtk_negative_index", ".vtk", vtk_points + "CELLS 1 4\n3 0 1 -1\nCELL_TYPES 1\n5\n", ":10",
     "point index -1"},
    {"vtk_wrong_size", ".vtk", vtk_points + "CELLS 1 5\n3 0 1 2\n4\nCELL_TYPES 1\n5\n", ":10", "unused"},
    {"vtk_size_too_small", ".vtk", vtk_points + "CELLS 1 3\n3 0 1 2\nCELL_TYPES 1\n5\n", ":10",
     "does not fit"},
    {"vtk_no_types", ".vtk", vtk_points + "CELLS 1 4\n3 0 1 2\n", ":10", "before CELL_TYPES"},
    {"vtk_types_count", ".vtk", vtk_points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 2\n5\n5\n", ":11",
     "2 cell types for 1 cells"},
    {"vtk_corner_count", ".vtk", vtk_points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n12\n", "",
     "cell 0 has 3 corners"},
    {"vtk_cells_first", ".vtk", vtk + "CELLS 1 4\n3 0 1 2\n", ":5", "POINTS must come before"},
    {"vtk_tetrahedron", ".vtk",
     vtk + "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n", "",
     "cell 0 is a tetrahedron", ErrorKind::unsupported},
    {"vtk_data_count", ".vtk", vtk_points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\nCELL_DATA 2\n", ":13",
     "2 cells of 1"},
    {"vtk_offsets", ".vtk",
     "# vtk DataFile Version 5.1\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0\n1 0 0\n0 1 "
     "0\nCELLS 3 3\nOFFSETS vtktypeint64\n0 3 1\nCONNECTIVITY vtktypeint64\n0 1 2\n",
     ":11", "offset 1"},
    {"vtk_binary_cut_off", ".vtk",
     "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 2 double\n0123456789", ":byte",
     "within binary data"},
    {"vtk_no_points", ".vtk", vtk, ":4", "no POINTS"},
    // VTK XML
    {"vtu_not_xml", ".vtu", "hello", "", "XML"},
    {"vtu_cut_off", ".vtu", "<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid>", ":2", "well-formed"},
    {"vtu_kind", ".vtu", "<VTKFile type=\"ImageData\"></VTKFile>", ":1", "'ImageData'",
     ErrorKind::unsupported},
    {"vtu_compressor", ".vtu",
     "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\"><UnstructuredGrid><Piece "
     "NumberOfPoints=\"1\" NumberOfCells=\"0\"><Points>"
     "<DataArray type=\"Float32\" NumberOfComponents=\"3\" "
     "format=\"binary\">AQAAAA==</DataArray></Points></Piece></UnstructuredGrid></VTKFile>",
     ":1", "vtkLZ4DataCompressor", ErrorKind::unsupported},
    {"vtu_few_points", ".vtu", vtu("0 0 0 1 0 0", "0 1 2"), ":5", "more than the rest"},
    {"vtu_many_points", ".vtu", vtu("0 0 0 1 0 0 0 1 0 5", "0 1 2"), ":5", "more values than"},
    {"vtu_nan", ".vtu", vtu("0 0 0 1 nan 0 0 1 0", "0 1 2"), ":5", "finite"},
    {"vtu_index", ".vtu", vtu("0 0 0 1 0 0 0 1 0", "0 1 7"), ":8", "point index 7"},
    {"vtu_huge", ".vtu",
     vtu("0 0 0 1 0 0 0 1 0", "0 1 2", "NumberOfPoints=\"4000000000\" NumberOfCells=\"1\""), ":3",
     "NumberOfPoints"},
    {"vtu_negative", ".vtu", vtu("0 0 0 1 0 0 0 1 0", "0 1 2", "NumberOfPoints=\"3\" NumberOfCells=\"-1\""),
     ":3", "NumberOfCells"},
    {"vtu_appended", ".vtu", "<VTKFile type=\"UnstructuredGrid\">\n<AppendedData encoding=\"raw\">", ":2",
     "'_'"},
    // STL
    {"stl_nothing", ".stl", "hello", "", "neither"},
    {"stl_cut_off_binary", ".stl", std::string(80, 'x') + le32(2) + std::string(60, '\0'), ":byte 80",
     "2 triangles"},
    {"stl_huge_count", ".stl", std::string(80, 'x') + le32(0xFFFFFFFF) + std::string(60, '\0'), ":byte 80",
     "4294967295 triangles"},
    {"stl_nan", ".stl",
     std::string(80, 'x') + le32(1) + std::string(12, '\0') + "\xff\xff\xff\xff" + std::string(34, '\0'),
     ":byte 84", "not finite"},
    {"stl_cut_off", ".stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n", ":6",
     "vertex should be"},
    {"stl_quadrilateral", ".stl",
     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 "
     "0\nendloop\nendfacet\nendsolid\n",
     ":7", "endloop should be here"},
    {"stl_nan_text", ".stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 nan 0\n", ":4", "finite"},
    {"stl_no_facets", ".stl", "solid a\nendsolid a\n", "", "no polygons"},
    // Abaqus
    {"inp_no_keyword", ".inp", "hello\n", ":1", "not an Abaqus"},
    {"inp_short_node", ".inp", "*NODE\n1\n", ":2", "coordinates"},
    {"inp_nan", ".inp", "*NODE\n1, 0, nan, 0\n", ":2", "'nan'"},
    {"inp_node_twice", ".inp", "*NODE\n1, 0, 0, 0\n1, 1, 0, 0\n", ":3", "defined twice"},
    {"inp_negative_id", ".inp", "*NODE\n-1, 0, 0, 0\n", ":2", "not positive"},
    {"inp_missing_node", ".inp", inp + "*ELEMENT, TYPE=S3\n1, 1, 2, 9\n", ":6", "node 9"},
    {"inp_too_many_nodes", ".inp", inp + "*ELEMENT, TYPE=S3\n1, 1, 2, 3, 1\n", ":6", "4 nodes"},
    {"inp_cut_off", ".inp", inp + "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3,\n", ":6", "element 1"},
    {"inp_element_twice", ".inp", inp + "*ELEMENT, TYPE=S3\n1, 1, 2, 3\n1, 1, 2, 3\n", ":7", "twice"},
    {"inp_tetrahedra", ".inp", inp + "*ELEMENT, TYPE=C3D4\n", ":5", "'C3D4'", ErrorKind::unsupported},
    {"inp_quadratic", ".inp", inp + "*ELEMENT, TYPE=C3D20\n", ":5", "'C3D20'", ErrorKind::unsupported},
    {"inp_include", ".inp", "*INCLUDE, INPUT=a.inp\n", ":1", "INCLUDE", ErrorKind::unsupported},
    {"inp_huge_set", ".inp",
     inp + "*ELEMENT, TYPE=S3\n1, 1, 2, 3\n*ELSET, ELSET=a, GENERATE\n1, 9000000000000000000, 0\n", ":8",
     "not positive"},
    {"inp_nothing", ".inp", inp, "", "no polygons"},
    // Gmsh
    {"msh_header", ".msh", "$Nodes\n", ":1", "$MeshFormat"},
    {"msh_version", ".msh", "$MeshFormat\n3.0 0 8\n", ":2", "'3.0'", ErrorKind::unsupported},
    {"msh_type", ".msh", "$MeshFormat\n2.2 7 8\n", ":2", "file type"},
    {"msh_binary_single", ".msh", "$MeshFormat\n2.2 1 4\n", ":2", "of 4 bytes", ErrorKind::unsupported},
    {"msh_binary_order", ".msh", "$MeshFormat\n2.2 1 8\n" + le32(2) + "\n$EndMeshFormat\n", ":byte",
     "byte order"},
    {"msh_binary_cut_off", ".msh",
     "$MeshFormat\n2.2 1 8\n" + le32(1) + "\n$EndMeshFormat\n$Nodes\n1\n" + le32(1) + le32(0), ":byte",
     "a coordinate should be"},
    {"msh_binary_huge", ".msh",
     "$MeshFormat\n4.1 1 8\n" + le32(1) + "\n$EndMeshFormat\n$Nodes\n" + le32(9) + le32(9) + le32(1) +
         le32(0),
     ":byte", "cannot hold"},
    {"msh_huge", ".msh", msh2 + "$Nodes\n999999999999\n1 0 0 0\n$EndNodes\n", ":5", "more than the rest"},
    {"msh_negative_tag", ".msh", msh2 + "$Nodes\n1\n-4 0 0 0\n$EndNodes\n", ":6", "positive"},
    {"msh_node_twice", ".msh", msh2 + "$Nodes\n2\n2 0 0 0\n2 0 0 1\n$EndNodes\n", ":8", "defined twice"},
    {"msh_no_nodes", ".msh", msh2, ":3", "no $Nodes"},
    {"msh_missing_node", ".msh",
     msh2 + "$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 2 0 1 1 7\n$EndElements\n", ":10", "node 7"},
    {"msh_tetrahedra", ".msh", msh2 + "$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 4 0 1 1 1 1\n", ":10",
     "type 4", ErrorKind::unsupported},
    {"msh_counts", ".msh",
     "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n3 1 0 1\n1\n0 0 0\n$EndNodes\n", ":8",
     "1 nodes, not 3"},
    {"msh_section", ".msh", msh2 + "$Strange\n1\n", ":4", "ends within $Strange"},
    // MFEM
    {"mfem_header", ".mfem", "mesh\n", ":1", "not a mesh of MFEM"},
    {"mfem_nurbs", ".mfem", "MFEM NURBS mesh v1.0\n", ":1", "NURBS", ErrorKind::unsupported},
    {"mfem_index", ".mfem", mfem + "1 2 0 1 3\nvertices\n3\n3\n0 0 0\n1 0 0\n0 1 0\n", ":6", "vertex 3"},
    {"mfem_attribute", ".mfem", mfem + "0 2 0 1 2\nvertices\n3\n3\n0 0 0\n1 0 0\n0 1 0\n", ":6",
     "attribute 0"},
    {"mfem_prism", ".mfem", mfem + "1 6 0 1 2 3 4 5\n", ":6", "type 6", ErrorKind::unsupported},
    {"mfem_no_vertices", ".mfem", mfem + "1 2 0 1 2\n", ":6", "no vertices"},
    {"mfem_plane", ".mfem", mfem + "1 2 0 1 2\nvertices\n3\n2\n0 0\n1 0\n0 1\n", ":9", "2 coordinates",
     ErrorKind::unsupported},
    {"mfem_curved", ".mfem", mfem + "1 2 0 1 2\nvertices\n3\nnodes\n", ":9", "curved",
     ErrorKind::unsupported},
    // OpenVolumeMesh
    {"ovm_header", ".ovm", "OFF\n", ":1", "not an OpenVolumeMesh"},
    {"ovm_binary", ".ovm", "OVM BINARY\n", ":1", "ASCII", ErrorKind::unsupported},
    {"ovm_edge", ".ovm", ovm + "Edges\n1\n0 3\n", ":9", "point index 3"},
    {"ovm_open_face", ".ovm", ovm + "Edges\n3\n0 1\n1 2\n2 0\nFaces\n1\n3 0 2 5\nPolyhedra\n0\n", ":14",
     "follow each other"},
    {"ovm_triangles_in_cell", ".ovm",
     ovm + "Edges\n3\n0 1\n1 2\n2 0\nFaces\n1\n3 0 2 4\nPolyhedra\n1\n6 0 0 0 0 0 0\n", ":17",
     "only hexahedra", ErrorKind::unsupported},
    {"ovm_tetrahedron", ".ovm", ovm + "Edges\n3\n0 1\n1 2\n2 0\nFaces\n1\n3 0 2 4\nPolyhedra\n1\n4 0 0 0 0\n",
     ":17", "only hexahedra", ErrorKind::unsupported},
    {"ovm_property", ".ovm", ovm + "Edges\n0\nFaces\n0\nPolyhedra\n0\nStrange int \"a\"\n", ":13",
     "'strange'"},
    // OBJ
    {"obj_index", ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ":4", "vertex 4 does not exist"},
    {"obj_zero", ".obj", "v 0 0 0\nf 0 1 1\n", ":2", "not '0'"},
    {"obj_negative", ".obj", "v 0 0 0\nf -1 -2 -1\n", ":2", "before the first"},
    {"obj_two_corners", ".obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", ":3", "2 corners"},
    {"obj_word", ".obj", "v 0 0 zero\n", ":1", "'zero'"},
    {"obj_infinite", ".obj", "v 0 0 inf\n", ":1", "finite"},
    {"obj_huge_index", ".obj", "v 0 0 0\nf 1 1 99999999999\n", ":2", "too large"},
    {"obj_no_faces", ".obj", "v 0 0 0\n", "", "no polygons"},
    // OFF
    {"off_header", ".off", "solid\n", ":1", "not an OFF file"},
    {"off_four_dimensions", ".off", "4OFF\n1 1 0\n", ":1", "three-dimensional", ErrorKind::unsupported},
    {"off_binary", ".off", "OFF BINARY\n", ":1", "binary", ErrorKind::unsupported},
    {"off_huge", ".off", "OFF\n123456789 1 0\n0 0 0\n", ":2", "more than the rest"},
    {"off_negative", ".off", "OFF\n-3 1 0\n", ":2", "negative"},
    {"off_index", ".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ":6", "point index 3"},
    {"off_two_corners", ".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", ":6", "2 corners"},
    {"off_cut_off", ".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1", ":6", "more than the rest"},
    // PLY
    {"ply_header", ".ply", "plywood\n", ":1", "not a PLY file"},
    {"ply_no_format", ".ply", "ply\nend_header\n", ":2", "no format"},
    {"ply_format", ".ply", "ply\nformat binary_middle_endian 1.0\n", ":2", "'binary_middle_endian'",
     ErrorKind::unsupported},
    {"ply_type", ".ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty quadruple x\n", ":4",
     "'quadruple'"},
    {"ply_faces_twice", ".ply",
     ply + "element face 1\nproperty list uchar int vertex_indices\n" + ply_faces +
         "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n",
     ":15", "faces a second time"},
    {"ply_no_xyz", ".ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n", ":5",
     "no x, y and z"},
    {"ply_index", ".ply", ply + ply_faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ":13", "point index 3"},
    {"ply_fraction", ".ply", ply + ply_faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n", ":13", "point index 1.5"},
    {"ply_huge_list", ".ply", ply + ply_faces + "0 0 0\n1 0 0\n0 1 0\n200 0 1 2\n", ":13", "does not fit"},
    {"ply_huge", ".ply", "ply\nformat ascii 1.0\nelement vertex 999999999\nproperty float x\nend_header\n",
     ":3", "more than the rest"},
    {"ply_property_first", ".ply", "ply\nformat ascii 1.0\nproperty float x\n", ":3", "before any element"},
    {"ply_no_properties", ".ply", "ply\nformat ascii 1.0\nelement a 5\nend_header\n0 0 0 0 0 0\n", ":4",
     "no properties"},
    // Medit
    {"mesh_header", ".mesh", "hello", ":1", "not a Medit file"},
    {"mesh_dimension", ".mesh", "MeshVersionFormatted 1\nDimension 2\n", ":2", "dimension 2",
     ErrorKind::unsupported},
    {"mesh_index", ".mesh", medit + "Triangles\n1\n1 2 4 0\n", ":10", "point index 4 is not in 1..3"},
    {"mesh_zero", ".mesh", medit + "Triangles\n1\n0 1 2 0\n", ":10", "point index 0"},
    {"mesh_tetrahedra", ".mesh", medit + "Tetrahedra\n1\n1 2 3 3 0\n", ":9", "Tetrahedra",
     ErrorKind::unsupported},
    {"mesh_huge", ".mesh", medit + "Hexahedra\n1000000000\n1 2 3 4", ":9", "more than the rest"},
    {"mesh_cut_off", ".mesh", medit + "Triangles\n1\n1 2\n", ":9", "more than the rest"},
    {"mesh_stray_number", ".mesh", medit + "17\n", ":8", "keyword should be here"},
    {"mesh_empty", ".mesh", medit + "End\n", "", "no polygons"},
};

void PrintTo(const Malformed& broken, std::ostream* out) {
    *out << broken.name;
}

class MalformedFile : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedFile, GetsOneClearLineWithItsPlace) {
    const Malformed& broken = GetParam();
    const TemporaryFolder folder;
    const auto path = folder / std::string(broken.name).append(broken.extension);
    test::write_text(path, broken.text);
    try {
        read_mesh_file(path);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), broken.kind) << error.what();
        EXPECT_EQ(error.where().find(path.string() + broken.place), 0u) << error.what();
        EXPECT_NE(error.problem().find(broken.words), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, MalformedFile, testing::ValuesIn(cases),
                         [](const auto& instance) { return instance.param.name; });

std::string message_of(const std::filesystem::path& path) {
    try {
        read_mesh_file(path);
    } catch (const Error& error) {
        EXPECT_EQ(exit_code(error.kind()), 3);
        return error.what();
    }
    return "accepted";
}

TEST(WhatIsNoFile, IsSaidToBeSo) {
    const TemporaryFolder folder;
    EXPECT_EQ(message_of(folder / "missing.vtk"), (folder / "missing.vtk").string() + ": no such file");
    EXPECT_EQ(message_of(folder / "missing.xyz"), (folder / "missing.xyz").string() + ": no such file");
    EXPECT_EQ(message_of(folder.path()), folder.path().string() + ": is a directory, not a file");
    test::write_text(folder / "empty.obj", "");
    EXPECT_EQ(message_of(folder / "empty.obj"), (folder / "empty.obj").string() + ": the file is empty");
    test::write_text(folder / "a.xyz", "x");
    EXPECT_NE(message_of(folder / "a.xyz").find("unknown file extension '.xyz'"), std::string::npos);
    test::write_text(folder / "plain", "x");
    EXPECT_NE(message_of(folder / "plain").find("without extension"), std::string::npos);
    ASSERT_EQ(::mkfifo((folder / "pipe.stl").c_str(), 0600), 0);
    EXPECT_EQ(message_of(folder / "pipe.stl"), (folder / "pipe.stl").string() + ": is not a regular file");
}

TEST(HexahedraThatAreNoMesh, AreRefusedWithTheFile) {
    const TemporaryFolder folder;
    std::string text = vtk + "POINTS 8 float\n";
    for (int i = 0; i < 8; ++i) text += std::to_string(i) + " 0 0\n";
    test::write_text(folder / "a.vtk", text + "CELLS 1 9\n8 0 1 2 3 4 5 6 6\nCELL_TYPES 1\n12\n");
    EXPECT_EQ(message_of(folder / "a.vtk").find((folder / "a.vtk").string() + ": cell 0"), 0u);
}

}  // namespace
}  // namespace hex::io
