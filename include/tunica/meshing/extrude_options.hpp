// SPDX-License-Identifier: MIT
// What an extrusion is asked for, and the ends of the sheet that it keeps flat.
#pragma once

#include "tunica/core/types.hpp"
#include "tunica/meshing/thickness.hpp"

#include <string>
#include <vector>

namespace tunica::meshing {

template <Thickness T = double>
struct ExtrudeOptions {
  T thickness;  // [unit of the nodes]; a number, or a function of the place
  int layers = 1;
  double good_quality =
      0.3;          // scaled Jacobian below which directions are smoothed and the thickness gives way
  int rounds = 80;  // of giving way at most
};

/// The nodes of one end of the sheet, run with the sheet on its left; they stay in the plane with that
/// normal.
struct SheetRim {
  std::string name;
  Vec3 normal;
  std::vector<Index> loop;
};

}  // namespace tunica::meshing
