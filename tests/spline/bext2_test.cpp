#include "spline_samples.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <spline/io/bext.h>
#include <spline/io/bext2.h>
#include <spline/io/deck.h>
#include <spline/io/spline_json.h>
#include <spline/jacobian.h>
#include <spline/spline.h>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace spline::test {
namespace {

void expect_equal(const io::Bext2& a, const io::Bext2& b) {
    EXPECT_EQ(a.patch, b.patch);
    EXPECT_EQ(a.weight_flag, b.weight_flag);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.weights, b.weights);
    ASSERT_EQ(a.blocks.size(), b.blocks.size());
    for (std::size_t i = 0; i < a.blocks.size(); ++i) {
        EXPECT_EQ(a.blocks[i].type, b.blocks[i].type);
        EXPECT_EQ(a.blocks[i].degrees, b.blocks[i].degrees);
        EXPECT_EQ(a.blocks[i].elements, b.blocks[i].elements);
        EXPECT_EQ(a.blocks[i].nodes, b.blocks[i].nodes);
        EXPECT_EQ(a.blocks[i].vectors, b.blocks[i].vectors);
    }
    ASSERT_EQ(a.groups.size(), b.groups.size());
    for (std::size_t i = 0; i < a.groups.size(); ++i) {
        EXPECT_EQ(a.groups[i].length, b.groups[i].length);
        EXPECT_EQ(a.groups[i].values, b.groups[i].values);
    }
}

TEST(Bext2, WhatWeWriteReadsBackToTheSameSpline) {
    for (const bool refined : {false, true}) {
        const hex::test::TemporaryFolder folder;
        const BezierSpline written = small_spline(refined);
        io::write_bext2(folder / "a.bxt", written);
        const BezierSpline read = io::read_bext(folder / "a.bxt");
        expect_same_extraction(read, written);
    }
}

TEST(Bext2, EqualVectorsAreSharedByElements) {
    // All elements of a regular interior are alike.
    const BezierSpline s = build(hex::test::grid(8, 8, 8)).spline;
    const io::Bext2 data = io::to_bext2(s);
    std::size_t rows = 0;
    for (const auto& block : data.blocks) rows += block.vectors.size();
    EXPECT_LT(20 * data.vector_count(), rows);
    const hex::test::TemporaryFolder folder;
    io::write_bext2(folder / "a.bxt", s);
    io::write_bext(folder / "a.bext", s);
    EXPECT_LT(2 * std::filesystem::file_size(folder / "a.bxt"),
              std::filesystem::file_size(folder / "a.bext"));
}

TEST(Bext2, TheSameBytesForAnyNumberOfThreads) {
    const hex::test::TemporaryFolder folder;
    const BezierSpline s = build(hex::test::grid(6, 6, 6)).spline;
    for (const int threads : {1, 2}) {
        hex::Context context;
        context.threads = threads;
        io::write_bext2(folder / std::to_string(threads), s, context);
    }
    EXPECT_EQ(hex::test::read_text(folder / "1"), hex::test::read_text(folder / "2"));
}

TEST(Bext2, FilesOfOtherProgramsRoundTripWithoutLoss) {
    HEX_NEEDS_REFERENCE_DATA();
    const hex::test::TemporaryFolder folder;
    for (const std::string name :
         {"1_quad.bxt", "BlockWithHole_Patch9.bxt", "PressurizedCyl3d_Patch1_8Elem.bxt"}) {
        SCOPED_TRACE(name);
        const io::Bext2 data = io::read_bext2(hex::test::reference_data() / "bext2" / name);
        io::write_bext2(folder / name, data);
        expect_equal(io::read_bext2(folder / name), data);
    }
}

TEST(Bext2, ARationalCylinderOfDegreeTwoIsRound) {
    HEX_NEEDS_REFERENCE_DATA();
    const BezierSpline s =
        io::read_bext(hex::test::reference_data() / "bext2" / "PressurizedCyl3d_Patch1_8Elem.bxt");
    EXPECT_EQ(s.element_count(), 8U);
    EXPECT_TRUE(s.rational());
    const auto points = bezier_points(s);
    double least = 1e300, most = 0.0;
    for (std::size_t e = 0; e < 8; ++e) {
        for (int q = 0; q < 125; ++q) {
            const hex::Vec3 at = hex::Vec3(q % 5, q / 5 % 5, q / 25) / 4.0;
            const double radius = evaluate(s, points, e, at).point.head<2>().norm();
            least = std::min(least, radius);
            most = std::max(most, radius);
        }
    }
    EXPECT_NEAR(least, 0.6, 1e-9);
    EXPECT_NEAR(most, 1.0, 1e-9);
    EXPECT_LE(summarize(s).partition_of_unity_error, 1e-12);
    EXPECT_TRUE(certify(s).undecided.empty());
}

