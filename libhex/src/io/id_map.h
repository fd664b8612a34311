/// \file id_map.h
/// Formats that give their nodes and elements ids.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace hex::io {

/// From the ids of the file to indices in file order.
class IdMap {
  public:
    void add(long long id) {
        consecutive_ = consecutive_ && id == static_cast<long long>(ids_.size()) + 1;
        ids_.push_back(id);
    }
    std::size_t size() const { return ids_.size(); }
    /// Sorts; returns the index of an id that is there twice, or size().
    std::size_t finish() {
        if (consecutive_) return size();
        sorted_.reserve(size());
        for (std::size_t i = 0; i < size(); ++i) sorted_.emplace_back(ids_[i], static_cast<std::uint32_t>(i));
        std::sort(sorted_.begin(), sorted_.end());
        const auto twice = std::adjacent_find(
            sorted_.begin(), sorted_.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
        return twice == sorted_.end() ? size() : (twice + 1)->second;
    }
    /// Index of an id, or size().
    std::size_t find(long long id) const {
        if (consecutive_)
            return id >= 1 && static_cast<std::size_t>(id) <= size() ? static_cast<std::size_t>(id - 1)
                                                                     : size();
        const auto found =
            std::lower_bound(sorted_.begin(), sorted_.end(), std::pair<long long, std::uint32_t>(id, 0));
        return found != sorted_.end() && found->first == id ? found->second : size();
    }
    long long id(std::size_t i) const { return ids_[i]; }

  private:
    std::vector<long long> ids_;
    std::vector<std::pair<long long, std::uint32_t>> sorted_;
    bool consecutive_ = true;
};

}  // namespace hex::io
