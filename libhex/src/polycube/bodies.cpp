#include "polycube/bodies.h"

#include "polycube/voxel_grid.h"

#include <hex/surface/polygon_soup.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <memory>
#include <numeric>

namespace hex {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

std::size_t index(TriangleMesh::FaceHandle f) {
    return static_cast<std::size_t>(f.idx());
}
std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

Kernel::Triangle_3 to_cgal(const std::array<Vec3, 3>& p) {
    const auto point = [](const Vec3& x) { return Kernel::Point_3(x.x(), x.y(), x.z()); };
    return {point(p[0]), point(p[1]), point(p[2])};
}

/// A shell with a search tree that is only made when it is asked for.
class Shell {
  public:
    void add(const std::array<Vec3, 3>& p) {
        for (const Vec3& x : p) box_.add(x);
        corners_.push_back(p);
        const Vec3& origin = corners_.front()[0];  // near, so that no digits are lost
        volume_ += (p[0] - origin).dot((p[1] - origin).cross(p[2] - origin)) / 6.0;
    }
    const BoundingBox& box() const { return box_; }
    bool outwards() const { return volume_ >= 0.0; }

    bool meets(Shell& other) {
        const Shell& small = corners_.size() < other.corners_.size() ? *this : other;
        const Tree& large = (&small == this ? other : *this).tree();
        return std::any_of(small.corners_.begin(), small.corners_.end(),
                           [&](const auto& t) { return large.do_intersect(to_cgal(t)); });
    }
    /// Whether a shell that does not meet this one is inside: one of its points sees this one an odd number
    /// of times along +x.
    bool contains(const Shell& other) const {
        const Vec3& q = other.corners_.front()[0];
        bool inside = false;
        for (const auto& t : corners_) {
            const auto x = voxels::crossing(t, Vec2(q.y(), q.z()));
            if (x && *x > q.x()) inside = !inside;
        }
        return inside;
    }

  private:
    Tree& tree() {
        if (!tree_) {
            for (const auto& t : corners_) triangles_.push_back(to_cgal(t));
            tree_ = std::make_unique<Tree>(triangles_.cbegin(), triangles_.cend());
            tree_->build();
        }
        return *tree_;
    }
    std::vector<std::array<Vec3, 3>> corners_;
    double volume_ = 0.0;
    BoundingBox box_;
    Triangles triangles_;  ///< of the tree
    std::unique_ptr<Tree> tree_;
};

bool boxes_meet(const BoundingBox& a, const BoundingBox& b) {
    return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}
bool box_within(const BoundingBox& a, const BoundingBox& b) {
    return (a.lower.array() >= b.lower.array()).all() && (a.upper.array() <= b.upper.array()).all();
}

/// The shells that each shell is inside of.
std::vector<std::vector<std::size_t>> shells_around(std::vector<Shell>& shells) {
    std::vector<std::size_t> by_x(shells.size());
    std::iota(by_x.begin(), by_x.end(), std::size_t{0});
    std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
        const double x = shells[a].box().lower.x();
        const double y = shells[b].box().lower.x();
        return x != y ? x < y : a < b;
    });
    std::vector<std::vector<std::size_t>> around(shells.size());
    for (std::size_t i = 0; i < shells.size(); ++i) {
        for (std::size_t k = i + 1; k < shells.size(); ++k) {
            Shell& a = shells[by_x[i]];
            Shell& b = shells[by_x[k]];
            if (b.box().lower.x() > a.box().upper.x()) break;
            if (!boxes_meet(a.box(), b.box())) continue;
            const bool b_in_a = box_within(b.box(), a.box());
            const bool a_in_b = box_within(a.box(), b.box());
            if ((!b_in_a && !a_in_b) || a.meets(b)) continue;
            if (b_in_a && a.contains(b)) around[by_x[k]].push_back(by_x[i]);
            if (a_in_b && b.contains(a)) around[by_x[i]].push_back(by_x[k]);
        }
    }
    return around;
}

/// Which body each shell bounds, and whether as a void in it.
struct Nesting {
    std::vector<int> body;
    std::vector<bool> is_void;
    int bodies = 0;
};

