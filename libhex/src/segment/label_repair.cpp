#include "segment/label_repair.h"

#include "segment/label_reroute.h"
#include "segment/repair_operators.h"

#include <hex/base/parallel.h>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <optional>
#include <set>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// A place to mend: a chart, a boundary or a vertex, by what is wrong there.
struct Place {
    enum class Kind {
        few_sided_chart,
        opposite_boundary,
        crossing,
        contrary_boundary,
        turning_boundary,
        spare_chart
    };
    Kind kind = Kind::few_sided_chart;
    int index = 0;
    std::size_t size = 0;  ///< triangles or edges; small ones are mended first

    bool on_boundary() const {
        return kind == Kind::opposite_boundary || kind == Kind::contrary_boundary ||
               kind == Kind::turning_boundary;
    }
};

const char* reason_of(Place::Kind kind) {
    switch (kind) {
        case Place::Kind::few_sided_chart:
            return "chart-too-few-boundaries";
        case Place::Kind::opposite_boundary:
            return "opposite-labels-adjacent";
        case Place::Kind::crossing:
            return "corner-valence";
        case Place::Kind::spare_chart:
            return "small-chart";
        case Place::Kind::contrary_boundary:
            return "charts-without-order";
        case Place::Kind::turning_boundary:
            return "boundary-turns";
    }
    return "";
}

std::vector<Place> invalid_places(const LabelCharts& charts) {
    std::vector<Place> places;
    for (std::size_t c = 0; c < charts.charts.size(); ++c) {
        if (charts.charts[c].boundaries.size() < 4)
            places.push_back(
                {Place::Kind::few_sided_chart, static_cast<int>(c), charts.charts[c].triangles.size()});
    }
    for (std::size_t b = 0; b < charts.boundaries.size(); ++b) {
        const LabelBoundary& boundary = charts.boundaries[b];
        if (opposite_labels(charts.charts[at(boundary.charts[0])].label,
                            charts.charts[at(boundary.charts[1])].label))
            places.push_back(
                {Place::Kind::opposite_boundary, static_cast<int>(b), boundary.triangles.size()});
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.size < b.size; });
    return places;
}

/// The chart across the axis at a corner of three charts; -1 when there is none, or more.
int chart_across(const LabelCharts& charts, int axis, int vertex) {
    const auto corner = std::lower_bound(charts.corners.begin(), charts.corners.end(), vertex,
                                         [](const LabelCorner& c, int v) { return c.vertex < v; });
    if (corner == charts.corners.end() || corner->vertex != vertex || corner->valence != 3) return -1;
    int found = -1;
    for (const int c : corner->charts) {
        if (charts.charts[at(c)].label / 2 == axis) found = c;
    }
    return found;
}

/// The boundaries that contradict each other about the order of charts.
std::vector<Place> contrary_places(const LabelSurface& surface, const LabelCharts& charts) {
    ChartOrder order;
    std::vector<Place> closed;  // these have no corner at all
    for (std::size_t b = 0; b < charts.boundaries.size(); ++b) {
        const LabelBoundary& boundary = charts.boundaries[b];
        const int axis = boundary_axis(charts.charts[at(boundary.charts[0])].label,
                                       charts.charts[at(boundary.charts[1])].label);
        if (axis < 0) continue;
        if (boundary.vertices.front() == boundary.vertices.back() &&
            chart_across(charts, axis, boundary.vertices.front()) < 0)
            closed.push_back(
                {Place::Kind::contrary_boundary, static_cast<int>(b), boundary.triangles.size()});
        int first = boundary.vertices.front();
        int last = boundary.vertices.back();
        if (surface.points[at(last)][axis] < surface.points[at(first)][axis]) std::swap(first, last);
        const int before = chart_across(charts, axis, first);
        const int after = chart_across(charts, axis, last);
        const double rise = surface.points[at(last)][axis] - surface.points[at(first)][axis];
        if (before >= 0 && after >= 0 && (before == after || rise > surface.flat))
            order.add({before, after, static_cast<int>(b)});
    }
    std::vector<Place> places = std::move(closed);
    for (const ChartOrder::Arc& arc : order.conflicts())
        places.push_back({Place::Kind::contrary_boundary, arc.boundary,
                          charts.boundaries[at(arc.boundary)].triangles.size()});
    return places;
}

