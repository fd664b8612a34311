#include "boundary_fit.h"

#include "spline_rows.h"

#include <hex/base/parallel.h>
#include <hex/volume/hexahedron.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace spline {

using hex::Vec3;

namespace {

constexpr int samples_a_side = 5;
constexpr std::uint32_t no_hint = 0xffffffffU;

std::vector<Vec3> combine_all(const SparseRows& rows, std::span<const Vec3> positions) {
    std::vector<Vec3> points(rows.size());
    hex::parallel_for(points.size(), [&](std::size_t i) { points[i] = combine(rows[i], positions); });
    return points;
}

/// `find(i, hint)` returns the place where the search for i ended. It starts where it ended last, the first
/// time where that for i - 1 did; so in runs of fixed length, in parallel.
template <class Find>
void search_in_runs(std::vector<std::uint32_t>& hints, const Find& find) {
    constexpr std::size_t run = samples_a_side * samples_a_side;
    hex::parallel_for((hints.size() + run - 1) / run,
                      [&](std::size_t k) {
                          std::uint32_t last = 0;
                          for (std::size_t i = k * run; i < std::min(hints.size(), (k + 1) * run); ++i)
                              last = hints[i] = find(i, hints[i] == no_hint ? last : hints[i]);
                      },
                      1);
}

double root_mean_square(const std::vector<double>& squares) {
    return std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) /
                     static_cast<double>(squares.size()));
}

double largest(const std::vector<double>& squares) {
    return std::sqrt(*std::max_element(squares.begin(), squares.end()));
}

}  // namespace

SparseRows edge_differences(const BezierSpline& spline, bool boundary_only) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    const auto& corner = hex::hexahedron::bezier_corner;
    const auto add = [&](std::size_t e, int a, int b) {
        std::array<std::uint32_t, 2> edge = {
            spline.elements[e][static_cast<std::size_t>(corner[static_cast<std::size_t>(a)])],
            spline.elements[e][static_cast<std::size_t>(corner[static_cast<std::size_t>(b)])]};
        if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
        edges.push_back(edge);
    };
    if (boundary_only) {
        for (const BoundaryFace& face : boundary_faces(spline)) {
            const auto& corners = hex::hexahedron::face_corners[face.face];
            for (std::size_t k = 0; k < 4; ++k) add(face.element, corners[k], corners[(k + 1) % 4]);
        }
    } else {
        for (std::size_t e = 0; e < spline.element_count(); ++e)
            for (const auto& [a, b] : hex::hexahedron::edge_corners) add(e, a, b);
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return build_rows<RealRowSum>(edges.size(), [&](std::size_t i, RealRowSum& sum) {
        for (std::size_t end = 0; end < 2; ++end) {
            const SparseRow row = spline.rows[edges[i][end]];
            for (std::size_t k = 0; k < row.size(); ++k)
                sum.add(row.columns[k], end == 0 ? row.values[k] : -row.values[k]);
        }
    });
}

/// Closest points of both sides' samples.
struct BoundaryFit::Found {
    std::vector<Vec3> points;                     ///< of the grid
    std::vector<hex::ClosestPoint::Answer> feet;  ///< on the part
    std::vector<SampledBoundary::Answer> places;  ///< on the boundary, of the part's samples
};

BoundaryFit::BoundaryFit(const BezierSpline& spline, const hex::TriangleMesh& surface)
    : spline_(spline),
      part_(surface),
      faces_(boundary_faces(spline)),
      grid_(boundary_grid(faces_.size(), samples_a_side)),
      grid_rows_(boundary_rows(spline, faces_, grid_)),
      hint_of_grid_(grid_.size(), no_hint),
      hint_of_part_(part_.samples().size(), no_hint) {
    for (const auto& [from, to] : boundary_creases(spline, faces_)) {
        for (int i = 0; i < samples_a_side; ++i) {
            const double t = static_cast<double>(i) / (samples_a_side - 1);
            crease_places_.push_back(
                {from.face, {(1.0 - t) * from.st[0] + t * to.st[0], (1.0 - t) * from.st[1] + t * to.st[1]}});
        }
    }
    crease_rows_ = boundary_rows(spline, faces_, crease_places_);
}

BoundaryFit::Found BoundaryFit::search(std::span<const Vec3> control_points) {
    Found found;
    found.points = combine_all(grid_rows_, control_points);
    found.feet.resize(found.points.size());
    search_in_runs(hint_of_grid_, [&](std::size_t i, std::uint32_t hint) {
        found.feet[i] = part_.search()(found.points[i], hint);
        return found.feet[i].triangle;
    });
    const SampledBoundary boundary(grid_, samples_a_side, found.points);
    found.places.resize(part_.samples().size());
    search_in_runs(hint_of_part_, [&](std::size_t i, std::uint32_t hint) {
        found.places[i] = boundary.closest(part_.samples()[i].point, hint);
        return found.places[i].triangle;
    });
    return found;
}

