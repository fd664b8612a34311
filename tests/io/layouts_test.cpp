// One small file for each layout that a format is found in.
#include "io/small_files.h"

#include <hex/base/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

namespace hex::io {
namespace {

std::string with_crlf(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\n') result += '\r';
        result += c;
    }
    return result;
}

/// A unit square of one quadrilateral 0 1 2 3, or the two triangles 0 1 2 and 0 2 3.
void expect_square(const PolygonSoup& soup, bool triangles = true) {
    ASSERT_EQ(soup.points.size(), 4u);
    EXPECT_EQ(soup.points[0], Vec3(0, 0, 0));
    EXPECT_EQ(soup.points[1], Vec3(1, 0, 0));
    EXPECT_EQ(soup.points[2], Vec3(1, 1, 0));
    EXPECT_EQ(soup.points[3], Vec3(0, 1, 0));
    EXPECT_EQ(soup.corners, triangles ? (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3})
                                      : (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

/// The unit cube, corners in the order of the nodes.
void expect_cube(const HexMesh& mesh) {
    ASSERT_EQ(mesh.vertex_count(), 8u);
    ASSERT_EQ(mesh.cell_count(), 1u);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(mesh.cell(CellId(0))[i], VertexId(i));
        const auto uvw = hexahedron::corner_uvw[i];
        EXPECT_EQ(mesh.position(VertexId(i)), Vec3(uvw[0], uvw[1], uvw[2]));
    }
}

// --- LS-DYNA ---

const std::string fixed_nodes =
    "*NODE\n"
    "       1             0.0             0.0             0.0       0       0\n"
    "       2             1.0             0.0             0.0       0       0\n"
    "       3             1.0             1.0             0.0       0       0\n"
    "       4             0.0             1.0             0.0       0       0\n";
const std::string fixed_shells =
    "*ELEMENT_SHELL\n"
    "       1       4       1       2       3       3       0       0       0       0\n"
    "       2       5       1       3       4       4       0       0       0       0\n";

TEST(LsDyna, FixedColumns) {
    const auto file = surface_of(".k", "$ comment\n*KEYWORD\n" + fixed_shells + fixed_nodes + "*END\n");
    expect_square(file.soup);
    EXPECT_EQ(file.soup.parts, (std::vector<int>{4, 5}));
    EXPECT_TRUE(file.diagnostics.empty());
}

TEST(LsDyna, NodesBeforeElementsAndCrlf) {
    expect_square(surface_of(".k", with_crlf("*KEYWORD\n" + fixed_nodes + fixed_shells + "*END\n")).soup);
}

TEST(LsDyna, ByteOrderMarkAndLowerCaseKeywords) {
    expect_square(surface_of(".k",
                             "\xEF\xBB\xBF*keyword\n*node\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*element_"
                             "shell\n1,1,1,2,3,3\n2,1,1,3,4,4\n*end\n")
                      .soup);
}

TEST(LsDyna, CommasWithAndWithoutBlanks) {
    expect_square(
        surface_of(
            ".k",
            "*KEYWORD\n*ELEMENT_SHELL\n1, 5, 1, 2, 3, 3, 0, 0, 0, 0\n2,5,1,3,4,4\n*NODE\n1,0 ,0.0 ,0 \n"
            "2, 1.0, 0, 0, 0, 0\n3,1,1,0\n4,0,1e0,0\n*END\n")
            .soup);
}

TEST(LsDyna, Blanks) {
    expect_square(surface_of(".k",
                             "*KEYWORD\n*ELEMENT_SHELL\n1 5 1 2 3 3\n2 5 1 3 4 4 0 0 0 0\n*NODE\n1 0 0 0\n2 "
                             "1 0.0 0\n3 1.0 1.0 0.0\n4 0 1 0\n*END\n")
                      .soup);
}

TEST(LsDyna, ColumnsWiderThanEightAreReadAsBlankSeparated) {
    expect_square(
        surface_of(
            ".k",
            "*KEYWORD\n*ELEMENT_SHELL\n"
            "1         5         1         2         3         3\n"
            "         2         5         1         3         4         4\n*NODE\n"
            "       1   0.0000000000000000e+00   0.0000000000000000e+00   0.0000000000000000e+00\n"
            "       2   1.0000000000000000e+00   0.0000000000000000e+00   0.0000000000000000e+00\n"
            "       3   1.0000000000000000e+00   1.0000000000000000e+00   0.0000000000000000e+00\n"
            "       4   0.0000000000000000e+00   1.0000000000000000e+00   0.0000000000000000e+00\n*END\n")
            .soup);
}

TEST(LsDyna, FullColumnsMayTouch) {
    const auto file = surface_of(
        ".k",
        "*KEYWORD\n*NODE\n"
        "12345671-1.2345678901234-1.2345678901234-1.2345678901234       0       0\n"
        "12345672  1.000000000000-1.2345678901234 1.0000000000000       0       0\n"
        "12345673             1.0             0.0             1.0       0       0\n"
        "*ELEMENT_SHELL\n"
        "99999999       1123456711234567212345673       0       0       0       0       0\n*END\n");
    ASSERT_EQ(file.soup.points.size(), 3u);
    EXPECT_EQ(file.soup.points[0], Vec3(-1.2345678901234, -1.2345678901234, -1.2345678901234));
    EXPECT_EQ(file.soup.points[1], Vec3(1, -1.2345678901234, 1));
    EXPECT_EQ(file.soup.corners, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(LsDyna, QuadrilateralsAndFourthNodeZero) {
    const auto soup =
        surface_of(".k", "*KEYWORD\n" + fixed_nodes + "*ELEMENT_SHELL\n1,1,1,2,3,4\n2,1,1,2,3,0\n*END\n")
            .soup;
    EXPECT_EQ(soup.polygon(0).size(), 4u);
    EXPECT_EQ(soup.polygon(1).size(), 3u);
}

TEST(LsDyna, IdsWithGapsInAnyOrder) {
    const auto soup = surface_of(".k",
                                 "*KEYWORD\n*ELEMENT_SHELL\n70,1,900,5,30,30\n8,1,900,30,17,17\n*NODE\n900,0,"
                                 "0,0\n5,1,0,0\n30,1,1,0\n17,0,1,0\n*END\n")
                          .soup;
    expect_square(soup);
}

TEST(LsDyna, UnknownKeywordsAreWarnedOnceAndSkipped) {
    const auto file =
        surface_of(".k",
                   "*KEYWORD\n*TITLE\nsome "
                   "title\n*ELEMENT_SHELL_THICKNESS\n7,1,1,2,3,3\n0.1,0.1,0.1\n*SET_NODE_LIST\n1\n" +
                       fixed_shells + fixed_nodes + "*SET_NODE_LIST\n2\n*END\nanything\n");
    expect_square(file.soup);
    ASSERT_EQ(file.diagnostics.size(), 2u);
    EXPECT_EQ(file.diagnostics[0].code, "unknown-keyword");
    EXPECT_EQ(file.diagnostics[0].ids, (std::vector<std::int64_t>{4}));
    EXPECT_EQ(file.diagnostics[1].ids, (std::vector<std::int64_t>{7, 17}));
    EXPECT_NE(file.diagnostics[1].message.find("a.k:7: keyword '*SET_NODE_LIST'"), std::string::npos)
        << file.diagnostics[1].message;
}

const std::string cube_nodes =
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n";

TEST(LsDyna, SolidsOnOneLineAndOnTwo) {
    const auto one = hexahedra_of(".k",
                                  "*KEYWORD\n*ELEMENT_SOLID\n      63      63       1       2       3       "
                                  "4       5       6       7       8\n" +
                                      cube_nodes + "*END\n");
    expect_cube(one.mesh);
    EXPECT_EQ(one.mesh.part(CellId(0)), 63);
    const auto two =
        hexahedra_of(".k",
                     "*KEYWORD\n*ELEMENT_SOLID (ten nodes format)\n      63       9\n"
                     "       1       2       3       4       5       6       7       8       0       0\n" +
                         cube_nodes + "*END\n");
    expect_cube(two.mesh);
    EXPECT_EQ(two.mesh.part(CellId(0)), 9);
}

// --- VTK legacy ---

const std::string vtk_square = "POINTS 4 float\n0 0 0 1 0 0\n1 1 0\n0 1 0\n";
const std::string vtk_cube = "POINTS 8 FLOAT\n0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\n";

TEST(LegacyVtk, AsciiGridWithPartIdsOfManyNames) {
    for (const std::string name : {"part", "pid", "patches", "Part_ID"}) {
        const auto file = surface_of(
            ".vtk", "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n" + vtk_square +
                        "CELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5\n5\nCELL_DATA 2\nSCALARS " + name +
                        " float\nLOOKUP_TABLE default\n3\n4\nPOINT_DATA 4\nVECTORS v double\n1 2 3 4 5 6 7 8 "
                        "9 nan 11 12\n");
        expect_square(file.soup);
        EXPECT_EQ(file.soup.parts, (std::vector<int>{3, 4})) << name;
        EXPECT_TRUE(file.diagnostics.empty());
    }
}

TEST(LegacyVtk, PartIdsThatAnIntegerCannotHoldAreSkipped) {
    for (const std::string value : {"2147483648", "-2147483649", "1.5"}) {
        const auto file = surface_of(
            ".vtk", "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n" + vtk_square +
                        "CELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5\n5\nCELL_DATA 2\nSCALARS part double\n"
                        "LOOKUP_TABLE default\n7\n" +
                        value + "\n");
        EXPECT_EQ(file.soup.parts, (std::vector<int>{1, 1})) << value;
        ASSERT_EQ(file.diagnostics.size(), 1u) << value;
        EXPECT_NE(file.diagnostics[0].message.find("no integers of 32 bits"), std::string::npos);
    }
}

TEST(LegacyVtk, CrlfTabsLowerCaseAndFieldData) {
    expect_cube(hexahedra_of(".vtk", with_crlf("# vtk DataFile Version 3.1 \nfor LSEConsole\nascii\ndataset "
                                               "unstructured_grid\nFIELD FieldData 1\nTIME 1 1 double\n0\n" +
                                               vtk_cube +
                                               "CELLS 1 9\n8\t0\t1\t2\t3\t4\t5\t6\t7\n\nCELL_TYPES 1\n12\n"))
                    .mesh);
}

TEST(LegacyVtk, Version5WithOffsetsAndMetadata) {
    expect_cube(
        hexahedra_of(".vtk", "# vtk DataFile Version 5.1\nvtk output\nASCII\nDATASET UNSTRUCTURED_GRID\n" +
                                 vtk_cube +
                                 "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 "
                                 "0 1.7\n\nCELLS 2 8\nOFFSETS vtktypeint64\n0 8\n"
                                 "CONNECTIVITY vtktypeint64\n0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n\nCELL_DATA "
                                 "1\nFIELD FieldData 1\npid 1 1 int\n1\nMETADATA\nINFORMATION 0\n\n")
            .mesh);
}

TEST(LegacyVtk, PolyDataWithStrips) {
    const auto soup =
        surface_of(".vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n" + vtk_square +
                               "POLYGONS 1 4\n3 0 1 2\nTRIANGLE_STRIPS 1 5\n4 0 1 3 2\n")
            .soup;
    EXPECT_EQ(soup.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 3, 3, 1, 2}));
}

TEST(LegacyVtk, PointsAndLinesAreSkippedWithAWarning) {
    const auto file =
        surface_of(".vtk", "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n" + vtk_square +
                               "CELLS 4 13\n3 0 1 2\n2 0 1\n1 3\n3 0 2 3\nCELL_TYPES 4\n5 3 1 5\nCELL_DATA "
                               "4\nSCALARS part int 1\nLOOKUP_TABLE default\n7 8 9 10\n");
    expect_square(file.soup);
    EXPECT_EQ(file.soup.parts, (std::vector<int>{7, 10}));
    ASSERT_EQ(file.diagnostics.size(), 1u);
    EXPECT_EQ(file.diagnostics[0].ids, (std::vector<std::int64_t>{1, 2}));
}

TEST(LegacyVtk, VoxelsAndPixelsAreRings) {
    expect_cube(hexahedra_of(".vtk", "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n" +
                                         vtk_cube + "CELLS 1 9\n8 0 1 3 2 4 5 7 6\nCELL_TYPES 1\n11\n")
                    .mesh);
    expect_square(surface_of(".vtk", "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n" +
                                         vtk_square + "CELLS 1 5\n4 0 1 3 2\nCELL_TYPES 1\n8\n")
                      .soup,
                  false);
}

template <class Number>
std::string big_endian(std::initializer_list<Number> numbers) {
    std::string text;
    for (const Number number : numbers) {
        auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
        if constexpr (std::endian::native == std::endian::little) std::reverse(bytes.begin(), bytes.end());
        text.append(bytes.data(), bytes.size());
    }
    return text;
}

TEST(LegacyVtk, BinaryInBothCellLayouts) {
    const std::string start = "# vtk DataFile Version 4.2\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\n";
    // 32 is a blank: a coordinate made of blanks must not be mistaken for one.
    const std::string points =
        "POINTS 4 double\n" + big_endian<double>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + "\n";
    const std::string old_cells = "CELLS 2 8\n" + big_endian<std::int32_t>({3, 0, 1, 2, 3, 0, 2, 3}) + "\n";
    const std::string new_cells = "CELLS 3 6\nOFFSETS vtktypeint64\n" + big_endian<std::int64_t>({0, 3, 6}) +
                                  "\nCONNECTIVITY vtktypeint64\n" +
                                  big_endian<std::int64_t>({0, 1, 2, 0, 2, 3}) + "\n";
    const std::string types = "CELL_TYPES 2\n" + big_endian<std::int32_t>({5, 5}) + "\n";
    const std::string parts = "POINT_DATA 4\nSCALARS s float 1\nLOOKUP_TABLE default\n" +
                              big_endian<float>({1, 2, 3, 4}) +
                              "\nCELL_DATA 2\nSCALARS pid short 1\nLOOKUP_TABLE default\n" +
                              big_endian<std::int16_t>({6, 7}) + "\n";
    for (const std::string& cells : {old_cells, new_cells}) {
        const auto file = surface_of(".vtk", start + points + cells + types + parts);
        expect_square(file.soup);
        EXPECT_EQ(file.soup.parts, (std::vector<int>{6, 7}));
    }
}

TEST(LegacyVtk, BinaryDataMayStartWithBlanks) {
    // 0x2020202020202020 is a small double made of eight blanks, 0x0A... one of line ends.
    const double blanks = std::bit_cast<double>(std::uint64_t{0x2020202020202020u});
    const double line_ends = std::bit_cast<double>(std::uint64_t{0x0A0A0A0A0A0A0A0Au});
    const auto soup =
        surface_of(".vtk", "# vtk DataFile Version 4.2\nt\nBINARY\nDATASET POLYDATA\nPOINTS 3 double\n" +
                               big_endian<double>({line_ends, blanks, 0, 1, 0, 0, 1, 1, 0}) +
                               "\nPOLYGONS 1 4\n" + big_endian<std::int32_t>({3, 0, 1, 2}) + "\n")
            .soup;
    EXPECT_EQ(soup.points[0], Vec3(line_ends, blanks, 0));
}

// --- the others ---

TEST(LsDyna, TitlesOfPartsAreTheirNames) {
    const auto file = surface_of(
        ".k",
        "*KEYWORD\n*PART\n$# title\nshaft, left\n$#     pid     secid       mid\n         4         1       "
        "  1\n*PART\n\n         5         1         1\n*PART\nnot here\n9,1,1\n" +
            fixed_shells + fixed_nodes + "*END\n");
    expect_square(file.soup);
    EXPECT_EQ(file.part_names, (PartNames{{4, "shaft, left"}}));
    EXPECT_TRUE(file.diagnostics.empty());
    // Several parts under one keyword.
    EXPECT_EQ(
        surface_of(".k", "*KEYWORD\n*PART\na\n4,1,1\n5 is b\n5\n" + fixed_shells + fixed_nodes + "*END\n")
            .part_names,
        (PartNames{{4, "a"}, {5, "5 is b"}}));
}

TEST(LsDyna, ManyWarningsOfOneKindAreCounted) {
    std::string unknown;
    for (int i = 0; i < 500; ++i) unknown += "*FOO_" + std::to_string(i) + "\n1,2\n";
    const auto file = surface_of(".k", "*KEYWORD\n" + unknown + fixed_shells + fixed_nodes);
    ASSERT_EQ(file.diagnostics.size(), 22u);
    EXPECT_EQ(file.diagnostics.front().code, "no-end");
    EXPECT_NE(file.diagnostics.back().message.find("a.k: 480 more findings of this kind (unknown-keyword)"),
              std::string::npos)
        << file.diagnostics.back().message;
}

TEST(Obj, SlashesNegativeIndicesContinuationsAndComments) {
    const auto file = surface_of(
        ".obj",
        "# c\nmtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nvt 0 0\nvn 0 0 1\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\n"
        "g left\nusemtl m\ns 1\nf 1/1/1 2//1 3/1\nf -4 \\\n -2/1 \\\r\n-1 # end\nl 1 2\n");
    expect_square(file.soup);
    ASSERT_EQ(file.diagnostics.size(), 1u);
    EXPECT_EQ(file.diagnostics[0].ids, (std::vector<std::int64_t>{17}));
}

TEST(Obj, FacesMayComeBeforeTheirVertices) {
    expect_square(surface_of(".obj", "f 1 2 3\nf 1 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0").soup);
}

TEST(Off, HeaderVariantsCommentsAndColours) {
    const std::string faces = "3 0 1 2 255 0 0\n3 0 2 3\n";
    expect_square(
        surface_of(".off", "OFF\n# c\n4 2 0\n\n0 0 0\n1 0 0\n1 1 0 # corner\n0 1 0\n" + faces).soup);
    expect_square(surface_of(".off", "OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + faces).soup);
    expect_square(surface_of(".off", "OFF\n4 2\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + faces).soup);
    expect_square(
        surface_of(
            ".off",
            "COFF\n4 2 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n1 1 0 1 1 1 1\n0 1 0 1 1 1 1\n" + faces)
            .soup);
    expect_square(
        surface_of(".off", "STCNOFF\n4 2 0\n0 0 0 1 2 3 4 5\n1 0 0 9\n1 1 0 9\n0 1 0 9\n" + faces).soup);
    expect_square(
        surface_of(".off", "NOFF\n4 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n")
            .soup,
        false);
}

const std::string ply_header =
    "element vertex 4\ncomment c\nproperty float x\nproperty uchar red\nproperty double y\nproperty float z\n"
    "element edge 1\nproperty int vertex1\nproperty int vertex2\nelement face 2\nproperty list uchar int "
    "vertex_indices\nproperty short part\nend_header\n";

TEST(Off, TextAfterTheLastFaceIsWarnedOf) {
    const auto file =
        surface_of(".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 # a comment\n\nmore stuff\n");
    ASSERT_EQ(file.diagnostics.size(), 1u);
    EXPECT_EQ(file.diagnostics[0].code, "extra-text");
    EXPECT_NE(file.diagnostics[0].message.find("a.off:8: text after the last face is skipped: 'more stuff'"),
              std::string::npos)
        << file.diagnostics[0].message;
}

TEST(Surfaces, FacesThatNameAPointTwiceAreWarnedOf) {
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    for (const auto& file : {surface_of(".off", "OFF\n3 2 0\n" + points + "3 0 1 2\n3 0 0 1\n"),
                             surface_of(".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 1 2\n")}) {
        ASSERT_EQ(file.diagnostics.size(), 1u);
        EXPECT_EQ(file.diagnostics[0].code, "repeated-corners");
        EXPECT_EQ(file.diagnostics[0].ids, (std::vector<std::int64_t>{1}));
        EXPECT_EQ(file.soup.size(), 2u);
    }
}

TEST(Ply, AsciiWithExtraElementsAndProperties) {
    const auto file =
        surface_of(".ply", "ply\nformat ascii 1.0\nobj_info i\n" + ply_header +
                               "0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0\n0 1\n3 0 1 2 5\n3 0 2 3 6\n");
    expect_square(file.soup);
    EXPECT_EQ(file.soup.parts, (std::vector<int>{5, 6}));
}

TEST(Ply, WhatTheHeaderDoesNotCountIsWarnedOf) {
    const auto warnings = [](const std::string& format, const std::string& data) {
        return surface_of(".ply",
                          "ply\nformat " + format +
                              " 1.0\nelement vertex 3\nproperty char x\nproperty char y\nproperty char "
                              "z\nelement face 1\nproperty list char char vertex_indices\nend_header\n" +
                              data)
            .diagnostics;
    };
    const std::string ascii = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_TRUE(warnings("ascii", ascii + "\n ").empty());
    const auto found = warnings("ascii", ascii + "\n3 0 2 1\n");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].code, "extra-text");
    EXPECT_EQ(found[0].ids, (std::vector<std::int64_t>{15}));

    const std::string binary("\0\0\0\1\0\0\0\1\0\3\0\1\2", 13);
    EXPECT_TRUE(warnings("binary_little_endian", binary).empty());
    EXPECT_EQ(warnings("binary_little_endian", binary + '\0').at(0).code, "extra-bytes");
}

template <class Number>
void append(std::string& text, Number number, std::endian order) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    text.append(bytes.data(), bytes.size());
}

TEST(Ply, BinaryInBothByteOrders) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        std::string data;
        for (const auto& [x, y] :
             {std::pair(0.f, 0.), std::pair(1.f, 0.), std::pair(1.f, 1.), std::pair(0.f, 1.)}) {
            append(data, x, order);
            append(data, std::uint8_t{10}, order);
            append(data, y, order);
            append(data, 0.f, order);
        }
        append(data, std::int32_t{0}, order);
        append(data, std::int32_t{1}, order);
        for (const std::array<std::int32_t, 3>& face :
             {std::array<std::int32_t, 3>{0, 1, 2}, std::array<std::int32_t, 3>{0, 2, 3}}) {
            append(data, std::uint8_t{3}, order);
            for (const std::int32_t v : face) append(data, v, order);
            append(data, std::int16_t{-3}, order);
        }
        const auto file = surface_of(".ply", std::string("ply\r\nformat binary_") +
                                                 (order == std::endian::little ? "little" : "big") +
                                                 "_endian 1.0\r\n" + with_crlf(ply_header) + data);
        expect_square(file.soup);
        EXPECT_EQ(file.soup.parts, (std::vector<int>{-3, -3}));
    }
}

std::string binary_stl(const std::string& header, const std::vector<std::array<Vec3, 3>>& triangles) {
    std::string text = header;
    text.resize(80);
    append(text, static_cast<std::uint32_t>(triangles.size()), std::endian::little);
    for (const auto& triangle : triangles) {
        for (int i = 0; i < 3; ++i) append(text, 0.f, std::endian::little);
        for (const Vec3& p : triangle) {
            for (int k = 0; k < 3; ++k) append(text, static_cast<float>(p[k]), std::endian::little);
        }
        append(text, std::uint16_t{0}, std::endian::little);
    }
    return text;
}

const std::vector<std::array<Vec3, 3>> square_triangles = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)},
                                                           {Vec3(-0.0, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}};

