/// \file voxel_target.h
/// The topology that cells must reproduce, and which part of their boundary stands for which part of the
/// surface.
#pragma once

#include "polycube/voxel_cells.h"

#include <memory>

namespace hex::voxels {

/// Connected components of a closed surface with their Euler characteristics.
class Target {
  public:
    explicit Target(const TriangleMesh& surface);
    ~Target();
    Target(const Target&) = delete;
    Target& operator=(const Target&) = delete;

    std::size_t size() const { return components_.size(); }
    int euler(std::size_t component) const { return components_[component].euler; }
    const BoundingBox& box(std::size_t component) const { return components_[component].box; }
    /// The component nearest to a point.
    std::size_t nearest(const Vec3& p) const;

  private:
    struct Component {
        int euler = 0;
        BoundingBox box;
    };
    struct Search;
    std::vector<std::uint32_t> component_;  // of each triangle
    std::vector<Component> components_;
    std::unique_ptr<Search> search_;  // only where there is more than one component
};

/// Which component of the surface each component of the boundary stands for.
struct Correspondence {
    std::vector<int> component;  ///< of each boundary component; -1: none
    std::vector<int> boundary;   ///< of each surface component; -1: none
};

/// Every component of the boundary asks some of its faces for the nearest component of the surface; the one
/// with most faces gets it.
Correspondence correspond(const CellSet& cells, const Pieces& pieces, const Target& target);

}  // namespace hex::voxels
