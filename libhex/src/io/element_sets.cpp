#include "io/element_sets.h"

#include "io/input_file.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace hex::io {

/// Ids in ascending order, as runs of consecutive ones; the rank of an id is its place in that order.
class ElementSets::IdRuns {
  public:
    explicit IdRuns(std::span<const long long> ids) : order_(ids.size()) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::sort(order_.begin(), order_.end(),
                  [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
        for (std::size_t rank = 0; rank < order_.size(); ++rank) {
            const auto id = static_cast<Number>(ids[order_[rank]]);
            if (runs_.empty() || id > runs_.back().last + 1) runs_.push_back({id, id, rank});
            runs_.back().last = id;
        }
    }

    std::size_t size() const { return order_.size(); }
    /// The element with this rank, in the order of the file.
    std::size_t element(std::size_t rank) const { return order_[rank]; }

    /// Calls visit(first rank, how many, step between ranks) for what the range has of each run.
    template <class Visit>
    void for_each_piece(const Range& range, const Visit& visit) const {
        const Number first = range.remainder + range.step * range.first;
        const Number last = range.remainder + range.step * range.last;
        for (auto run = run_from(first); run != runs_.end() && run->first <= last; ++run) {
            Number lower = std::max(run->first, first);
            const Number upper = std::min(run->last, last);
            const Number beyond = (lower - first) % range.step;
            if (beyond > 0 && range.step - beyond > upper - lower) continue;
            if (beyond > 0) lower += range.step - beyond;
            visit(run->rank + static_cast<std::size_t>(lower - run->first),
                  static_cast<std::size_t>((upper - lower) / range.step) + 1,
                  static_cast<std::size_t>(range.step));
        }
    }

    Number count(const Range& range) const {
        if (range.step == 1) return rank_of(range.last + 1) - rank_of(range.first);
        Number sum = 0;
        for_each_piece(range, [&](std::size_t, std::size_t size, std::size_t) { sum += size; });
        return sum;
    }

  private:
    struct Run {
        Number first, last;
        std::size_t rank;
    };

    /// The first run that does not end before `id`.
    std::vector<Run>::const_iterator run_from(Number id) const {
        return std::partition_point(runs_.begin(), runs_.end(),
                                    [&](const Run& run) { return run.last < id; });
    }
    /// How many ids are smaller.
    std::size_t rank_of(Number id) const {
        const auto run = run_from(id);
        if (run == runs_.end()) return size();
        return run->rank + (id > run->first ? static_cast<std::size_t>(id - run->first) : 0);
    }

    std::vector<std::size_t> order_;
    std::vector<Run> runs_;
};

/// What earlier sets have, for each step and remainder as disjoint intervals.
class ElementSets::Taken {
  public:
    /// Takes the range; calls visit with the parts of it that were not taken before.
    template <class Visit>
    void take(const Range& range, const Visit& visit) {
        auto& intervals = intervals_[{range.step, range.remainder}];
        Number first = range.first, last = range.last, next = range.first;
        auto interval = intervals.upper_bound(range.first);
        if (interval != intervals.begin() && std::prev(interval)->second >= range.first) --interval;
        while (interval != intervals.end() && interval->first <= range.last) {
            if (interval->first > next) visit({range.step, range.remainder, next, interval->first - 1});
            next = interval->second + 1;
            first = std::min(first, interval->first);
            last = std::max(last, interval->second);
            interval = intervals.erase(interval);
        }
        if (next <= range.last) visit({range.step, range.remainder, next, range.last});
        intervals.emplace(first, last);
    }

  private:
    std::map<std::pair<Number, Number>, std::map<Number, Number>> intervals_;
};

int ElementSets::index_of(const std::string& name) {
    const auto [found, added] = set_of_name_.emplace(upper_case(name), static_cast<int>(names_.size()));
    if (added) {
        names_.push_back(name);
        sets_.emplace_back();
    }
    return found->second;
}

void ElementSets::add(int set, long long first, long long last, long long step) {
    const auto low = static_cast<Number>(first), high = static_cast<Number>(last);
    const auto stride = static_cast<Number>(step);
    const Number more = (high - low) / stride;
    // A single id is the same whatever the step is.
    const Range range =
        more == 0 ? Range{1, 0, low, low} : Range{stride, low % stride, low / stride, low / stride + more};
    auto& ranges = sets_[static_cast<std::size_t>(set)];
    if (!ranges.empty() && ranges.back().step == 1 && range.step == 1 &&
        range.first == ranges.back().last + 1)
        ranges.back().last = range.last;
    else
        ranges.push_back(range);
}

std::vector<ElementSets::Range> ElementSets::merged(std::vector<Range> ranges) {
    std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) {
        return std::tie(a.step, a.remainder, a.first) < std::tie(b.step, b.remainder, b.first);
    });
    std::vector<Range> result;
    for (const Range& range : ranges) {
        if (!result.empty() && result.back().step == range.step &&
            result.back().remainder == range.remainder && range.first <= result.back().last + 1)
            result.back().last = std::max(result.back().last, range.last);
        else
            result.push_back(range);
    }
    return result;
}