TEST(Stl, BinaryIsToldByItsSizeNotByItsFirstWord) {
    expect_square(surface_of(".stl", binary_stl("made by somebody", square_triangles)).soup);
    const std::string rock = binary_stl("solid as a rock", square_triangles);
    expect_square(surface_of(".stl", rock).soup);
    const auto longer = surface_of(".stl", rock + "\r\n");
    expect_square(longer.soup);
    ASSERT_EQ(longer.diagnostics.size(), 1u);
    EXPECT_EQ(longer.diagnostics[0].code, "extra-bytes");
}

TEST(Stl, WeldsEqualCoordinatesAndDropsDegenerateTriangles) {
    auto triangles = square_triangles;
    triangles.push_back({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -0.0)});
    const auto file = surface_of(".stl", binary_stl("", triangles));
    expect_square(file.soup);
    ASSERT_EQ(file.diagnostics.size(), 1u);
    EXPECT_EQ(file.diagnostics[0].ids, (std::vector<std::int64_t>{2}));
}

TEST(Stl, AsciiInAnyCaseWithSeveralSolids) {
    const std::string head = "facet normal nan 0 1\n outer loop\n", tail = "endloop\nendfacet\n";
    const auto file =
        surface_of(".stl", "solid a solid name\n" + head + "vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n" +
                               tail + "endsolid a\nSOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\n" +
                               "VERTEX 0 0 0\nVERTEX 1e0 1.0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID\n");
    expect_square(file.soup);
    EXPECT_EQ(file.soup.parts, (std::vector<int>{1, 2}));
}