FitDistance BoundaryFit::measure(std::span<const Vec3> control_points) {
    const Found found = search(control_points);
    std::vector<double> squares(found.points.size());
    for (std::size_t i = 0; i < squares.size(); ++i)
        squares[i] = (found.feet[i].point - found.points[i]).squaredNorm();
    FitDistance distance;
    distance.to_surface_rms = root_mean_square(squares);
    distance.to_surface_max = largest(squares);
    squares.resize(found.places.size());
    for (std::size_t i = 0; i < squares.size(); ++i)
        squares[i] = (found.places[i].point - part_.samples()[i].point).squaredNorm();
    distance.from_surface_rms = root_mean_square(squares);
    distance.from_surface_max = largest(squares);
    return distance;
}

std::vector<double> BoundaryFit::errors_of_elements(std::span<const Vec3> control_points) {
    const Found found = search(control_points);
    std::vector<double> errors(spline_.element_count(), -1.0);
    const auto add = [&](const BoundaryPlace& place, double distance) {
        double& error = errors[faces_[place.face].element];
        error = std::max(error, distance);
    };
    for (std::size_t i = 0; i < found.points.size(); ++i)
        add(grid_[i], (found.feet[i].point - found.points[i]).norm());
    for (std::size_t i = 0; i < found.places.size(); ++i)
        add(found.places[i].place, (found.places[i].point - part_.samples()[i].point).norm());
    return errors;
}

SquareTerms BoundaryFit::pulls(std::span<const Vec3> control_points, double emphasis) {
    const Found found = search(control_points);
    std::vector<double> squares(found.points.size());
    for (std::size_t i = 0; i < squares.size(); ++i)
        squares[i] = (found.feet[i].point - found.points[i]).squaredNorm();
    const double far = 4.0 * std::pow(root_mean_square(squares), 2);
    const auto weight_of = [&](double square) {
        return 1.0 + (far > 0.0 ? std::min(emphasis - 1.0, square / far) : 0.0);
    };
    SquareTerms terms;
    terms.rows = grid_rows_;
    terms.residuals.resize(found.points.size());
    terms.metrics.resize(found.points.size());
    hex::parallel_for(found.points.size(), [&](std::size_t i) {
        const PartTarget target = part_.target(found.points[i], found.feet[i]);
        const double weight = weight_of(squares[i]) / static_cast<double>(found.points.size());
        terms.residuals[i] = found.points[i] - target.point;
        terms.metrics[i] = target.metric;
        terms.metrics[i].isotropic *= weight;
        terms.metrics[i].axial *= weight;
    });

    std::vector<BoundaryPlace> places;
    double area = 0.0;
    for (std::size_t i = 0; i < found.places.size(); ++i) {
        places.push_back(found.places[i].place);
        area += part_.samples()[i].area;
    }
    const SparseRows part_rows = boundary_rows(spline_, faces_, places);
    append(terms.rows, part_rows);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vec3 residual = combine(part_rows[i], control_points) - part_.samples()[i].point;
        const double length = residual.norm();
        const double weight = 0.5 * weight_of(length * length) * part_.samples()[i].area / area;
        terms.residuals.push_back(residual);
        terms.metrics.push_back({length > 0.0 ? Vec3(residual / length) : Vec3::Zero(),
                                 Part::sliding * weight, (1.0 - Part::sliding) * weight});
    }
    pull_creases(control_points, terms);
    return terms;
}

void BoundaryFit::pull_creases(std::span<const Vec3> control_points, SquareTerms& terms) const {
    const std::vector<Vec3> points = combine_all(crease_rows_, control_points);
    // Like the samples of half the faces on both sides.
    const double weight = samples_a_side / static_cast<double>(grid_.size());
    append(terms.rows, crease_rows_);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t first = i - i % samples_a_side;
        const Vec3 along = points[first + samples_a_side - 1] - points[first];
        const auto target = part_.crease_target(points[i], along.normalized(), 0.5 * along.norm());
        terms.residuals.push_back(target ? Vec3(points[i] - target->point) : Vec3::Zero());
        SquareMetric metric = target ? target->metric : SquareMetric();
        metric.isotropic *= weight;
        metric.axial *= weight;
        terms.metrics.push_back(metric);
    }
}

}  // namespace spline
