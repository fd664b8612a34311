#include <hex/map/chain_curve.h>

#include <algorithm>

namespace hex {
namespace {

std::vector<Vec3> chain_points(const TriangleMesh& mesh, const Chain& chain) {
    std::vector<Vec3> points;
    points.reserve(chain.size());
    for (const int v : chain) points.push_back(to_eigen(mesh.point(TriangleMesh::VertexHandle(v))));
    return points;
}

}  // namespace

ChainCurve::ChainCurve(std::vector<Vec3> points) : points_(std::move(points)), parameters_(points_.size()) {
    for (std::size_t i = 1; i < points_.size(); ++i)
        parameters_[i] = parameters_[i - 1] + (points_[i] - points_[i - 1]).norm();
    length_ = parameters_.back();
    const auto last = static_cast<double>(points_.size() - 1);
    for (std::size_t i = 0; i < points_.size(); ++i)
        parameters_[i] = length_ > 0.0 ? parameters_[i] / length_ : static_cast<double>(i) / last;
}

ChainCurve::ChainCurve(const TriangleMesh& mesh, const Chain& chain)
    : ChainCurve(chain_points(mesh, chain)) {}

Vec3 ChainCurve::point(double t) const {
    if (t <= 0.0) return points_.front();
    if (t >= 1.0) return points_.back();
    // The first parameter beyond t: its edge has positive length and contains t.
    const auto after = std::upper_bound(parameters_.begin(), parameters_.end(), t);
    const auto i = static_cast<std::size_t>(after - parameters_.begin());
    const double share = (t - parameters_[i - 1]) / (parameters_[i] - parameters_[i - 1]);
    return (1.0 - share) * points_[i - 1] + share * points_[i];
}

}  // namespace hex