TEST(Medit, TokensMayBeSplitOverLinesAnyHow) {
    const auto file = hexahedra_of(".mesh",
                                   "MeshVersionFormatted\n2 # c\nDimension\n3\nVertices 8 0 0 0 0\n1 0 0 0 1 "
                                   "1 0 0 0 1 0\n0 0 0 1 0 1 0 1 0\n1 1 1 0 0 1 1 0\n"
                                   "Corners\n1\n1\nEdges 1 1 2 0\nQuadrilaterals\n1\n1 2 3 4 9\nSomething "
                                   "1\n-3\nHexahedra\n1\n1 2 3 4 5\n6 7 8 -4\nEnd\n");
    expect_cube(file.mesh);
    EXPECT_EQ(count_at_least(file.diagnostics, Severity::warning), 1u);
}

TEST(Medit, ReferencesArePartIdsUnlessAllAreOneNonPositiveNumber) {
    const std::string start =
        "MeshVersionFormatted 1\nDimension 3\nVertices\n4\n0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 "
        "1\nTriangles\n2\n";
    EXPECT_EQ(surface_of(".mesh", start + "1 2 3 0\n1 3 4 2\nEnd").soup.parts, (std::vector<int>{0, 2}));
    const auto file = surface_of(".mesh", start + "1 2 3 0\n1 3 4 0\nEnd");
    expect_square(file.soup);
    EXPECT_EQ(file.soup.parts, (std::vector<int>{1, 1}));
}