/// Bodies are numbered by their outer shells.
Nesting nest(std::vector<Shell>& shells) {
    const auto around = shells_around(shells);
    Nesting nesting{std::vector<int>(shells.size(), -1), std::vector<bool>(shells.size(), false), 0};
    for (std::size_t s = 0; s < shells.size(); ++s)
        if (around[s].size() % 2 == 0) nesting.body[s] = nesting.bodies++;
    for (std::size_t s = 0; s < shells.size(); ++s) {
        if (nesting.body[s] >= 0) continue;
        const auto parent =
            *std::max_element(around[s].begin(), around[s].end(), [&](std::size_t a, std::size_t b) {
                return around[a].size() != around[b].size() ? around[a].size() < around[b].size() : a > b;
            });
        nesting.is_void[s] = around[parent].size() % 2 == 0;
        nesting.body[s] = nesting.is_void[s] ? nesting.body[parent] : nesting.bodies++;
    }
    return nesting;
}

/// Triangles `triangles` of the surface; those of `turned` the other way round.
Body extract(const TriangleMesh& surface, std::vector<int> triangles, std::vector<bool> turned,
             std::vector<TriangleMesh::VertexHandle>& copy) {
    Body body;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const TriangleMesh::FaceHandle f(triangles[t]);
        std::array<TriangleMesh::VertexHandle, 3> corners;
        std::size_t i = 0;
        for (const auto v : surface.fv_range(f)) {
            auto& c = copy[index(v.idx())];
            if (!c.is_valid()) {
                c = body.surface.add_vertex(surface.point(v));
                body.vertices.push_back(v.idx());
            }
            corners[i++] = c;
        }
        if (turned[t]) std::swap(corners[1], corners[2]);
        body.surface.data(body.surface.add_face(corners[0], corners[1], corners[2])) = surface.data(f);
    }
    body.triangles = std::move(triangles);
    body.turned = std::move(turned);
    return body;
}

/// A surface of one component.
Body single(const TriangleMesh& surface) {
    if (enclosed_volume(surface) >= 0.0) {
        Body body{surface, std::vector<int>(surface.n_vertices()), std::vector<int>(surface.n_faces()),
                  std::vector<bool>(surface.n_faces(), false)};
        std::iota(body.vertices.begin(), body.vertices.end(), 0);
        std::iota(body.triangles.begin(), body.triangles.end(), 0);
        return body;
    }
    std::vector<int> all(surface.n_faces());
    std::iota(all.begin(), all.end(), 0);
    std::vector<TriangleMesh::VertexHandle> copy(surface.n_vertices());
    Body body = extract(surface, std::move(all), std::vector<bool>(surface.n_faces(), true), copy);
    body.turned_shells = 1;
    return body;
}

}  // namespace

std::vector<Body> bodies_of(const TriangleMesh& surface) {
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> component = components_of(surface, count);
    std::vector<Body> bodies;
    if (count < 2) {
        bodies.push_back(single(surface));
        return bodies;
    }
    std::vector<Shell> shells(count);
    for (const auto f : surface.faces()) {
        std::array<Vec3, 3> p;
        std::size_t i = 0;
        for (const auto v : surface.fv_range(f)) p[i++] = to_eigen(surface.point(v));
        shells[component[index(f)]].add(p);
    }
    const Nesting nesting = nest(shells);
    const auto is_turned = [&](std::size_t s) { return shells[s].outwards() == nesting.is_void[s]; };

    std::vector<std::vector<int>> triangles(index(nesting.bodies));
    std::vector<std::vector<bool>> turned(triangles.size());
    for (const auto f : surface.faces()) {
        const std::size_t s = component[index(f)];
        triangles[index(nesting.body[s])].push_back(f.idx());
        turned[index(nesting.body[s])].push_back(is_turned(s));
    }
    std::vector<TriangleMesh::VertexHandle> copy(surface.n_vertices());
    for (std::size_t b = 0; b < triangles.size(); ++b)
        bodies.push_back(extract(surface, std::move(triangles[b]), std::move(turned[b]), copy));
    for (std::size_t s = 0; s < shells.size(); ++s)
        if (is_turned(s)) ++bodies[index(nesting.body[s])].turned_shells;
    return bodies;
}

}  // namespace hex