/// What would be nicer, when all is valid.
std::vector<Place> untidy_places(const LabelSurface& surface, const LabelCharts& charts, bool small_charts) {
    std::vector<Place> places = contrary_places(surface, charts);
    for (const LabelCorner& corner : charts.corners) {
        if (corner.valence > 3) places.push_back({Place::Kind::crossing, corner.vertex, 0});
    }
    for (std::size_t b = 0; b < charts.boundaries.size(); ++b) {
        const LabelBoundary& boundary = charts.boundaries[b];
        if (count_turns(surface, charts, boundary) > 0)
            places.push_back({Place::Kind::turning_boundary, static_cast<int>(b), boundary.triangles.size()});
    }
    const std::size_t small = charts.chart_of_triangle.size() / 20 + 1;
    for (std::size_t c = 0; small_charts && c < charts.charts.size(); ++c) {
        const std::size_t size = charts.charts[c].triangles.size();
        if (size <= small) places.push_back({Place::Kind::spare_chart, static_cast<int>(c), size});
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.size < b.size; });
    return places;
}

class Repair {
  public:
    Repair(const TriangleMesh& mesh, const LabelSurface& surface, std::vector<int> labels,
           const Context& context)
        : mesh_(mesh), surface_(surface), context_(context), energies_([&] { return Trial(surface); }) {
        result_.labels = std::move(labels);
        result_.score = LabelEnergy(surface).evaluate(result_.labels);
    }

    LabelRepair run() {
        constexpr int most_passes = 60;
        // Validity at a moderate price first; at any price where that is not enough.
        for (const double weight : {0.02, 0.1, 1.0}) {
            weight_ = weight;
            for (int pass = 0; pass < most_passes && !result_.score.valid(); ++pass) {
                if (!mend(invalid_places) && !(weight > 0.05 && mend_in_two_steps())) break;
            }
        }
        // Charts go last: a corner or a boundary may be mended for less.
        constexpr int most_tidy_passes = 8;
        for (const bool small_charts : {false, true}) {
            for (int pass = 0; pass < most_tidy_passes; ++pass) {
                if (!mend([&](const LabelCharts& charts) {
                        return untidy_places(surface_, charts, small_charts);
                    }))
                    break;
            }
        }
        return std::move(result_);
    }

  private:
    struct Trial {
        explicit Trial(const LabelSurface& surface) : energy(surface) {}
        LabelEnergy energy;
        std::vector<int> labels;
        std::size_t version = 0;
        std::size_t batch = 0;  ///< what the energy is prepared for
    };
    struct Best {
        std::size_t index = 0;
        LabelScore score;
    };

    double energy_of(const LabelScore& score) const { return score.energy(weight_); }

    /// The labels of this thread, those of the result.
    Trial& trial() {
        Trial& trial = energies_.local();
        if (trial.version != version_) {
            trial.labels = result_.labels;
            trial.version = version_;
            trial.batch = 0;
        }
        return trial;
    }

    std::vector<LabelScore> scores_of(const std::vector<LabelChange>& changes) {
        context_.check_cancelled();
        // Small changes share one region; a large one has its own.
        const std::size_t large = result_.labels.size() / 40 + 50;
        std::vector<int> region;
        for (const LabelChange& change : changes) {
            if (change.labels.size() > large) continue;
            for (const auto& [t, label] : change.labels) region.push_back(t);
        }
        std::sort(region.begin(), region.end());
        region.erase(std::unique(region.begin(), region.end()), region.end());
        ++batch_;
        std::vector<LabelScore> scores(changes.size());
        parallel_for(
            changes.size(),
            [&](std::size_t i) {
                const LabelChange& change = changes[i];
                Trial& t = trial();
                const bool shared = change.labels.size() <= large;
                if (shared && t.batch != batch_) t.energy.prepare(t.labels, region);
                t.batch = shared ? batch_ : 0;
                for (const auto& [triangle, label] : change.labels) t.labels[at(triangle)] = label;
                scores[i] = shared ? t.energy.evaluate_prepared(t.labels) : t.energy.evaluate(t.labels);
                for (const auto& [triangle, label] : change.labels)
                    t.labels[at(triangle)] = result_.labels[at(triangle)];
            },
            1);
        return scores;
    }

    std::optional<Best> best_of(const std::vector<LabelChange>& changes) {
        const auto scores = scores_of(changes);
        std::optional<Best> best;
        for (std::size_t i = 0; i < scores.size(); ++i) {
            if (!best || energy_of(scores[i]) < energy_of(best->score)) best = Best{i, scores[i]};
        }
        if (best && !(energy_of(best->score) < energy_of(result_.score) - least_gain)) best.reset();
        return best;
    }

    void apply(const LabelChange& change, const LabelScore& score) {
        for (const auto& [t, label] : change.labels) result_.labels[at(t)] = label;
        result_.score = score;
        ++version_;
    }

    void accept(const LabelChange& change, const LabelScore& score, Place::Kind kind) {
        int first = change.labels.front().first;
        for (const auto& [t, label] : change.labels) first = std::min(first, t);
        result_.repairs.push_back({change.repair, reason_of(kind), first, change.labels.size(),
                                   score.infidelity - result_.score.infidelity});
        apply(change, score);
    }

