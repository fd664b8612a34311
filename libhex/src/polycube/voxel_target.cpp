#include "polycube/voxel_target.h"

#include <hex/surface/polygon_soup.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <map>

namespace hex::voxels {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using ExactKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <class K>
using Triangles = std::vector<typename K::Triangle_3>;
template <class K>
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<K, CGAL::AABB_triangle_primitive<K, typename Triangles<K>::const_iterator>>>;

std::size_t index(TriangleMesh::FaceHandle f) {
    return static_cast<std::size_t>(f.idx());
}

template <class K>
typename K::Triangle_3 triangle(const TriangleMesh& surface, TriangleMesh::FaceHandle f) {
    std::array<typename K::Point_3, 3> p;
    std::size_t i = 0;
    for (const auto v : surface.fv_range(f)) {
        const auto& q = surface.point(v);
        p[i++] = typename K::Point_3(q[0], q[1], q[2]);
    }
    return {p[0], p[1], p[2]};
}

/// Numbers of the connected components of the triangles.
std::vector<int> components_of(const TriangleMesh& surface, int& count) {
    std::vector<int> component(surface.n_faces(), -1);
    std::vector<TriangleMesh::FaceHandle> stack;
    count = 0;
    for (const auto start : surface.faces()) {
        if (component[index(start)] >= 0) continue;
        component[index(start)] = count;
        stack.push_back(start);
        while (!stack.empty()) {
            const auto f = stack.back();
            stack.pop_back();
            for (const auto g : surface.ff_range(f)) {
                if (component[index(g)] >= 0) continue;
                component[index(g)] = count;
                stack.push_back(g);
            }
        }
        ++count;
    }
    return component;
}

/// A shell with a search tree that is only made when it is asked for.
class Shell {
  public:
    void add(const ExactKernel::Triangle_3& t) {
        triangles_.push_back(t);
        for (int i = 0; i < 3; ++i) box_.add(Vec3(t[i].x(), t[i].y(), t[i].z()));
    }
    const BoundingBox& box() const { return box_; }

    bool meets(Shell& other) {
        Shell& small = triangles_.size() < other.triangles_.size() ? *this : other;
        Tree<ExactKernel>& large = (&small == this ? other : *this).tree();
        return std::any_of(small.triangles_.begin(), small.triangles_.end(),
                           [&](const auto& t) { return large.do_intersect(t); });
    }
    /// Whether a shell that does not meet this one is inside: one of its points sees this one an odd number
    /// of times along +x.
    bool contains(const Shell& other) const {
        const auto& q = other.triangles_.front()[0];
        bool inside = false;
        for (const auto& t : triangles_) {
            const auto x = crossing({Vec3(t[0].x(), t[0].y(), t[0].z()), Vec3(t[1].x(), t[1].y(), t[1].z()),
                                     Vec3(t[2].x(), t[2].y(), t[2].z())},
                                    Vec2(q.y(), q.z()));
            if (x && *x > q.x()) inside = !inside;
        }
        return inside;
    }

  private:
    Tree<ExactKernel>& tree() {
        if (!tree_) {
            tree_ = std::make_unique<Tree<ExactKernel>>(triangles_.cbegin(), triangles_.cend());
            tree_->build();
        }
        return *tree_;
    }
    Triangles<ExactKernel> triangles_;
    BoundingBox box_;
    std::unique_ptr<Tree<ExactKernel>> tree_;
};

bool boxes_meet(const BoundingBox& a, const BoundingBox& b) {
    return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}
bool box_within(const BoundingBox& a, const BoundingBox& b) {
    return (a.lower.array() >= b.lower.array()).all() && (a.upper.array() <= b.upper.array()).all();
}

/// The body of each shell, numbered by their first shells.
std::vector<int> body_of_shells(std::vector<Shell>& shells, int& count) {
    const std::size_t n = shells.size();
    std::vector<std::size_t> by_x(n);
    for (std::size_t i = 0; i < n; ++i) by_x[i] = i;
    std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
        const double x = shells[a].box().lower.x();
        const double y = shells[b].box().lower.x();
        return x != y ? x < y : a < b;
    });
    std::vector<std::vector<std::size_t>> around(n);  // the shells that a shell is inside of
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = i + 1; k < n; ++k) {
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
    std::vector<int> body(n, -1);
    count = 0;
    for (std::size_t s = 0; s < n; ++s)
        if (around[s].size() % 2 == 0) body[s] = count++;
    for (std::size_t s = 0; s < n; ++s) {
        if (body[s] >= 0) continue;
        const auto parent =
            *std::max_element(around[s].begin(), around[s].end(), [&](std::size_t a, std::size_t b) {
                return around[a].size() != around[b].size() ? around[a].size() < around[b].size() : a > b;
            });
        body[s] = around[parent].size() % 2 == 0 ? body[parent] : count++;
    }
    return body;
}

}  // namespace

struct Target::Search {
    Triangles<Kernel> triangles;
    Tree<Kernel> tree;
};

