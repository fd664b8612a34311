#include "improve/surface_constraint.h"

#include <hex/base/error.h>
#include <hex/surface/polygon_soup.h>

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <limits>
#include <vector>

namespace hex::improving {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;

Point to_cgal(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}
Vec3 from_cgal(const Point& p) {
    return {p.x(), p.y(), p.z()};
}

/// Triangles or segments with their search tree. Not movable: the tree points into `items`.
template <class Item, template <class, class, class> class Primitive>
struct SearchSet {
    using Iterator = typename std::vector<Item>::const_iterator;
    using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive<Kernel, Iterator, CGAL::Tag_false>>>;

    std::vector<Item> items;
    Tree tree;

    explicit SearchSet(std::vector<Item> given) : items(std::move(given)) {
        tree.insert(items.begin(), items.end());
        tree.build();
    }

    /// Closest point to p; the search starts from item `hint`, whose number is replaced.
    Vec3 closest(const Vec3& p, std::uint32_t& hint) const {
        const Iterator start = items.begin() + static_cast<std::ptrdiff_t>(hint);
        const auto found = tree.closest_point_and_primitive(to_cgal(p), std::pair(start->vertex(0), start));
        hint = static_cast<std::uint32_t>(found.second - items.begin());
        return from_cgal(found.first);
    }
};
using Region = SearchSet<Kernel::Triangle_3, CGAL::AABB_triangle_primitive>;
using Curve = SearchSet<Kernel::Segment_3, CGAL::AABB_segment_primitive>;

/// Numbers of the connected components under `join` calls.
class Components {
  public:
    explicit Components(std::size_t count) : parent_(count) {
        for (std::size_t i = 0; i < count; ++i) parent_[i] = i;
    }
    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    std::size_t size() const { return parent_.size(); }
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::size_t> parent_;
};

/// Search sets of the components of some items, and one of all of them to find the component in.
template <class Set>
struct Family {
    struct Place {
        std::uint32_t set;
        std::uint32_t item;  // within the set
    };
    std::vector<std::unique_ptr<Set>> sets;
    std::vector<Place> place;  // of each item
    std::unique_ptr<Set> all;
};

/// Components come in the order of their first item. Item i belongs to the component of `member[i]`.
template <class Set, class Item>
Family<Set> make_family(std::vector<Item> items, const std::vector<std::size_t>& member,
                        Components& components) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> set_of(components.size(), none);
    std::vector<std::vector<Item>> lists;
    Family<Set> family;
    for (std::size_t i = 0; i < items.size(); ++i) {
        std::uint32_t& set = set_of[components.root(member[i])];
        if (set == none) {
            set = static_cast<std::uint32_t>(lists.size());
            lists.emplace_back();
        }
        family.place.push_back({set, static_cast<std::uint32_t>(lists[set].size())});
        lists[set].push_back(items[i]);
    }
    for (auto& list : lists) family.sets.push_back(std::make_unique<Set>(std::move(list)));
    if (!items.empty()) family.all = std::make_unique<Set>(std::move(items));
    return family;
}

}  // namespace

struct SurfaceConstraint::State {
    Family<Region> regions;
    Family<Curve> curves;
    std::vector<Vec3> corners;
    /// Of each sharp edge: the corners at its two ends, or none.
    std::vector<std::array<std::int64_t, 2>> corners_of_segment;
    double diagonal = 0.0;
};