    /// Every operator that may help at a place.
    static void propose(const RepairOperators& operators, const LabelCharts& charts, const Place& place,
                        std::vector<LabelChange>& out) {
        if (place.kind == Place::Kind::crossing) {
            operators.fill_corner(place.index, out);
            return;
        }
        if (place.kind == Place::Kind::turning_boundary) {
            const LabelBoundary& boundary = charts.boundaries[at(place.index)];
            operators.fill_corner(boundary.vertices.front(), out);
            operators.fill_corner(boundary.vertices.back(), out);
            return;
        }
        std::vector<int> beside;
        std::vector<int> boundaries = {place.index};
        if (place.kind == Place::Kind::opposite_boundary || place.kind == Place::Kind::contrary_boundary) {
            const auto& pair = charts.boundaries[at(place.index)].charts;
            beside = {pair[0], pair[1]};
        } else {
            beside = {place.index};
            boundaries = charts.charts[at(place.index)].boundaries;
        }
        for (const int chart : beside) {
            operators.relabel_chart(chart, out);
            operators.grow_chart(chart, out);
            operators.pull_chart(chart, out);
            operators.split_chart(chart, out);
        }
        std::vector<int> corners;
        for (const int b : boundaries) {
            const LabelBoundary& boundary = charts.boundaries[at(b)];
            operators.insert_chart(b, out);
            for (const int c : boundary.charts) {
                if (std::find(beside.begin(), beside.end(), c) == beside.end()) operators.split_chart(c, out);
            }
            corners.push_back(boundary.vertices.front());
            corners.push_back(boundary.vertices.back());
        }
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        for (const int v : corners) operators.fill_corner(v, out);
    }

    /// Removing the chart, the cheap way.
    static void propose_removal(const RepairOperators& operators, const Place& place,
                                std::vector<LabelChange>& out) {
        operators.merge_chart(place.index, out);
        operators.dissolve_chart(place.index, out);
    }

    static std::vector<int> charts_at(const LabelCharts& charts, const Place& place) {
        if (place.kind == Place::Kind::crossing) return {};
        if (place.on_boundary()) {
            const auto& pair = charts.boundaries[at(place.index)].charts;
            return {pair[0], pair[1]};
        }
        return {place.index};
    }

    /// The best change for one place, when there is one that lowers the energy.
    std::optional<std::pair<LabelChange, LabelScore>> best_change(const LabelCharts& charts,
                                                                  const Place& place) {
        const RepairOperators operators(surface_, result_.labels, charts);
        std::vector<LabelChange> changes;
        if (place.kind == Place::Kind::few_sided_chart || place.kind == Place::Kind::spare_chart)
            propose_removal(operators, place, changes);
        if (place.kind == Place::Kind::turning_boundary)
            straighten_boundary(surface_, result_.labels, charts, place.index, changes);
        std::optional<Best> best = best_of(changes);
        const bool cheap = best && best->score.infidelity - result_.score.infidelity < cheap_removal;
        if (!cheap && place.kind != Place::Kind::spare_chart) {
            propose(operators, charts, place, changes);
            best = best_of(changes);
        }
        if (!best) return std::nullopt;
        return std::pair{std::move(changes[best->index]), best->score};
    }

    static bool tidying(const Place& place) {
        return place.kind != Place::Kind::few_sided_chart && place.kind != Place::Kind::opposite_boundary;
    }

    /// Tells a place in later passes, as long as it does not change.
    static std::vector<int> signature(const LabelCharts& charts, const Place& place) {
        std::vector<int> key = {static_cast<int>(place.kind)};
        if (place.kind == Place::Kind::crossing) {
            key.push_back(place.index);
        } else if (place.on_boundary()) {
            const auto& vertices = charts.boundaries[at(place.index)].vertices;
            key.insert(key.end(), vertices.begin(), vertices.end());
        } else {
            const LabelChart& chart = charts.charts[at(place.index)];
            key.insert(key.end(), {chart.label, chart.triangles.front(), static_cast<int>(place.size),
                                   static_cast<int>(chart.boundaries.size())});
        }
        return key;
    }

