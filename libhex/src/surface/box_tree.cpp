#include "surface/box_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace hex {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two numbers side by side in one register.
using Two = double __attribute__((vector_size(16)));

Two larger(Two a, Two b) {
    return a < b ? b : a;
}

/// Squared distances of a point from four boxes.
std::array<double, 4> squared_distances(const std::array<std::array<double, 4>, 3>& low,
                                        const std::array<std::array<double, 4>, 3>& high, const Vec3& p) {
    std::array<double, 4> squared;
    for (std::size_t i = 0; i < 4; i += 2) {
        std::array<Two, 3> off;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = p[static_cast<Eigen::Index>(axis)];
            Two from, to;
            std::memcpy(&from, &low[axis][i], sizeof from);
            std::memcpy(&to, &high[axis][i], sizeof to);
            off[axis] = larger(larger(from - x, x - to), Two{});
        }
        const Two sum = off[0] * off[0] + (off[1] * off[1] + off[2] * off[2]);
        std::memcpy(&squared[i], &sum, sizeof sum);
    }
    return squared;
}

/// An item with an area that is not almost nothing compared with its sides.
bool is_plump(const std::array<Vec3, 3>& triangle) {
    constexpr double sliver = 1e-6;
    const Vec3 ab = triangle[1] - triangle[0];
    const Vec3 ac = triangle[2] - triangle[0];
    return ab.cross(ac).squaredNorm() > sliver * ab.squaredNorm() * ac.squaredNorm();
}
bool is_plump(const std::array<Vec3, 2>&) {
    return true;
}

}  // namespace

template <std::size_t Corners>
BoxTree<Corners>::BoxTree(std::vector<Item> items) : items_(std::move(items)) {
    double largest = 0.0;
    for (const Item& item : items_)
        for (const Vec3& p : item) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    rounding_ = 1e-11 * largest;
    nodes_.reserve(items_.size() / 4 + 1);
    leaves_.reserve(items_.size() / 2 + 1);
    if (items_.size() < 4)
        make_leaf(0, items_.size());
    else
        make_node(0, items_.size());
}

template <std::size_t Corners>
typename BoxTree<Corners>::Box BoxTree<Corners>::box_of(std::size_t first, std::size_t count) const {
    Box box{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
    for (std::size_t i = first; i < first + count; ++i) {
        for (const Vec3& p : items_[i]) {
            box.low = box.low.cwiseMin(p);
            box.high = box.high.cwiseMax(p);
        }
    }
    return box;
}

template <std::size_t Corners>
double BoxTree<Corners>::squared_distance(const Box& box, const Vec3& p) {
    return (box.low - p).cwiseMax(p - box.high).cwiseMax(0.0).squaredNorm();
}

template <std::size_t Corners>
void BoxTree<Corners>::put(Four& four, const Box& box, std::uint32_t content) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        four.low[axis][four.count] = box.low[static_cast<Eigen::Index>(axis)];
        four.high[axis][four.count] = box.high[static_cast<Eigen::Index>(axis)];
    }
    four.content[four.count++] = content;
}

template <std::size_t Corners>
std::uint32_t BoxTree<Corners>::make_leaf(std::size_t first, std::size_t count) {
    Four leaf;
    for (std::size_t i = first; i < first + count; ++i) {
        Box box = box_of(i, 1);
        // In a sliver rounding may put the computed point anywhere near.
        const double margin = is_plump(items_[i]) ? rounding_ : infinity;
        box.low.array() -= margin;
        box.high.array() += margin;
        put(leaf, box, static_cast<std::uint32_t>(i));
    }
    leaves_.push_back(leaf);
    return static_cast<std::uint32_t>(leaves_.size() - 1);
}

template <std::size_t Corners>
std::uint32_t BoxTree<Corners>::make_node(std::size_t first, std::size_t count) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Four node;
    const auto add = [&](std::size_t from, std::size_t n) {
        put(node, box_of(from, n), n < 4 ? ~make_leaf(from, n) : make_node(from, n));
    };
    const auto add_children = [&](std::size_t from, std::size_t n) {
        if (n < 4) {
            add(from, n);
        } else {
            add(from, n / 2);
            add(from + n / 2, n - n / 2);
        }
    };
    add_children(first, count / 2);
    add_children(first + count / 2, count - count / 2);
    nodes_[number] = node;
    return number;
}

