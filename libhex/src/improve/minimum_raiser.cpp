#include "improve/minimum_raiser.h"

#include "improve/guide_options.h"
#include "improve/star_ascent.h"
#include "improve/sweep.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/improve/corner_energies.h>

#include <algorithm>
#include <cmath>

namespace hex::improving {
namespace {

/// Above this minimum no slack is used.
constexpr double good_enough = 0.5;
/// Most slack, in percent of the diagonal.
constexpr double largest_slack = 0.1;
/// Rounds of smoothing along dual sheets that the reference lengths get.
constexpr int reference_rounds = 5;
/// Continuation steps of the untangling before it is given up.
constexpr int most_continuations = 40;

/// Reference boxes: each side the mean of its four edges, evened out along the sheet of cells that share such
/// edges, but not across it: thin layers stay thin, and a crushed cell wants to be like its neighbours.
std::vector<Vec3> reference_boxes(const HexMesh& mesh, const EdgeTable& edges) {
    constexpr std::array<Eigen::Index, 12> axis = {0, 1, 0, 1, 2, 2, 2, 2, 0, 1, 0, 1};
    std::vector<double> length(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
        length[e] = (mesh.position(edges.vertices[e][0]) - mesh.position(edges.vertices[e][1])).norm();
    std::vector<Vec3> boxes(mesh.cell_count());
    const auto average = [&] {
        parallel_for(boxes.size(), [&](std::size_t c) {
            Vec3 sum = Vec3::Zero();
            for (std::size_t k = 0; k < 12; ++k) sum[axis[k]] += length[edges.cell_edges[c][k].index()];
            boxes[c] = 0.25 * sum;
        });
    };
    average();
    for (int round = 0; round < reference_rounds; ++round) {
        std::vector<double> sum(edges.size(), 0.0);
        for (std::size_t c = 0; c < boxes.size(); ++c)
            for (std::size_t k = 0; k < 12; ++k) sum[edges.cell_edges[c][k].index()] += boxes[c][axis[k]];
        for (std::size_t e = 0; e < edges.size(); ++e)
            length[e] = sum[e] / static_cast<double>(edges.cells[EdgeId(e).index()].size());
        average();
    }
    double mean = 0.0;
    for (const Vec3& box : boxes) mean += box.sum();
    mean /= 3.0 * static_cast<double>(boxes.size());
    if (!(mean > 0.0)) mean = 1.0;
    for (Vec3& box : boxes) box = box.cwiseMax(1e-6 * mean);
    return boxes;
}

/// How much larger the distances to the surface may get.
constexpr double fidelity_loss = 0.05;
/// Distances that are as good as none, in shares of the diagonal.
constexpr double negligible = 1e-4;
/// A round of barrier and ascent that gains less is the last one.
constexpr double worth_a_round = 0.005;
/// Meshes that are remembered until one is chosen.
constexpr std::size_t most_candidates = 12;
/// How far below the minimum the floor lies while the mean is raised, and what that may cost a minimum that
/// is good enough; a bad one may lose almost nothing.
constexpr double minimum_for_mean = 0.04;
constexpr double bad_minimum_for_mean = 0.005;
/// Shares of the work allowed after which `begin`, raising in `finish`, and raising the mean end.
constexpr double share_of_begin = 0.5;
constexpr double share_of_finish = 0.9;
constexpr double share_of_mean = 1.0;
constexpr double share_of_ascent = 0.1;

double smallest_determinant(const HexMesh& mesh, const std::vector<Vec3>& boxes) {
    return parallel_reduce(
        boxes.size(), std::numeric_limits<double>::infinity(),
        [&](double smallest, std::size_t c) {
            return std::min(smallest,
                            FoldoverEnergy::smallest_determinant(mesh.corner_positions(CellId(c)), boxes[c]));
        },
        [](double a, double b) { return std::min(a, b); });
}

}  // namespace

bool better(const ImproveRecord& a, const ImproveRecord& b) {
    return a.inverted != b.inverted ? a.inverted < b.inverted : a.min > b.min;
}

MinimumRaiser::MinimumRaiser(const HexMesh& mesh, GuideSurface surface, const ImproveOptions& options,
                             const Deadline& deadline, const Context& context)
    : options_(options),
      deadline_(deadline),
      context_(context),
      edges_(edge_table(mesh)),
      boundary_(boundary_quads(mesh)),
      guide_(mesh, edges_, boundary_, std::move(surface), curve_options(options)),
      sliding_(mesh, edges_, &guide_, boundary_),
      meter_(edges_, boundary_, guide_.surface(), curve_options(options).sharp_cosine),
      best_(mesh),
      input_(record_of(scaled_jacobians(mesh, context))) {
    sliding_.set_boxes(reference_boxes(mesh, edges_));
}

std::size_t MinimumRaiser::sharp_edge_count() const {
    return static_cast<std::size_t>(
        std::count(guide_.feature_edges().begin(), guide_.feature_edges().end(), char{1}));
}

bool MinimumRaiser::is_over() const {
    return deadline_.passed() ||
           (options_.work_limit > 0.0 && sliding_.work() > share_of_work_ * options_.work_limit);
}

double MinimumRaiser::aim() const {
    // The way from the smooth curves to the exact ones costs quality, so the target is for after it.
    return exact_ ? options_.target : 1.0;
}

bool MinimumRaiser::reached_target() const {
    return now_.inverted == 0 && now_.min >= aim();
}

void MinimumRaiser::record(const std::string& step, bool eligible) {
    now_ = record_of(scaled_jacobians(sliding_.mesh(), context_));
    now_.sweep = static_cast<int>(history_.size()) + 1;
    now_.step = step;
    const double off = deviation();
    now_.distance = 100.0 * off / guide_.diagonal();
    history_.push_back(now_);
    const double time = deadline_.elapsed();
    const auto own =
        std::find_if(seconds_.begin(), seconds_.end(), [&](const auto& s) { return s.first == step; });
    if (own == seconds_.end())
        seconds_.emplace_back(step, time - last_record_);
    else
        own->second += time - last_record_;
    last_record_ = time;
    // How many steps there will be is not known before the end.
    const double steps = static_cast<double>(history_.size());
    context_.progress(step, steps / (steps + 8.0));
    if (!eligible) return;
    const bool full = candidates_.size() == most_candidates;
    if (full && !better(now_, candidates_.back().record)) return;
    if (off > allowed_deviation()) return;
    if (full) candidates_.pop_back();
    const auto place = std::find_if(candidates_.begin(), candidates_.end(), [&](const Candidate& candidate) {
        return better(now_, candidate.record);
    });
    candidates_.insert(place,
                       {now_, {sliding_.positions().begin(), sliding_.positions().end()}, std::nullopt});
}

double MinimumRaiser::deviation() const {
    // On smooth curves an item is not one of the curve's own.
    const auto hint = [&](VertexId v) {
        return guide_.freedom(v) == Freedom::region ? sliding_.item(v) : std::nullopt;
    };
    return parallel_reduce(
        boundary_.boundary_vertices.size(), 0.0,
        [&](double largest, std::size_t i) {
            const VertexId v = boundary_.boundary_vertices[i];
            const Vec3& p = sliding_.mesh().position(v);
            return std::max(largest, (guide_.nearest(v, p, hint(v)).point - p).norm());
        },
        [](double a, double b) { return std::max(a, b); });
}

void MinimumRaiser::measure_start() {
    sliding_.attach();
    start_.assign(sliding_.positions().begin(), sliding_.positions().end());
    if (!limits_given_) fidelity_before_ = meter_.measure(sliding_.positions());
    const double least = negligible * guide_.diagonal();
    limits_.distance = (1.0 + fidelity_loss) * std::max(fidelity_before_.distance, least);
    limits_.features = (1.0 + fidelity_loss) * std::max(fidelity_before_.features, least);
    keeper_.emplace(edges_, boundary_, guide_.surface(), curve_options(options_).sharp_cosine,
                    sliding_.positions());
    keeper_->set_limit(limits_.distance);
    sliding_.set_keeper(&*keeper_);
}

void MinimumRaiser::begin() {
    share_of_work_ = share_of_begin;
    last_record_ = deadline_.elapsed();
    const bool exact_surface = options_.surface != nullptr;
    const double percent =
        options_.max_deviation >= 0.0 ? options_.max_deviation : (exact_surface ? 0.01 : 1.0);
    // A little less, for the rounding of text files.
    most_deviation_ = 0.0099 * percent * guide_.diagonal();
    if (exact_surface) measure_start();
    exact_ = !exact_surface;
    sliding_.use_smooth_curves(true);
    sliding_.attach();
    record("attach", exact_);
    if (now_.inverted > 0) untangle();
    raise();
}

void MinimumRaiser::finish() {
    share_of_work_ = share_of_finish;
    last_record_ = deadline_.elapsed();
    const bool exact_surface = options_.surface != nullptr;
    // A little less, so that rounding does not make it too much.
    const double most_slack =
        (1.0 - 1e-9) * std::min(most_deviation_, 0.01 * largest_slack * guide_.diagonal());
    const auto solved = [&] { return !candidates_.empty() && candidates_.front().record.inverted == 0; };
    if (exact_surface || !solved()) {
        exact_ = true;
        sliding_.use_smooth_curves(false);
        sliding_.attach();
        record("attach", true);
        if (now_.inverted > 0) ascend(aim());
        raise();
    }
    if (!candidates_.empty() && most_slack > 0.0 && candidates_.front().record.min < good_enough) {
        sliding_.set_positions(candidates_.front().positions);
        sliding_.set_slack(most_slack);
        sliding_.attach();
        if (!solved()) ascend(aim());
        raise();
    }
    if (!candidates_.empty()) {
        raise_mean();
        choose();
        if (exact_surface && chosen_->record.inverted == 0 && !fidelity_after_.within(limits_))
            restore_fidelity();
    }
}

void MinimumRaiser::raise_mean() {
    share_of_work_ = share_of_mean;
    if (candidates_.front().record.inverted > 0 || is_over()) return;
    const Candidate start = candidates_.front();
    const double cost =
        start.record.min - minimum_for_mean >= good_enough ? minimum_for_mean : bad_minimum_for_mean;
    const double least = std::max(start.record.min - cost, input_.inverted == 0 ? input_.min : 0.0);
    // The lower the floor, the higher the mean, and the ascent afterwards costs it little; but it may not
    // come all the way back.
    for (const double gap : {0.12, minimum_for_mean}) {
        if (is_over()) return;
        sliding_.set_positions(start.positions);
        QualityMeshEnergy mean(sliding_.boxes());
        mean.floor = start.record.min - gap;
        mean.mean_weight = 1.0;
        mean.barrier_weight = QualityMean().barrier_weight;
        DescentOptions descent;
        descent.most_iterations = 100;
        descent.satisfied = [&] { return is_over(); };
        (void)descend(sliding_, mean, descent, context_);
        record("mean", false);
        if (now_.min < least) ascend(std::min(aim(), 0.5 * (least + start.record.min)));
        if (now_.min <= least || now_.mean <= start.record.mean || deviation() > allowed_deviation())
            continue;
        if (candidates_.size() == most_candidates) candidates_.pop_back();
        candidates_.insert(candidates_.begin(),
                           {now_, {sliding_.positions().begin(), sliding_.positions().end()}, std::nullopt});
        return;
    }
}

void MinimumRaiser::choose() {
    const auto violation = [&](const Fidelity& f) {
        return std::max(f.distance / limits_.distance, f.features / limits_.features);
    };
    chosen_ = candidates_.front();
    if (options_.surface != nullptr) {
        double least = std::numeric_limits<double>::infinity();
        for (Candidate& candidate : candidates_) {
            if (candidate.record.inverted > candidates_.front().record.inverted) break;
            if (better(input_, candidate.record)) continue;
            if (!candidate.fidelity) candidate.fidelity = meter_.measure(candidate.positions);
            const double beyond = std::max(1.0, violation(*candidate.fidelity));
            if (beyond >= least) continue;
            least = beyond;
            chosen_ = candidate;
            if (beyond == 1.0) break;
        }
        if (!chosen_->fidelity) chosen_->fidelity = meter_.measure(chosen_->positions);
        fidelity_after_ = *chosen_->fidelity;
    }
    best_.set_positions(chosen_->positions);
}

void MinimumRaiser::restore_fidelity() {
    for (int round = 0; round < 2 && !fidelity_after_.within(limits_); ++round) {
        keeper_->set_strength(4.0 * keeper_->strength());
        sliding_.set_positions(chosen_->positions);
        candidates_.resize(std::min(candidates_.size(), most_candidates / 2));
        lower_barrier(0.1);
        choose();
    }
    const std::vector<Vec3> far = chosen_->positions;
    for (const double share : {0.1, 0.25, 0.5, 0.75, 1.0}) {
        if (fidelity_after_.within(limits_)) break;
        std::vector<Vec3> between(far.size());
        for (std::size_t v = 0; v < far.size(); ++v) between[v] = far[v] + share * (start_[v] - far[v]);
        candidates_ = {*chosen_};
        sliding_.set_positions(between);
        sliding_.attach();
        record("back", true);
        choose();
    }
}

void MinimumRaiser::untangle() {
    const std::vector<Vec3>& boxes = sliding_.boxes();
    FoldoverEnergy energy;
    const PerCellEnergy mesh_energy([&](std::size_t c, const HexCorners& corners, HexCorners* gradient) {
        return energy.evaluate(corners, boxes[c], gradient);
    });
    double det = smallest_determinant(sliding_.mesh(), boxes);
    energy.epsilon = det > 0.0 ? 1e-3 : std::sqrt(1e-6 + 0.04 * det * det);
    for (int k = 0; k < most_continuations && !is_over(); ++k) {
        DescentOptions descent;
        descent.most_iterations = 100;
        descent.satisfied = [&] { return is_over(); };
        const DescentResult result = descend(sliding_, mesh_energy, descent, context_);
        det = smallest_determinant(sliding_.mesh(), boxes);
        record("untangle", exact_);
        if (now_.inverted > 0 && now_.inverted < 1 + sliding_.mesh().cell_count() / 200) ascend(aim());
        if (now_.inverted == 0) break;
        if (result.iterations == 0 && k > 10) break;
        // The paper's rule (section 4): epsilon falls so fast that the energy still goes down.
        const double sigma = std::max(1.0 - result.after / result.before, 0.1);
        const double root = std::sqrt(energy.epsilon * energy.epsilon + det * det);
        const double chi =
            det > 0.0 ? 0.5 * (det + root) : 0.5 * energy.epsilon * energy.epsilon / (root - det);
        const double mu = (1.0 - sigma) * chi;
        energy.epsilon = det < mu ? 2.0 * std::sqrt(mu * (mu - det)) : 1e-10;
    }
    if (now_.inverted > 0) return;
    // Once valid, the unregularised energy evens the mesh out and cannot fold it again.
    energy.epsilon = 0.0;
    DescentOptions descent;
    descent.most_iterations = 100;
    const double before = now_.min;
    const std::vector<Vec3> positions(sliding_.positions().begin(), sliding_.positions().end());
    if (det > 0.0) (void)descend(sliding_, mesh_energy, descent, context_);
    record("untangle", exact_);
    if (now_.inverted > 0) {
        sliding_.set_positions(positions);
        now_.min = before;
    }
}

void MinimumRaiser::raise() {
    ascend(aim());
    constexpr double first_gap = 0.3;
    for (const double gap : {first_gap, 0.1, 0.03}) {
        if (reached_target() || is_over()) return;
        const ImproveRecord before = now_;
        lower_barrier(gap);
        ascend(aim());
        const bool gained = now_.inverted < before.inverted || now_.min >= before.min + worth_a_round;
        if (!gained && gap < first_gap) return;
    }
}

void MinimumRaiser::lower_barrier(double gap) {
    constexpr int most_repeats = 5;
    for (int i = 0; i < most_repeats; ++i) {
        const ImproveRecord before = now_;
        QualityMeshEnergy barrier(sliding_.boxes());
        barrier.floor = before.min - gap;
        DescentOptions descent;
        descent.most_iterations = 50;
        descent.relative_gain = 1e-5;
        descent.satisfied = [&] { return is_over(); };
        (void)descend(sliding_, barrier, descent, context_);
        record("barrier", exact_);
        if (is_over() || now_.min - before.min < 0.25 * gap) return;
    }
}

void MinimumRaiser::ascend(double target) {
    AscentOptions options;
    options.target = target;
    // What this gives for its price no descent does: it may go on a little longer than they.
    options.satisfied = [&] {
        return deadline_.passed() ||
               (options_.work_limit > 0.0 &&
                sliding_.work() > (share_of_work_ + share_of_ascent) * options_.work_limit);
    };
    if (raise_star_minima(sliding_, options, context_) > 0) record("ascent", exact_);
}

}  // namespace hex::improving