TEST(Bext2, WhatCannotBeUsedIsNamed) {
    HEX_NEEDS_REFERENCE_DATA();
    try {
        io::read_bext(hex::test::reference_data() / "bext2" / "1_quad.bxt");
        FAIL();
    } catch (const hex::Error& error) {
        EXPECT_EQ(error.kind(), hex::ErrorKind::unsupported);
        EXPECT_NE(error.problem().find("surface"), std::string::npos);
    }
}

TEST(Bext2, BrokenFilesAreRefusedWithTheirLine) {
    const hex::test::TemporaryFolder folder;
    io::write_bext2(folder / "a.bxt", build(hex::test::grid(1, 1, 1)).spline);
    const std::string good = hex::test::read_text(folder / "a.bxt");
    const auto refused = [&](const std::string& text) {
        std::ofstream(folder / "b.bxt") << text;
        try {
            io::read_bext2(folder / "b.bxt");
        } catch (const hex::Error& error) {
            // A file without a line is named alone.
            if (text.empty())
                EXPECT_EQ(error.where(), (folder / "b.bxt").string());
            else
                EXPECT_NE(error.where().find("b.bxt:"), std::string::npos);
            return error.kind() == hex::ErrorKind::bad_input || error.kind() == hex::ErrorKind::unsupported;
        }
        return false;
    };
    EXPECT_FALSE(refused(good));
    for (const double share : {0.1, 0.5, 0.9, 0.99})
        EXPECT_TRUE(
            refused(good.substr(0, static_cast<std::size_t>(share * static_cast<double>(good.size())))));
    EXPECT_TRUE(refused("B E X T 2.1" + good.substr(11)));
    EXPECT_TRUE(refused(good + "7\n"));
    std::string wrong = good;
    wrong.replace(wrong.find("\n       1") + 1, 8, "       x");
    EXPECT_TRUE(refused(wrong));
    EXPECT_TRUE(refused(""));
    EXPECT_TRUE(refused("B E X T 2.0\n1 0 0 0 1\n0\n0 0\n"));
    // Elements that take nothing from the file, as many as one likes.
    EXPECT_TRUE(refused("B E X T 2.0\n1 0 4000000000 0 1\n1\n1 4000000000 0 0 3 3 3\n0 0\n"));
}

TEST(Deck, HasASetOfControlPointsForEveryPatch) {
    SplineOptions options;
    options.features = hex::FeatureSource::angle;
    const BezierSpline s = build(hex::test::grid(3, 3, 3), options).spline;
    const hex::test::TemporaryFolder folder;
    io::DeckOptions deck;
    deck.bext = "box.bext";
    for (const auto kind : {io::DeckKind::eigen, io::DeckKind::linear_static}) {
        deck.kind = kind;
        io::write_deck(folder / "box.k", s, deck);
        const std::string text = hex::test::read_text(folder / "box.k");
        std::size_t sets = 0;
        for (auto at = text.find("*SET_NODE_LIST"); at != std::string::npos;
             at = text.find("*SET_NODE_LIST", at + 1))
            ++sets;
        EXPECT_EQ(sets, 6U) << "a box has six sides";
        EXPECT_NE(text.find("*INCLUDE_TRANSFORM\nbox.bext\n1,0,1,0,0\n"), std::string::npos);
        EXPECT_NE(text.find("*SECTION_SOLID\n1,201\n"), std::string::npos);
        EXPECT_EQ(text.find("*BOUNDARY_SPC_SET") != std::string::npos, kind == io::DeckKind::linear_static);
        // The side z = 0 of the sharp box is shaped by its own 16 control points.
        EXPECT_NE(text.find("\n1\n1,2,3,4,5,6,7,8\n9,10,11,12,13,14,15,16\n"), std::string::npos) << text;
    }
    deck.poisson = 0.5;
    EXPECT_THROW(io::write_deck(folder / "box.k", s, deck), hex::Error);
}

TEST(SplineJson, HoldsEveryNumberExactly) {
    const hex::test::TemporaryFolder folder;
    const BezierSpline s = build(hex::test::grid(1, 1, 1)).spline;
    io::write_spline_json(folder / "a.json", s);
    const std::string text = hex::test::read_text(folder / "a.json");
    EXPECT_NE(text.find("\"degree\": [3, 3, 3]"), std::string::npos);
    EXPECT_NE(text.find("[1,1,1,1]"), std::string::npos) << "the last control point and its weight";
    EXPECT_NE(text.find("0.2962962962962963"), std::string::npos) << "8/27";
    EXPECT_NE(text.find("\"boundary_patch\": [\n[0,0,0,0,0,0]]"), std::string::npos);
}

}  // namespace
}  // namespace spline::test
