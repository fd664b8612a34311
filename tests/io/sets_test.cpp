// Which part an element of an Abaqus or Gmsh file belongs to, by its sets and groups.
#include "io/small_files.h"

#include <hex/base/error.h>

#include <gtest/gtest.h>

#include <ctime>

namespace hex::io {
namespace {

/// `count` triangles with the ids first, first + step, ...
std::string abaqus_triangles(int count, int first = 1, int step = 1) {
    std::string text = "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n*ELEMENT, TYPE=S3\n";
    for (int i = 0; i < count; ++i) text += std::to_string(first + i * step) + ", 1, 2, 3\n";
    return text;
}

std::vector<std::string> names_of_elements(const SurfaceFile& file) {
    std::vector<std::string> names;
    for (const int part : file.soup.parts) {
        const auto name = file.part_names.find(part);
        names.push_back(name == file.part_names.end() ? "" : name->second);
    }
    return names;
}

std::vector<std::string> codes_of(const Diagnostics& diagnostics) {
    std::vector<std::string> codes;
    for (const Diagnostic& finding : diagnostics) codes.push_back(finding.code);
    return codes;
}

using Texts = std::vector<std::string>;

TEST(Abaqus, AnElementBelongsToTheFirstSetThatHasIt) {
    const auto file = surface_of(".inp", abaqus_triangles(6) +
                                             "*ELSET, ELSET=even, GENERATE\n2, 6, 2\n*ELSET, ELSET=low, "
                                             "GENERATE\n1, 3\n*ELSET, ELSET=Even\n5\n");
    EXPECT_EQ(names_of_elements(file), (Texts{"low", "even", "low", "even", "even", "even"}));
    EXPECT_EQ(codes_of(file.diagnostics), (Texts{"sets-overlap"}));
    // Ids with gaps, ranges that start and end in them, one set in pieces that meet.
    const auto gaps = surface_of(".inp", abaqus_triangles(5, 10, 10) +
                                             "*ELSET, ELSET=a\n10\n*ELSET, ELSET=b, GENERATE\n20, 40, "
                                             "20\n*ELSET, ELSET=b\n40\n*ELSET, ELSET=c\n50, 30\n");
    EXPECT_EQ(names_of_elements(gaps), (Texts{"a", "b", "c", "b", "c"}));
    EXPECT_TRUE(gaps.diagnostics.empty());
}

TEST(Abaqus, ASetOfAllElementsIsForThoseInNoOther) {
    const std::string all = "*ELSET, ELSET=all, GENERATE\n1, 4\n";
    EXPECT_EQ(names_of_elements(surface_of(".inp", abaqus_triangles(4) + all)),
              (Texts{"all", "all", "all", "all"}));
    const auto some = surface_of(".inp", abaqus_triangles(4) + all + "*ELSET, ELSET=two\n2\n");
    EXPECT_EQ(names_of_elements(some), (Texts{"all", "two", "all", "all"}));
    EXPECT_TRUE(some.diagnostics.empty());
    // Two progressions hold all, too.
    const auto none =
        surface_of(".inp", abaqus_triangles(4) + "*ELSET, ELSET=all, GENERATE\n1, 3, 2\n2, 4, 2\n" +
                               "*ELSET, ELSET=a\n1, 2\n*ELSET, ELSET=b\n3, 4\n");
    EXPECT_EQ(names_of_elements(none), (Texts{"a", "a", "b", "b"}));
    ASSERT_EQ(codes_of(none.diagnostics), (Texts{"sets-skipped"}));
    EXPECT_NE(none.diagnostics[0].message.find("'all'"), std::string::npos);
}

TEST(Abaqus, SetsWithElementsThatDoNotExistAreWarnedOf) {
    const auto message = [](const std::string& text) {
        const auto diagnostics = surface_of(".inp", abaqus_triangles(5) + text).diagnostics;
        return diagnostics.empty() ? std::string() : diagnostics[0].message;
    };
    EXPECT_NE(message("*ELSET, ELSET=a\n5, 3, 17\n").find("'a' names element 17"), std::string::npos);
    EXPECT_NE(message("*ELSET, ELSET=a, GENERATE\n2, 4000000000\n").find("'a' names element 6"),
              std::string::npos);
    EXPECT_NE(message("*ELSET, ELSET=a, GENERATE\n3, 9000000000000000000, 2\n").find("element 7"),
              std::string::npos);
    // Elements that are skipped do exist.
    const auto skipped = surface_of(".inp", abaqus_triangles(5) +
                                                "*ELEMENT, TYPE=B31\n6, 1, 2\n8, 1, 3\n*ELSET, ELSET=a, "
                                                "GENERATE\n2, 8, 2\n");
    EXPECT_EQ(codes_of(skipped.diagnostics), (Texts{"elements-skipped"}));
}

TEST(Abaqus, NodeSetsAndSurfacesAreWarnedOfOnce) {
    const auto file = surface_of(".inp", abaqus_triangles(1) +
                                             "*NSET, NSET=a\n1, 2\n*NSET, NSET=b\n3\n*SURFACE, "
                                             "NAME=top\nall, SPOS\n");
    ASSERT_EQ(codes_of(file.diagnostics), (Texts{"sets-skipped", "sets-skipped"}));
    EXPECT_NE(file.diagnostics[0].message.find("*NSET in line 7, 9"), std::string::npos);
    EXPECT_NE(file.diagnostics[1].message.find("*SURFACE in line 11"), std::string::npos);
}

/// Three triangles in surfaces 1, 2 and 7 of a Gmsh file in version 4.1.
std::string gmsh_triangles(const std::string& entities) {
    return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 2 \"soft\"\n2 9 "
           "\"hard\"\n$EndPhysicalNames\n" +
           entities +
           "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
           "$Elements\n3 3 1 3\n2 1 2 1\n1 1 2 3\n2 2 2 1\n2 1 2 3\n2 7 2 1\n3 1 2 3\n$EndElements\n";
}

TEST(Gmsh, AnEntityInNoGroupIsNoGroup) {
    const auto file = surface_of(
        ".msh", gmsh_triangles("$Entities\n0 0 3 0\n1 0 0 0 1 1 0 1 2 0\n2 0 0 0 1 1 0 0 0\n7 0 0 0 1 1 "
                               "0 1 9 0\n$EndEntities\n"));
    EXPECT_EQ(file.soup.parts, (std::vector<int>{2, 1, 9}));
    EXPECT_EQ(file.part_names, (PartNames{{2, "soft"}, {9, "hard"}}));
    ASSERT_EQ(codes_of(file.diagnostics), (Texts{"parts-renumbered"}));
    EXPECT_EQ(file.diagnostics[0].ids, (std::vector<std::int64_t>{2}));
    // Version 2.2 has the group and the entity with each element.
    const auto old =
        surface_of(".msh",
                   "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
                   "$Elements\n4\n1 2 2 5 3 1 2 3\n2 2 2 0 5 1 2 3\n3 2 2 0 1 1 2 3\n4 2 2 0 0 1 2 "
                   "3\n$EndElements\n");
    EXPECT_EQ(old.soup.parts, (std::vector<int>{5, 2, 1, 0}));
}

TEST(Gmsh, AnElementInTwoGroupsBelongsToTheFirst) {
    const auto old =
        surface_of(".msh",
                   "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
                   "$Elements\n3\n1 2 2 5 3 1 2 3\n2 2 2 6 4 1 2 3\n3 2 2 6 3 1 2 3\n$EndElements\n");
    EXPECT_EQ(old.soup.parts, (std::vector<int>{5, 6}));
    EXPECT_EQ(codes_of(old.diagnostics), (Texts{"groups-overlap"}));
    const auto file = surface_of(
        ".msh", gmsh_triangles("$Entities\n0 0 3 0\n1 0 0 0 1 1 0 2 2 9 0\n2 0 0 0 1 1 0 1 2 0\n7 0 0 0 1 1 "
                               "0 1 9 0\n$EndEntities\n"));
    EXPECT_EQ(file.soup.parts, (std::vector<int>{2, 2, 9}));
    EXPECT_EQ(codes_of(file.diagnostics), (Texts{"groups-overlap"}));
}

TEST(Gmsh, AMinusBeforeAGroupIsItsSide) {
    const auto file = surface_of(
        ".msh", gmsh_triangles("$Entities\n0 0 3 0\n1 0 0 0 1 1 0 1 -2 0\n2 0 0 0 1 1 0 1 2 0\n7 0 0 0 1 1 "
                               "0 1 9 0\n$EndEntities\n"));
    EXPECT_EQ(file.soup.parts, (std::vector<int>{2, 2, 9}));
    EXPECT_TRUE(file.diagnostics.empty());
}

TEST(Gmsh, ElementsOfPartitionsBelongToTheGroupsOfTheirEntities) {
    const std::string whole = "$Entities\n0 0 2 0\n1 0 0 0 1 1 0 1 9 0\n4 0 0 0 1 1 0 0 0\n$EndEntities\n";
    // 1 and 2 are halves of surface 1, 7 is one of surface 4; points and ghosts are passed over.
    const auto file = surface_of(
        ".msh",
        gmsh_triangles(
            whole + "$PartitionedEntities\n2\n1\n20 1\n1 0 3 0\n1 0 1 1 2 0 0 0 0\n"
                    "1 2 1 1 1 0 0 0 1 1 0 1 9 0\n2 2 1 1 2 0 0 0 1 1 0 1 9 0\n7 2 4 2 1 2 0 0 0 1 1 0 0 1 "
                    "-3\n$EndPartitionedEntities\n"));
    EXPECT_EQ(file.soup.parts, (std::vector<int>{9, 9, 4}));
    EXPECT_TRUE(file.diagnostics.empty());
}

TEST(Abaqus, ReferencePointsOfTheAssemblyHaveNumbersOfTheirOwn) {
    const std::string mesh = abaqus_triangles(1);
    const std::string points = "*NODE\n1, 5, 5, 5\n*NSET, NSET=point, INTERNAL\n1\n*END ASSEMBLY\n";
    const auto of_part = surface_of(".inp", "*PART, NAME=p\n" + mesh +
                                                "*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=p-1, "
                                                "PART=p\n*END INSTANCE\n" +
                                                points);
    const auto of_instance =
        surface_of(".inp", "*PART, NAME=p\n*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=p-1, PART=p\n" +
                               mesh + "*END INSTANCE\n" + points);
    for (const auto& file : {of_part, of_instance}) {
        EXPECT_EQ(file.soup.points, surface_of(".inp", mesh).soup.points);
        EXPECT_EQ(file.soup.size(), 1u);
        EXPECT_EQ(codes_of(file.diagnostics), (Texts{"nodes-skipped", "sets-skipped"}));
    }
}

TEST(Abaqus, SetsOfTheAssemblyAreNotThoseOfThePart) {
    const auto file = surface_of(
        ".inp", "*PART, NAME=p\n" + abaqus_triangles(3) +
                    "*ELSET, ELSET=Set-1\n1\n*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=i, PART=p\n*END "
                    "INSTANCE\n*ELSET, ELSET=SET-1, INSTANCE=i\n3\n*END ASSEMBLY\n");
    EXPECT_EQ(file.soup.parts, (std::vector<int>{1, 3, 2}));
    EXPECT_EQ(file.part_names, (PartNames{{1, "Set-1"}, {2, "Assembly.SET-1"}}));
}

TEST(Abaqus, ParametersOfElementSetsMayBeCutShort) {
    const std::string mesh = abaqus_triangles(4);
    const auto whole = surface_of(".inp", mesh + "*ELSET, ELSET=a, GENERATE\n1, 3, 1\n");
    EXPECT_EQ(surface_of(".inp", mesh + "*ELSET, ELSET=a, gen, UNSORTED\n1, 3, 1\n").soup.parts,
              whole.soup.parts);
    EXPECT_NE(surface_of(".inp", mesh + "*ELSET, ELSET=a\n1, 3, 1\n").soup.parts, whole.soup.parts);
    EXPECT_THROW(surface_of(".inp", mesh + "*ELSET, ELSET=a, GENERATED\n1, 3, 1\n"), Error);
}

TEST(Abaqus, SetsThatOverlapManyTimesTakeLittleTime) {
    constexpr int count = 20000;
    std::string whole = abaqus_triangles(count), every_second = whole, far = whole;
    for (int i = 1; i <= count; ++i) {
        const std::string head = "*ELSET, ELSET=a" + std::to_string(i) + ", GENERATE\n1, ";
        whole += head + std::to_string(count) + "\n";
        every_second += head + std::to_string(count - i % 9) + ", 2\n";
        far += head + "4000000000\n";
    }
    for (const std::string& text : {whole, every_second, far}) {
        const auto start = std::clock();
        surface_of(".inp", text);
        // Processor time. Going through the elements of each set takes 4 * 10^8 steps.
        EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 1.5);
    }
}

}  // namespace
}  // namespace hex::io
