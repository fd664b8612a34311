/// \file patch_triangles.h
/// Which triangles and vertices each patch of a surface has, kept while patches are cut anew.
#pragma once

#include <array>
#include <vector>

namespace hex {

class PatchTriangles {
  public:
    using Triangles = std::vector<std::array<int, 3>>;

    /// `patch` is that of each triangle, 0, 1, 2...
    PatchTriangles(const Triangles& triangles, const std::vector<int>& patch);

    /// Of one patch, ascending.
    const std::vector<int>& triangles(int patch) const;

    /// Vertices of the patches that are not on the rim of all of them together, ascending.
    std::vector<int> inner_vertices(const std::vector<int>& patches) const;

    /// The patch has these triangles from now on, named by their places in `all`, ascending.
    void replace(int patch, std::vector<int> triangles, const Triangles& all);

  private:
    using Edge = std::array<int, 2>;

    struct Patch {
        std::vector<int> triangles;
        std::vector<int> vertices;  ///< ascending
        std::vector<Edge> rim;      ///< edges without those between two of the triangles
    };
    std::vector<Patch> patches_;
};

}  // namespace hex
