#include <hex/map/chain_curve.h>

#include <gtest/gtest.h>

namespace hex {
namespace {

TEST(ChainCurve, ParameterIsTheShareOfTheLength) {
    const ChainCurve curve({Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(3, 4, 0), Vec3(3, 4, 1)});
    EXPECT_EQ(curve.parameters(), (std::vector<double>{0, 3.0 / 8, 7.0 / 8, 1}));
    EXPECT_LT((curve.point(0.25) - Vec3(2, 0, 0)).norm(), 1e-15);
    EXPECT_LT((curve.point(0.625) - Vec3(3, 2, 0)).norm(), 1e-15);
}

TEST(ChainCurve, EndsAreExactAndBeyondThemIsClamped) {
    const Vec3 first(0.1, 0.2, 0.3);
    const Vec3 last(1.7, -0.3, 1e-9);
    const ChainCurve curve({first, Vec3(0.7, 0.1, 0.9), last});
    EXPECT_EQ(curve.point(0.0), first);
    EXPECT_EQ(curve.point(1.0), last);
    EXPECT_EQ(curve.point(-1.0), first);
    EXPECT_EQ(curve.point(2.0), last);
}

TEST(ChainCurve, EdgesWithoutLengthAreSteppedOver) {
    const ChainCurve curve(
        {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 0, 0)});
    for (const double t : {0.1, 0.5, 0.75, 0.999})
        EXPECT_LT((curve.point(t) - Vec3(2 * t, 0, 0)).norm(), 1e-15) << t;
}

TEST(ChainCurve, ChainWithoutLengthStaysFinite) {
    const ChainCurve curve({Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)});
    EXPECT_EQ(curve.point(0.3), Vec3(1, 2, 3));
    EXPECT_EQ(curve.parameters(), (std::vector<double>{0, 0.5, 1}));
}

}  // namespace
}  // namespace hex