TEST(Vtu, AsciiAndInlineBase64) {
    // A compressor may be named where nothing is compressed.
    const auto vtu = [](const std::string& types, const char* compressor = "") {
        return "\xEF\xBB\xBF<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" "
               "byte_order=\"LittleEndian\" compressor=\"" +
               std::string(compressor) +
               "\"><UnstructuredGrid>"
               "<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\"><CellData><DataArray type=\"Float32\" "
               "Name=\"part\" format=\"ascii\">3 4</DataArray></CellData>"
               "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 "
               "1 0 0 1 0</DataArray></Points><Cells>"
               "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2\n0 2 3</DataArray>"
               "<DataArray type=\"Int64\" Name=\"offsets\">3 6</DataArray>" +
               types + "</Cells></Piece></UnstructuredGrid></VTKFile>";
    };
    const std::string types = "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5 5</DataArray>";
    const auto file = surface_of(".vtu", vtu(types));
    expect_square(file.soup);
    expect_square(surface_of(".vtu", vtu(types, "vtkLZ4DataCompressor")).soup);
    EXPECT_EQ(file.soup.parts, (std::vector<int>{3, 4}));
    // Header (4 bytes: 2) and data (5 5), encoded together and apart.
    expect_square(
        surface_of(
            ".vtu",
            vtu("<DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">\n  AgAAAAUF\n</DataArray>"))
            .soup);
    expect_square(
        surface_of(".vtu",
                   vtu("<DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">AgAAAA==BQU=</DataArray>"))
            .soup);
}

}  // namespace
}  // namespace hex::io
