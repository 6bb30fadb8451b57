// SPDX-License-Identifier: MIT
// A mesh with boundary layers, and what became of them.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/mesh/mesh.hpp"
#include "tunica/meshing/tetrahedra.hpp"

#include <vector>

namespace tunica::meshing {

/// Quality of one part of the mesh: angles in degrees; aspect: longest edge over least height.
struct LayerPart {
  Index tetrahedra = 0;
  double min_dihedral = 180, max_dihedral = 0;
  double mean_ratio = 0;
  double mean_aspect = 0, most_aspect = 0;
};

struct LayerReport {
  int layers = 0;
  Index columns = 0;                       // nodes of the wall above which layers grow
  Index vanished = 0;                      // nodes of the wall where they end: at curved neighbours, in folds
  Index blind = 0;                         // of those: no direction sees all triangles around the node
  double full_share = 0;                   // part of the columns with at least 0.99 of the height asked for
  double least_share = 1, mean_share = 0;  // height over that asked for
  Vec3 thinnest{0, 0, 0};                  // foot of the least column
  int rounds = 0;                          // of giving way
  LayerPart layer, core;
  FillReport fill;                      // of the core, and of the surface between it and the layers
  double volume = 0, volume_error = 0;  // error relative to the volume that the outer surface bounds
};

/// The mesh begins with the nodes of the surface as it was given: those of curved regions where they were,
/// those inside of flat ends moved inward within them. Then come the columns that end on flat ends, then the
/// other ones, each from the wall inward, then the nodes of the core. Tetrahedra of the layers come first.
struct [[nodiscard]] LayeredFill {
  mesh::TetMesh mesh;
  mesh::Surface outer;        // its border, with the regions of the surface; flat ends have the layers' sides
  mesh::Surface inner;        // between layers and core: node n is the end of the column above node n
  std::vector<Index> end;     // of the column above each node of the surface, its number in the mesh
  std::vector<double> share;  // height over that asked for at each node of the surface; 1 off the layers
  LayerReport report;
};

}  // namespace tunica::meshing