    /// One pass over the places, the greatest gains first, those that cost faith later. True when something
    /// was mended.
    template <class Find>
    bool mend(const Find& find) {
        struct Job {
            Place place;
            LabelChange change;
            double gain;
            double cost;
            double rank() const { return gain - 3.0 * std::max(0.0, cost); }
        };
        const LabelCharts charts = find_charts(mesh_, {result_.labels});
        std::vector<Job> jobs;
        for (const Place& place : find(charts)) {
            const std::vector<int> key = signature(charts, place);
            if (hopeless_.contains(key)) continue;
            auto best = best_change(charts, place);
            if (!best && tidying(place)) hopeless_.insert(key);
            if (best)
                jobs.push_back({place, std::move(best->first),
                                energy_of(result_.score) - energy_of(best->second),
                                best->second.infidelity - result_.score.infidelity});
        }
        std::stable_sort(jobs.begin(), jobs.end(),
                         [](const Job& a, const Job& b) { return a.rank() > b.rank(); });
        std::vector<char> stale(charts.charts.size(), 0);
        bool mended = false;
        for (const Job& job : jobs) {
            const auto own = charts_at(charts, job.place);
            if (std::any_of(own.begin(), own.end(), [&](int c) { return stale[at(c)]; })) continue;
            LabelChange change = job.change;
            std::erase_if(change.labels,
                          [&](const auto& c) { return result_.labels[at(c.first)] == c.second; });
            if (change.labels.empty()) continue;
            const LabelScore score = scores_of({change}).front();
            if (energy_of(result_.score) - energy_of(score) < 0.5 * job.gain) continue;
            for (const auto& [t, label] : change.labels) {
                stale[at(charts.chart_of_triangle[at(t)])] = 1;
                for (const int n : surface_.arrays.neighbours[at(t)])
                    if (n >= 0 && result_.labels[at(n)] == label)
                        stale[at(charts.chart_of_triangle[at(n)])] = 1;
            }
            accept(change, score, job.place.kind);
            mended = true;
        }
        return mended;
    }

    /// Where no change alone lowers the energy: a change that raises it, and one near it that more than makes
    /// up for that.
    bool mend_in_two_steps() {
        constexpr std::size_t most_places = 6;
        constexpr std::size_t most_first_steps = 16;
        const LabelCharts charts = find_charts(mesh_, {result_.labels});
        auto places = invalid_places(charts);
        if (places.size() > most_places) places.resize(most_places);
        for (const Place& place : places) {
            const RepairOperators operators(surface_, result_.labels, charts);
            std::vector<LabelChange> changes;
            if (place.kind == Place::Kind::few_sided_chart) propose_removal(operators, place, changes);
            propose(operators, charts, place, changes);
            const auto scores = scores_of(changes);
            std::vector<std::size_t> order(changes.size());
            for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
            std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
                return energy_of(scores[a]) < energy_of(scores[b]);
            });
            if (order.size() > most_first_steps) order.resize(most_first_steps);
            if (try_second_steps(changes, scores, order, place)) return true;
        }
        return false;
    }

    bool try_second_steps(const std::vector<LabelChange>& firsts, const std::vector<LabelScore>& scores,
                          const std::vector<std::size_t>& order, const Place& place) {
        const std::vector<int> labels = result_.labels;
        const LabelScore score = result_.score;
        struct Pair {
            std::size_t first;
            LabelChange second;
            LabelScore score;
            Place::Kind kind;
        };
        std::optional<Pair> best;
        for (const std::size_t first : order) {
            apply(firsts[first], scores[first]);
            const LabelCharts charts = find_charts(mesh_, {result_.labels});
            const RepairOperators operators(surface_, result_.labels, charts);
            std::vector<char> near(charts.charts.size(), 0);
            for (const auto& [t, label] : firsts[first].labels) {
                near[at(charts.chart_of_triangle[at(t)])] = 1;
                for (const int n : surface_.arrays.neighbours[at(t)])
                    if (n >= 0) near[at(charts.chart_of_triangle[at(n)])] = 1;
            }
            result_.score = score;  // to be beaten
            for (const Place& next : invalid_places(charts)) {
                const auto own = charts_at(charts, next);
                if (std::none_of(own.begin(), own.end(), [&](int c) { return near[at(c)]; })) continue;
                std::vector<LabelChange> changes;
                if (next.kind == Place::Kind::few_sided_chart) propose_removal(operators, next, changes);
                propose(operators, charts, next, changes);
                const auto found = best_of(changes);
                if (found && (!best || energy_of(found->score) < energy_of(best->score)))
                    best = Pair{first, changes[found->index], found->score, next.kind};
            }
            result_.labels = labels;
            ++version_;
        }
        if (!best) return false;
        accept(firsts[best->first], scores[best->first], place.kind);
        accept(best->second, best->score, best->kind);
        return true;
    }

    static constexpr double least_gain = 1e-9;
    static constexpr double cheap_removal = 0.002;

    const TriangleMesh& mesh_;
    const LabelSurface& surface_;
    const Context& context_;
    tbb::enumerable_thread_specific<Trial> energies_;
    std::size_t version_ = 1;
    std::size_t batch_ = 0;
    std::set<std::vector<int>> hopeless_;  ///< signatures of places that nothing made tidier
    double weight_ = 1.0;                  ///< of validity
    LabelRepair result_;
};

}  // namespace

LabelRepair repair_labels(const TriangleMesh& mesh, const LabelSurface& surface, std::vector<int> labels,
                          const Context& context) {
    return Repair(mesh, surface, std::move(labels), context).run();
}

}  // namespace hex
