// SPDX-License-Identifier: MIT
// What boundary layers are asked for.
#pragma once

#include <string>
#include <vector>

namespace tunica::meshing {

/// Lengths in the unit of the surface.
struct LayerOptions {
  int layers = 5;
  double first = 0;     // height of the layer at the wall; 0: so that the last one is `last` high
  double growth = 1.2;  // of the height from layer to layer, outside in
  double last = 0.8;    // most height of a layer over the local edge length
  std::vector<std::string> regions{};  // that carry layers; empty: all that are not flat
  double room = 0.35;                  // most height of all layers over the way to the opposite wall
  double slope = 0.5;                  // most difference of height over the distance of neighbours
  int smoothing = 15;                  // sweeps over the directions
  double good = 0.15;       // least volume of a layer's tetrahedra over those of a right prism on its base
  double least_angle = 15;  // [degrees] of triangles between layers and core, or half of that on the wall
  double least = 0.1;       // height of all layers over the local edge below which a column vanishes
};

}  // namespace tunica::meshing