template <std::size_t Corners>
void BoxTree<Corners>::search(const Vec3& p, Best& best) const {
    if (nodes_.empty()) {
        search_leaf(leaves_.front(), p, best);
        return;
    }
    struct Ahead {
        double squared;
        std::uint32_t content;
    };
    std::array<Ahead, 64> stack;  // three of each level but the last, of which there are at most 16
    std::size_t size = 0;
    stack[size++] = {0.0, 0};
    while (size > 0) {
        const Ahead next = stack[--size];
        if (!(next.squared <= best.squared)) continue;
        if (static_cast<std::int32_t>(next.content) < 0) {
            search_leaf(leaves_[~next.content], p, best);
            continue;
        }
        const Four& node = nodes_[next.content];
        const std::array<double, 4> squared = squared_distances(node.low, node.high, p);
        for (std::size_t i = node.count; i-- > 0;)
            if (squared[i] <= best.squared) stack[size++] = {squared[i], node.content[i]};
    }
}

template <std::size_t Corners>
void BoxTree<Corners>::search_leaf(const Four& leaf, const Vec3& p, Best& best) const {
    constexpr double clearly = 1.0 + 1e-6;
    const std::array<double, 4> squared = squared_distances(leaf.low, leaf.high, p);
    double pair_bound = best.squared;
    for (std::size_t i = 0; i < leaf.count; ++i) {
        if (i == 1) pair_bound = best.squared;
        if (squared[i] > clearly * best.squared) continue;
        const std::uint32_t item = leaf.content[i];
        if (best.knows(item)) continue;
        // Of three items the last two have a box of their own.
        if (i > 0 && leaf.count == 3 && !(squared_distance(box_of(leaf.content[1], 2), p) <= pair_bound))
            return;
        const Vec3 point = nearest_point_of(items_[item], p);
        const double distance = (point - p).squaredNorm();
        if (!(distance <= best.squared) || point == best.point) continue;
        best.point = point;
        best.squared = distance;
        best.item = item;
    }
}

template <std::size_t Corners>
void BoxTree<Corners>::list_near(const Vec3& p, double radius, Near& near) const {
    struct Found {
        double squared;
        std::uint32_t item;
    };
    std::array<Found, Near::most> found;
    std::size_t count = 0;
    double bound = radius * radius;
    const auto add_leaf = [&](const Four& leaf) {
        const std::array<double, 4> squared = squared_distances(leaf.low, leaf.high, p);
        for (std::size_t i = 0; i < leaf.count; ++i) {
            if (!(squared[i] < bound)) continue;
            std::size_t at = count < found.size() ? count++ : count - 1;
            for (; at > 0 && found[at - 1].squared > squared[i]; --at) found[at] = found[at - 1];
            found[at] = {squared[i], leaf.content[i]};
            if (count == found.size()) bound = found.back().squared;
        }
    };
    std::array<std::uint32_t, 64> stack;
    std::size_t size = 0;
    stack[size++] = nodes_.empty() ? ~std::uint32_t{0} : 0;
    while (size > 0) {
        const std::uint32_t next = stack[--size];
        if (static_cast<std::int32_t>(next) < 0) {
            add_leaf(leaves_[~next]);
            continue;
        }
        const Four& node = nodes_[next];
        const std::array<double, 4> squared = squared_distances(node.low, node.high, p);
        for (std::size_t i = 0; i < node.count; ++i)
            if (squared[i] < bound) stack[size++] = node.content[i];
    }
    constexpr float downwards = 1.0F - 1e-6F;
    near.centre = p;
    near.clear = std::sqrt(bound);
    near.count = count;
    for (std::size_t i = 0; i < count; ++i)
        near.items[i] = {downwards * static_cast<float>(std::sqrt(found[i].squared)), found[i].item};
}

template <std::size_t Corners>
bool BoxTree<Corners>::is_found(const Vec3& p, const Best& best, const Near& near) const {
    constexpr double surely = 1.0 + 1e-6;
    const double reach = surely * (std::sqrt(best.squared) + (p - near.centre).norm());
    if (!(reach < near.clear)) return false;
    for (std::size_t i = 0; i < near.count && near.items[i].distance <= reach; ++i) {
        const std::uint32_t item = near.items[i].item;
        if (best.knows(item)) continue;
        const Vec3 point = nearest_point_of(items_[item], p);
        if ((point - p).squaredNorm() <= best.squared && point != best.point) return false;
    }
    return true;
}

template class BoxTree<3>;
template class BoxTree<2>;

}  // namespace hex
