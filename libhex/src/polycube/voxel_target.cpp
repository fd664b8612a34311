#include "polycube/voxel_target.h"

#include <hex/surface/polygon_soup.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <map>

namespace hex::voxels {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

std::size_t index(TriangleMesh::FaceHandle f) {
    return static_cast<std::size_t>(f.idx());
}

Kernel::Triangle_3 triangle(const TriangleMesh& surface, TriangleMesh::FaceHandle f) {
    std::array<Kernel::Point_3, 3> p;
    std::size_t i = 0;
    for (const auto v : surface.fv_range(f)) {
        const auto& q = surface.point(v);
        p[i++] = Kernel::Point_3(q[0], q[1], q[2]);
    }
    return {p[0], p[1], p[2]};
}

}  // namespace

struct Target::Search {
    Triangles triangles;
    Tree tree;
};

Target::Target(const TriangleMesh& surface) {
    std::uint32_t count = 0;
    component_ = components_of(surface, count);
    components_.resize(count);
    const auto own = [&](TriangleMesh::FaceHandle f) -> Component& {
        return components_[component_[index(f)]];
    };
    std::vector<int> at_vertex(surface.n_vertices(), -1);
    for (const auto f : surface.faces()) {
        own(f).euler += 1;
        for (const auto v : surface.fv_range(f)) {
            at_vertex[static_cast<std::size_t>(v.idx())] = static_cast<int>(component_[index(f)]);
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
    for (const auto f : surface.faces()) search_->triangles.push_back(triangle(surface, f));
    search_->tree.insert(search_->triangles.cbegin(), search_->triangles.cend());
    search_->tree.build();
}

Target::~Target() = default;

std::size_t Target::nearest(const Vec3& p) const {
    if (!search_) return 0;
    const auto found = search_->tree.closest_point_and_primitive(Kernel::Point_3(p.x(), p.y(), p.z()));
    return component_[static_cast<std::size_t>(found.second - search_->triangles.cbegin())];
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

}  // namespace hex::voxels
