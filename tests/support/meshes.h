/// \file meshes.h
/// Small meshes that many tests want.
#pragma once

#include <hex/surface/polygon_soup.h>
#include <hex/volume/hex_mesh.h>

namespace hex::test {

/// nx x ny x nz unit cubes with the lower corner at the origin; vertex (i,j,k) has index i + (nx+1) (j +
/// (ny+1) k).
HexMesh grid(int nx, int ny, int nz);

/// The same grid with its cells in a random order, each turned by a random rotation of the cube.
/// Deterministic for a seed.
HexMesh shuffled_grid(int nx, int ny, int nz, unsigned seed);

/// `valence` prisms of hexahedra (each sector split off a regular polygon) around one interior edge, `layers`
/// high: the middle edges are extraordinary when valence != 4 and layers >= 1. Valence >= 3.
HexMesh fan(int valence, int layers);

/// Surface of the box [0,x] x [0,y] x [0,z]: 12 triangles, or n x n x 2 a side; part = 1..6 for +X -X +Y -Y
/// +Z -Z.
PolygonSoup box_surface(double x, double y, double z, int n = 1);

}  // namespace hex::test
