#include "segment/cvt.h"

#include <hex/base/parallel.h>

#include <tbb/enumerable_thread_specific.h>

#include <cmath>

namespace hex {
namespace {

constexpr std::size_t fewest_moves = 3;  ///< a sweep with fewer moves is the last one
constexpr int most_classical_sweeps = 51;
constexpr int most_boundary_sweeps = 201;

/// The vector at unit length; `fallback` when it has none.
Vec3 unit(const Vec3& v, const Vec3& fallback) {
    const double length = std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
    return length > 0.0 ? Vec3(v / length) : fallback;
}

/// Half the distance between a normal and a generator: the classical distance.
double classical_distance(const Vec3& normal, const Vec3& generator) {
    const double x = normal.x() - generator.x();
    const double y = normal.y() - generator.y();
    const double z = normal.z() - generator.z();
    return 0.5 * std::sqrt(x * x + y * y + z * z);
}

/// Classical CVT alone.
class Cvt final : public Segmenter {
  public:
    SegmentResult segment(const TriangleMesh& mesh, const SegmentOptions&,
                          const Context& context) const override {
        SegmentResult result;
        CvtState state(mesh, context);
        state.sweep_classical(result.report.sweeps);
        result.segmentation.labels = state.labels();
        result.report.generators = state.generators();
        return result;
    }
};

const Register<Segmenter, Cvt> registered(segmenters(), "cvt",
                                          "centroidal Voronoi tessellation of the normals");

}  // namespace

CvtState::CvtState(const TriangleMesh& mesh, const Context& context)
    : context_(context),
      arrays_(triangle_arrays(mesh)),
      normals_(unit_normals(mesh, arrays_)),
      ring_(arrays_) {
    initial_labels();
    initial_generators();
    initial_histograms();
}

void CvtState::initial_labels() {
    labels_.resize(arrays_.size());
    parallel_for(arrays_.size(), [&](std::size_t t) {
        int best = 0;
        for (int k = 1; k < 6; ++k) {
            if (classical_distance(normals_[t], label_axis(k)) <
                classical_distance(normals_[t], label_axis(best)))
                best = k;
        }
        labels_[t] = best;
    });
}

void CvtState::initial_generators() {
    // Areas do not weigh: the published runs count every triangle once.
    std::array<Vec3, 6> sums;
    sums.fill(Vec3::Zero());
    for (std::size_t t = 0; t < arrays_.size(); ++t) {
        const auto k = static_cast<std::size_t>(labels_[t]);
        sums[k] += normals_[t];
        counts_[k] += 1.0;
    }
    for (std::size_t k = 0; k < 6; ++k) {
        const Vec3 axis = label_axis(static_cast<int>(k));
        generators_[k] = counts_[k] > 0.0 ? unit(sums[k] / counts_[k], axis) : axis;
    }
}

void CvtState::initial_histograms() {
    histograms_.assign(arrays_.size(), Histogram{});
    ring_sizes_.assign(arrays_.size(), 0);
    tbb::enumerable_thread_specific<TwoRing> rings([&] { return TwoRing(arrays_); });
    parallel_for(
        arrays_.size(),
        [&](std::size_t t) {
            Histogram& histogram = histograms_[t];
            rings.local().for_each(t, [&](std::size_t other) {
                ++histogram[static_cast<std::size_t>(labels_[other])];
                ++ring_sizes_[t];
            });
        },
        512);
}

double CvtState::squared_distance(std::size_t triangle, int label) const {
    const double d = classical_distance(normals_[triangle], generators_[static_cast<std::size_t>(label)]);
    return d * d;
}

double CvtState::boundary_term(std::size_t triangle, int members, double weight) const {
    const double size = ring_sizes_[triangle];
    return 2.0 * weight * (size - members) / size;
}

double CvtState::energy(double boundary_weight) const {
    double sum = 0.0;
    for (std::size_t t = 0; t < labels_.size(); ++t) {
        sum += squared_distance(t, labels_[t]);
        if (boundary_weight > 0.0)
            sum += boundary_term(t, histograms_[t][static_cast<std::size_t>(labels_[t])], boundary_weight);
    }
    return sum;
}

bool CvtState::on_label_boundary(std::size_t triangle) const {
    for (const int n : arrays_.neighbours[triangle]) {
        if (n >= 0 && labels_[static_cast<std::size_t>(n)] != labels_[triangle]) return true;
    }
    return false;
}

void CvtState::relabel(std::size_t triangle, int label) {
    const auto from = static_cast<std::size_t>(labels_[triangle]);
    const auto to = static_cast<std::size_t>(label);
    ring_.for_each(triangle, [&](std::size_t other) {
        --histograms_[other][from];
        ++histograms_[other][to];
    });
    labels_[triangle] = label;
}

void CvtState::move_generators(std::size_t triangle, int from, int to) {
    const Vec3& normal = normals_[triangle];
    const auto gain = static_cast<std::size_t>(to);
    const auto lose = static_cast<std::size_t>(from);
    generators_[gain] =
        unit((counts_[gain] * generators_[gain] + normal) / (counts_[gain] + 1.0), generators_[gain]);
    counts_[gain] += 1.0;
    counts_[lose] -= 1.0;
    // The last member leaves: nothing to average, the label keeps its axis.
    generators_[lose] =
        counts_[lose] > 0.0
            ? unit(((counts_[lose] + 1.0) * generators_[lose] - normal) / counts_[lose], generators_[lose])
            : label_axis(from);
}

template <class Distance, class Moved>
std::size_t CvtState::sweep(const Distance& distance, const Moved& moved) {
    std::size_t moves = 0;
    for (std::size_t t = 0; t < labels_.size(); ++t) {
        if (!on_label_boundary(t)) continue;
        const int current = labels_[t];
        int best = current;
        double nearest = distance(t, current);
        for (int k = 0; k < 6; ++k) {
            if (k == current || histograms_[t][static_cast<std::size_t>(k)] == 0) continue;
            const double d = distance(t, k);
            if (d < nearest) {
                nearest = d;
                best = k;
            }
        }
        if (best == current) continue;
        relabel(t, best);
        moved(t, current, best);
        ++moves;
    }
    return moves;
}

void CvtState::sweep_classical(std::vector<SweepRecord>& records) {
    for (int number = 1; number <= most_classical_sweeps; ++number) {
        context_.check_cancelled();
        context_.progress("cvt", static_cast<double>(number - 1) / most_classical_sweeps);
        const std::size_t moves = sweep(
            [&](std::size_t t, int k) {
                return classical_distance(normals_[t], generators_[static_cast<std::size_t>(k)]);
            },
            [&](std::size_t t, int from, int to) { move_generators(t, from, to); });
        records.push_back({"cvt", number, moves, energy(0.0)});
        if (moves < fewest_moves) break;
    }
    context_.progress("cvt", 1.0);
}

void CvtState::sweep_boundary_enhanced(double weight, std::vector<SweepRecord>& records) {
    for (int number = 1; number <= most_boundary_sweeps; ++number) {
        context_.check_cancelled();
        context_.progress("hbecvt", static_cast<double>(number - 1) / most_boundary_sweeps);
        const std::size_t moves = sweep(
            [&](std::size_t t, int k) {
                // What the two-ring would hold after the move: the triangle itself counts with its label.
                const int members = histograms_[t][static_cast<std::size_t>(k)] + (k == labels_[t] ? 0 : 1);
                return squared_distance(t, k) + boundary_term(t, members, weight);
            },
            [](std::size_t, int, int) {});
        records.push_back({"hbecvt", number, moves, energy(weight)});
        if (moves < fewest_moves) break;
    }
    context_.progress("hbecvt", 1.0);
}

}  // namespace hex
