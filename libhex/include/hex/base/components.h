/// \file components.h
/// Connected components of numbered things.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace hex {

/// Union-find over the numbers 0 .. count - 1, fewer than 2^32. Nearly linear.
class Components {
  public:
    /// `count` things, each a component of its own.
    explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

    /// From now on a and b belong together.
    void join(std::size_t a, std::size_t b) {
        const std::uint32_t one = root(a);
        const std::uint32_t other = root(b);
        parent_[std::max(one, other)] = std::min(one, other);
    }
    /// The smallest member of the component of i.
    std::uint32_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return static_cast<std::uint32_t>(i);
    }
    /// Whether i is the smallest member of its component: one in each component is.
    bool is_root(std::size_t i) const { return parent_[i] == i; }
    /// Number of things, whatever was joined.
    std::size_t size() const { return parent_.size(); }

    /// The component of each thing; components are numbered in the order of their smallest members, and
    /// `count` becomes the number of them.
    std::vector<std::uint32_t> numbers(std::uint32_t& count) {
        std::vector<std::uint32_t> number(parent_.size());
        count = 0;
        for (std::size_t i = 0; i < parent_.size(); ++i) number[i] = is_root(i) ? count++ : number[root(i)];
        return number;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace hex
