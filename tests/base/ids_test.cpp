#include <hex/base/ids.h>

#include <gtest/gtest.h>

#include <sstream>
#include <type_traits>
#include <unordered_set>
#include <vector>

namespace hex {
namespace {

static_assert(sizeof(VertexId) == 4, "ids are 32 bits, and arrays of them as dense as integers");
static_assert(!std::is_convertible_v<VertexId, CellId>, "an id of one kind is not an id of another");
static_assert(!std::is_constructible_v<CellId, VertexId>);
static_assert(!std::is_convertible_v<std::size_t, VertexId>, "a number does not become an id by accident");
static_assert(!std::is_convertible_v<VertexId, std::size_t>);

TEST(Id, IsNoneUntilItIsGivenAValue) {
    EXPECT_FALSE(VertexId().valid());
    EXPECT_TRUE(VertexId(0).valid());
    EXPECT_EQ(VertexId(7).index(), 7u);
    EXPECT_TRUE(VertexId(0xFFFFFFFEu).valid());
    EXPECT_FALSE(VertexId(0xFFFFFFFFu).valid());
}

TEST(Id, ComparesByValueAndNoneComesLast) {
    EXPECT_LT(CellId(1), CellId(2));
    EXPECT_EQ(CellId(3), CellId(3));
    EXPECT_LT(CellId(0xFFFFFFFEu), CellId());
}

TEST(Id, PrintsItsValueOrNone) {
    std::ostringstream text;
    text << EdgeId(12) << ' ' << EdgeId();
    EXPECT_EQ(text.str(), "12 none");
}

TEST(Id, CanBeAKey) {
    std::unordered_set<QuadId> set = {QuadId(1), QuadId(2), QuadId(1)};
    EXPECT_EQ(set.size(), 2u);
}

TEST(IdRange, VisitsAllIdsInAscendingOrder) {
    std::vector<std::size_t> seen;
    for (const CellId c : IdRange<CellId>(4)) seen.push_back(c.index());
    EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2, 3}));
    EXPECT_TRUE(IdRange<CellId>(0).begin() == IdRange<CellId>(0).end());
}

}  // namespace
}  // namespace hex