/// `stamps`: one for each rank, none of them `stamp` yet.
bool ElementSets::holds_all(const std::vector<Range>& set, const IdRuns& ids, std::vector<int>& stamps,
                            int stamp) {
    Number sum = 0;
    for (const Range& range : set) sum += ids.count(range);
    if (sum < ids.size()) return false;
    // Ranges of one kind are disjoint.
    if (set.front().step == set.back().step && set.front().remainder == set.back().remainder) return true;
    std::size_t different = 0;
    for (const Range& range : set)
        ids.for_each_piece(range, [&](std::size_t rank, std::size_t count, std::size_t step) {
            for (std::size_t i = 0; i < count; ++i, rank += step)
                different += std::exchange(stamps[rank], stamp) != stamp ? 1 : 0;
        });
    return different == ids.size();
}

/// The smallest id of the range that is in neither list.
std::optional<ElementSets::Number> ElementSets::missing_in(const Range& range, const IdRuns& ids,
                                                           const IdRuns& skipped) {
    const auto complete_until = [&](Number last) {
        const Range part{range.step, range.remainder, range.first, last};
        return ids.count(part) + skipped.count(part) > last - range.first;
    };
    if (complete_until(range.last)) return std::nullopt;
    Number lower = range.first, upper = range.last;
    while (lower < upper) {
        const Number middle = lower + (upper - lower) / 2;
        if (complete_until(middle))
            lower = middle + 1;
        else
            upper = middle;
    }
    return range.remainder + range.step * lower;
}

ElementSets::Assignment ElementSets::assign(std::span<const long long> all_ids,
                                            std::span<const long long> skipped_ids) const {
    const IdRuns ids(all_ids), skipped(skipped_ids);
    Assignment result;
    result.set_of_element.assign(ids.size(), -1);
    std::vector<std::vector<Range>> sets;
    std::vector<int> stamps(ids.size(), -1), sets_of_all;
    std::vector<char> is_all;
    for (std::size_t s = 0; s < size(); ++s) {
        const int set = static_cast<int>(s);
        sets.push_back(merged(sets_[s]));
        is_all.push_back(ids.size() > 0 && !sets[s].empty() && holds_all(sets[s], ids, stamps, set) ? 1 : 0);
        if (is_all[s] != 0) sets_of_all.push_back(set);
        for (const Range& range : sets[s]) {
            const auto missing = missing_in(range, ids, skipped);
            if (!missing) continue;
            if (result.incomplete.empty()) result.missing_id = static_cast<long long>(*missing);
            result.incomplete.push_back(set);
            break;
        }
    }

    Taken taken;
    for (std::size_t s = 0; s < size(); ++s) {
        if (is_all[s] != 0) continue;
        const auto give = [&](const Range& range) {
            ids.for_each_piece(range, [&](std::size_t rank, std::size_t count, std::size_t step) {
                for (std::size_t i = 0; i < count; ++i, rank += step) {
                    int& set = result.set_of_element[ids.element(rank)];
                    if (set < 0) set = static_cast<int>(s);
                    if (set != static_cast<int>(s)) result.overlap = true;
                }
            });
        };
        for (const Range& range : sets[s]) {
            // Until two sets overlap they have no more members than there are elements.
            const bool whole = !result.overlap;
            taken.take(range, [&](const Range& part) {
                if (!whole) give(part);
            });
            if (whole) give(range);
        }
    }
    // The first set of all elements has what is left.
    bool left = std::find(result.set_of_element.begin(), result.set_of_element.end(), -1) !=
                result.set_of_element.end();
    for (const int set : sets_of_all) {
        if (left)
            std::replace(result.set_of_element.begin(), result.set_of_element.end(), -1, set);
        else
            result.without_elements.push_back(set);
        left = false;
    }
    return result;
}

}  // namespace hex::io