SurfaceConstraint::SurfaceConstraint(const TriangleMesh& surface, double cosine)
    : state_(std::make_unique<State>()) {
    state_->diagonal = bounding_box(surface).diagonal();
    const auto point = [&](TriangleMesh::VertexHandle v) { return to_eigen(surface.point(v)); };
    const auto index = [](const auto& handle) { return static_cast<std::size_t>(handle.idx()); };

    // Vector areas of the triangles; one without area has no normal and never makes an edge sharp.
    std::vector<Vec3> normal(surface.n_faces(), Vec3::Zero());
    std::vector<Kernel::Triangle_3> triangles;
    std::vector<std::size_t> face_of_triangle;
    for (const auto f : surface.faces()) {
        std::array<Vec3, 3> p;
        std::size_t i = 0;
        for (const auto v : surface.fv_range(f)) p[i++] = point(v);
        const Vec3 area = (p[1] - p[0]).cross(p[2] - p[0]);
        const double length = area.norm();
        if (!(length > 0.0)) continue;
        normal[index(f)] = area / length;
        triangles.emplace_back(to_cgal(p[0]), to_cgal(p[1]), to_cgal(p[2]));
        face_of_triangle.push_back(index(f));
    }
    if (triangles.empty())
        throw Error(ErrorKind::bad_input, "the surface to stay on has no triangle with an area");

    Components regions(surface.n_faces());
    std::vector<TriangleMesh::EdgeHandle> sharp;
    std::vector<int> sharp_edges_at(surface.n_vertices(), 0);
    for (const auto e : surface.edges()) {
        const auto h = surface.halfedge_handle(e, 0);
        const auto f = surface.face_handle(h);
        const auto g = surface.face_handle(surface.opposite_halfedge_handle(h));
        const bool two = f.is_valid() && g.is_valid();
        const bool flat = two && (normal[index(f)].isZero(0.0) || normal[index(g)].isZero(0.0) ||
                                  normal[index(f)].dot(normal[index(g)]) >= cosine);
        if (flat) {
            regions.join(index(f), index(g));
        } else {
            sharp.push_back(e);
            ++sharp_edges_at[index(surface.to_vertex_handle(h))];
            ++sharp_edges_at[index(surface.from_vertex_handle(h))];
        }
    }
    state_->regions = make_family<Region>(std::move(triangles), face_of_triangle, regions);

    // Sharp edges hang together through vertices that are no corners.
    std::vector<std::int64_t> corner_at(surface.n_vertices(), -1);
    for (const auto v : surface.vertices()) {
        const int count = sharp_edges_at[index(v)];
        if (count == 0 || count == 2) continue;
        corner_at[index(v)] = static_cast<std::int64_t>(state_->corners.size());
        state_->corners.push_back(point(v));
    }
    Components curves(sharp.size());
    std::vector<std::size_t> first_at(surface.n_vertices(), std::numeric_limits<std::size_t>::max());
    std::vector<Kernel::Segment_3> segments;
    std::vector<std::size_t> own_number;
    for (std::size_t s = 0; s < sharp.size(); ++s) {
        const auto h = surface.halfedge_handle(sharp[s], 0);
        const auto a = surface.from_vertex_handle(h);
        const auto b = surface.to_vertex_handle(h);
        segments.emplace_back(to_cgal(point(a)), to_cgal(point(b)));
        own_number.push_back(s);
        state_->corners_of_segment.push_back({corner_at[index(a)], corner_at[index(b)]});
        for (const auto v : {a, b}) {
            if (sharp_edges_at[index(v)] != 2) continue;
            if (first_at[index(v)] == std::numeric_limits<std::size_t>::max())
                first_at[index(v)] = s;
            else
                curves.join(first_at[index(v)], s);
        }
    }
    state_->curves = make_family<Curve>(std::move(segments), own_number, curves);
}

SurfaceConstraint::~SurfaceConstraint() = default;

SurfaceConstraint::Home SurfaceConstraint::find_home(const Vec3& p, double reach) const {
    if (state_->curves.all && reach >= 0.0) {
        std::uint32_t segment = 0;
        if ((state_->curves.all->closest(p, segment) - p).norm() <= reach) {
            for (const std::int64_t corner : state_->corners_of_segment[segment]) {
                if (corner >= 0 && (state_->corners[static_cast<std::size_t>(corner)] - p).norm() <= reach)
                    return {Kind::corner, static_cast<std::uint32_t>(corner), 0};
            }
            const auto& place = state_->curves.place[segment];
            return {Kind::curve, place.set, place.item};
        }
    }
    std::uint32_t triangle = 0;
    (void)state_->regions.all->closest(p, triangle);
    const auto& place = state_->regions.place[triangle];
    return {Kind::region, place.set, place.item};
}

Vec3 SurfaceConstraint::project(const Vec3& p, Home& home) const {
    switch (home.kind) {
        case Kind::corner:
            return state_->corners[home.index];
        case Kind::curve:
            return state_->curves.sets[home.index]->closest(p, home.hint);
        case Kind::region:
            return state_->regions.sets[home.index]->closest(p, home.hint);
    }
    return p;
}

double SurfaceConstraint::diagonal() const {
    return state_->diagonal;
}

}  // namespace hex::improving
