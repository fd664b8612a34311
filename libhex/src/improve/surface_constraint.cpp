#include "improve/surface_constraint.h"

#include "improve/components.h"
#include "surface/search_set.h"

#include <hex/base/error.h>
#include <hex/surface/polygon_soup.h>

#include <array>
#include <limits>
#include <vector>

namespace hex::improving {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

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
Family<Set> make_family(std::vector<Item> items, const std::vector<std::uint32_t>& member,
                        Components& components) {
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
    Family<TriangleSearch> regions;
    Family<SegmentSearch> curves;
    std::vector<Vec3> corners;
    /// Of each sharp edge: the corners at its two ends, or none.
    std::vector<std::array<std::int64_t, 2>> corners_of_segment;
    double diagonal = 0.0;
};

SurfaceConstraint::SurfaceConstraint(const TriangleMesh& surface, double cosine)
    : state_(std::make_unique<State>()) {
    state_->diagonal = bounding_box(surface).diagonal();
    const auto point = [&](TriangleMesh::VertexHandle v) { return to_eigen(surface.point(v)); };
    const auto index = [](const auto& handle) { return static_cast<std::uint32_t>(handle.idx()); };

    // Vector areas of the triangles; one without area has no normal and never makes an edge sharp.
    std::vector<Vec3> normal(surface.n_faces(), Vec3::Zero());
    std::vector<SearchTriangle> triangles;
    std::vector<std::uint32_t> face_of_triangle;
    for (const auto f : surface.faces()) {
        std::array<Vec3, 3> p;
        std::size_t i = 0;
        for (const auto v : surface.fv_range(f)) p[i++] = point(v);
        const Vec3 area = (p[1] - p[0]).cross(p[2] - p[0]);
        const double length = area.norm();
        if (!(length > 0.0)) continue;
        normal[index(f)] = area / length;
        triangles.push_back(p);
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
    state_->regions = make_family<TriangleSearch>(std::move(triangles), face_of_triangle, regions);

    // Sharp edges hang together through vertices that are no corners.
    std::vector<std::int64_t> corner_at(surface.n_vertices(), -1);
    for (const auto v : surface.vertices()) {
        const int count = sharp_edges_at[index(v)];
        if (count == 0 || count == 2) continue;
        corner_at[index(v)] = static_cast<std::int64_t>(state_->corners.size());
        state_->corners.push_back(point(v));
    }
    Components curves(sharp.size());
    std::vector<std::uint32_t> first_at(surface.n_vertices(), none);
    std::vector<SearchSegment> segments;
    std::vector<std::uint32_t> own_number;
    for (std::uint32_t s = 0; s < sharp.size(); ++s) {
        const auto h = surface.halfedge_handle(sharp[s], 0);
        const auto a = surface.from_vertex_handle(h);
        const auto b = surface.to_vertex_handle(h);
        segments.push_back({point(a), point(b)});
        own_number.push_back(s);
        state_->corners_of_segment.push_back({corner_at[index(a)], corner_at[index(b)]});
        for (const auto v : {a, b}) {
            if (sharp_edges_at[index(v)] != 2) continue;
            if (first_at[index(v)] == none)
                first_at[index(v)] = s;
            else
                curves.join(first_at[index(v)], s);
        }
    }
    state_->curves = make_family<SegmentSearch>(std::move(segments), own_number, curves);
}

SurfaceConstraint::~SurfaceConstraint() = default;

SurfaceConstraint::Home SurfaceConstraint::find_home(const Vec3& p, double reach) const {
    if (state_->curves.all && reach >= 0.0) {
        const auto found = state_->curves.all->closest(p);
        const std::uint32_t segment = found.item;
        if ((found.point - p).norm() <= reach) {
            for (const std::int64_t corner : state_->corners_of_segment[segment]) {
                if (corner >= 0 && (state_->corners[static_cast<std::size_t>(corner)] - p).norm() <= reach)
                    return {Kind::corner, static_cast<std::uint32_t>(corner), 0};
            }
            const auto& place = state_->curves.place[segment];
            return {Kind::curve, place.set, place.item};
        }
    }
    const auto& place = state_->regions.place[state_->regions.all->closest(p).item];
    return {Kind::region, place.set, place.item};
}

Vec3 SurfaceConstraint::project(const Vec3& p, Home& home) const {
    const auto closest = [&](const auto& set) {
        const auto found = set.closest(p, home.hint);
        home.hint = found.item;
        return found.point;
    };
    switch (home.kind) {
        case Kind::corner:
            return state_->corners[home.index];
        case Kind::curve:
            return closest(*state_->curves.sets[home.index]);
        case Kind::region:
            return closest(*state_->regions.sets[home.index]);
    }
    return p;
}

double SurfaceConstraint::diagonal() const {
    return state_->diagonal;
}

}  // namespace hex::improving
