/// \file element_sets.h
/// Sets of elements by id, as Abaqus files have them, and which of them an element belongs to.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hex::io {

/// Sets stay lists of ranges, so that sets which overlap many times over cost no more than they take in the
/// file.
class ElementSets {
  public:
    /// The number of the set with this name, a new one where there is none. Abaqus does not tell capital
    /// letters from small ones.
    int index_of(const std::string& name);
    const std::string& name(int set) const { return names_[static_cast<std::size_t>(set)]; }
    std::size_t size() const { return names_.size(); }

    /// Adds the ids first, first + step, ... up to last; 1 <= first <= last, step >= 1.
    void add(int set, long long first, long long last, long long step);

    struct Assignment {
        /// The set that each element belongs to, or -1.
        std::vector<int> set_of_element;
        /// An element is in several of the sets that do not hold all elements.
        bool overlap = false;
        /// Sets of all elements, each of which belongs to another set.
        std::vector<int> without_elements;
        /// Sets with an id that no element has, and the first such id of the first of them.
        std::vector<int> incomplete;
        long long missing_id = 0;
    };

    /// An element belongs to the first set that has it; sets of all elements come last. `ids`: of the
    /// elements, which differ; `skipped`: of elements that are in the file, but not kept.
    Assignment assign(std::span<const long long> ids, std::span<const long long> skipped) const;

  private:
    using Number = unsigned long long;
    /// The ids remainder + step * q for q from first to last.
    struct Range {
        Number step, remainder, first, last;
    };
    class IdRuns;
    class Taken;

    static std::vector<Range> merged(std::vector<Range> ranges);
    static bool holds_all(const std::vector<Range>& set, const IdRuns& ids, std::vector<int>& stamps,
                          int stamp);
    static std::optional<Number> missing_in(const Range& range, const IdRuns& ids, const IdRuns& skipped);

    std::map<std::string, int> set_of_name_;
    std::vector<std::string> names_;
    std::vector<std::vector<Range>> sets_;
};

}  // namespace hex::io
