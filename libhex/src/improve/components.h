/// \file components.h
/// Connected components of numbered things.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace hex::improving {

/// Union-find. Nearly linear.
class Components {
  public:
    explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    /// The first member of the component of i.
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    std::size_t size() const { return parent_.size(); }
    /// The component of each thing; components are numbered in the order of their first members, and `count`
    /// becomes the number of them.
    std::vector<std::uint32_t> numbers(std::uint32_t& count) {
        std::vector<std::uint32_t> number(parent_.size());
        count = 0;
        for (std::uint32_t i = 0; i < parent_.size(); ++i)
            number[i] = root(i) == i ? count++ : number[root(i)];
        return number;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace hex::improving
