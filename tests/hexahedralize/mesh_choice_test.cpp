/// Which of several meshes is kept, and what may be spent on more.

#include "hexahedralize/mesh_choice.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hex {
namespace {

HexModel made(double min, double distance, std::size_t inverted = 0, std::size_t hexahedra = 1000) {
    HexModel model;
    model.quality.emplace();
    model.quality->cells = hexahedra;
    model.quality->min = min;
    model.quality->inverted = inverted;
    model.distance = distance;
    return model;
}

TEST(MeshChoice, NothingIsWishedForBeyondScaledJacobianAndDistance) {
    EXPECT_EQ(shortcoming(made(0.9, 0.1)), 1.0);
    EXPECT_EQ(shortcoming(made(0.2, 1.6)), 1.0);
    EXPECT_DOUBLE_EQ(shortcoming(made(0.1, 0.1)), 2.0);
    EXPECT_DOUBLE_EQ(shortcoming(made(0.9, 4.8)), 3.0);
    EXPECT_TRUE(std::isinf(shortcoming(made(-0.1, 0.1, 1))));
    EXPECT_TRUE(is_acceptable(made(0.1, 3.2)));
    EXPECT_FALSE(is_acceptable(made(0.09, 0.1)));
    EXPECT_FALSE(is_acceptable(made(0.5, 3.3)));
}

TEST(MeshChoice, KeepsTheBestAndTheEarliestOfEquals) {
    MeshChoice choice;
    EXPECT_TRUE(choice.consider(made(-0.5, 0.1, 7)));
    EXPECT_TRUE(choice.consider(made(-0.9, 0.1, 3)));
    EXPECT_TRUE(choice.consider(made(0.05, 0.1)));
    EXPECT_FALSE(choice.consider(made(-0.01, 0.1, 1)));
    EXPECT_TRUE(choice.consider(made(0.5, 0.3)));
    EXPECT_FALSE(choice.consider(made(0.9, 0.2)));  // as good: nothing is left to wish for
    EXPECT_EQ(choice.best()->quality->min, 0.5);
    EXPECT_EQ(choice.tries().size(), 6U);
    EXPECT_EQ(choice.tries()[1].quality.inverted, 3U);
}

TEST(MeshChoice, TheFirstMeshMayHaveAnySizeAndTheOthersShareABudget) {
    MeshChoice choice;
    EXPECT_TRUE(choice.may_improve(1000000));
    choice.consider(made(0.1, 0.1, 0, 4000));
    EXPECT_TRUE(choice.may_improve(2000));
    EXPECT_FALSE(choice.may_improve(2001));
    choice.count_mapped_in_vain(4000);
    EXPECT_TRUE(choice.may_improve(1000));
    EXPECT_FALSE(choice.may_improve(1001));
    EXPECT_TRUE(choice.may_label(50000));
    choice.count_labelled(40000);
    EXPECT_TRUE(choice.may_label(10000));
    EXPECT_FALSE(choice.may_label(10001));
}

}  // namespace
}  // namespace hex