Target::Target(const TriangleMesh& surface) {
    int count = 0;
    component_ = components_of(surface, count);
    components_.resize(static_cast<std::size_t>(count));
    const auto own = [&](TriangleMesh::FaceHandle f) -> Component& {
        return components_[static_cast<std::size_t>(component_[index(f)])];
    };
    std::vector<int> at_vertex(surface.n_vertices(), -1);
    for (const auto f : surface.faces()) {
        own(f).euler += 1;
        for (const auto v : surface.fv_range(f)) {
            at_vertex[static_cast<std::size_t>(v.idx())] = component_[index(f)];
            own(f).box.add(to_eigen(surface.point(v)));
        }
    }
    for (const int c : at_vertex)
        if (c >= 0) components_[static_cast<std::size_t>(c)].euler += 1;
    for (const auto e : surface.edges()) {
        const auto h = surface.halfedge_handle(e, 0);
        const auto f = surface.face_handle(h).is_valid()
                           ? surface.face_handle(h)
                           : surface.face_handle(surface.opposite_halfedge_handle(h));
        own(f).euler -= 1;
    }
    if (count < 2) return;
    search_ = std::make_unique<Search>();
    for (const auto f : surface.faces()) search_->triangles.push_back(triangle<Kernel>(surface, f));
    search_->tree.insert(search_->triangles.cbegin(), search_->triangles.cend());
    search_->tree.build();
}

Target::~Target() = default;

std::size_t Target::nearest(const Vec3& p) const {
    if (!search_) return 0;
    const auto found = search_->tree.closest_point_and_primitive(Kernel::Point_3(p.x(), p.y(), p.z()));
    return static_cast<std::size_t>(
        component_[static_cast<std::size_t>(found.second - search_->triangles.cbegin())]);
}

Correspondence correspond(const CellSet& cells, const Pieces& pieces, const Target& target) {
    constexpr std::size_t most_votes = 500;
    const Grid& grid = cells.grid();
    std::vector<std::vector<std::size_t>> votes(pieces.boundaries.size(),
                                                std::vector<std::size_t>(target.size(), 0));
    if (target.size() > 1) {
        std::map<std::pair<int, int>, std::size_t> number;
        for (std::size_t b = 0; b < pieces.boundaries.size(); ++b)
            number[{pieces.boundaries[b].inner, pieces.boundaries[b].outer}] = b;
        std::vector<std::size_t> seen(pieces.boundaries.size(), 0);
        for (std::size_t i = 0; i < grid.cell_count(); ++i) {
            if (!cells.taken(i)) continue;
            const Cell c = grid.cell(i);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (const int up : {0, 1}) {
                    Cell n = c;
                    n[axis] += 2 * up - 1;
                    const std::size_t other = grid.index(n);
                    if (cells.taken(other)) continue;
                    const std::size_t b = number.at({pieces.piece[i], pieces.piece[other]});
                    const std::size_t stride = 1 + pieces.boundaries[b].faces / most_votes;
                    if (seen[b]++ % stride != 0) continue;
                    Vec3 middle = 0.5 * (grid.node(c) + grid.node({c[0] + 1, c[1] + 1, c[2] + 1}));
                    middle[static_cast<Eigen::Index>(axis)] =
                        grid.planes[axis][static_cast<std::size_t>(c[axis] + up)];
                    ++votes[b][target.nearest(middle)];
                }
            }
        }
    }
    Correspondence result{std::vector<int>(pieces.boundaries.size(), -1),
                          std::vector<int>(target.size(), -1)};
    for (std::size_t b = 0; b < pieces.boundaries.size(); ++b) {
        const auto s =
            static_cast<std::size_t>(std::max_element(votes[b].begin(), votes[b].end()) - votes[b].begin());
        const int present = result.boundary[s];
        if (present >= 0 &&
            pieces.boundaries[static_cast<std::size_t>(present)].faces >= pieces.boundaries[b].faces)
            continue;
        if (present >= 0) result.component[static_cast<std::size_t>(present)] = -1;
        result.boundary[s] = static_cast<int>(b);
        result.component[b] = static_cast<int>(s);
    }
    return result;
}

std::vector<TriangleMesh> bodies_of(const TriangleMesh& surface) {
    int count = 0;
    const std::vector<int> component = components_of(surface, count);
    if (count < 2) return {surface};
    std::vector<Shell> shells(static_cast<std::size_t>(count));
    for (const auto f : surface.faces())
        shells[static_cast<std::size_t>(component[index(f)])].add(triangle<ExactKernel>(surface, f));
    const std::vector<int> body = body_of_shells(shells, count);
    std::vector<TriangleMesh> bodies(static_cast<std::size_t>(count));
    std::vector<TriangleMesh::VertexHandle> copy(surface.n_vertices());
    for (const auto f : surface.faces()) {
        TriangleMesh& own =
            bodies[static_cast<std::size_t>(body[static_cast<std::size_t>(component[index(f)])])];
        std::array<TriangleMesh::VertexHandle, 3> corners;
        std::size_t i = 0;
        for (const auto v : surface.fv_range(f)) {
            auto& c = copy[static_cast<std::size_t>(v.idx())];
            if (!c.is_valid()) c = own.add_vertex(surface.point(v));
            corners[i++] = c;
        }
        own.add_face(corners[0], corners[1], corners[2]);
    }
    return bodies;
}

}  // namespace hex::voxels
