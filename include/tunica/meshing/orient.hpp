// SPDX-License-Identifier: MIT
// Turns a surface whose normals point inward: the signed volume of a boundary is positive.
#pragma once

#include "tunica/mesh/measures.hpp"

namespace tunica::meshing {

/// Reverses all triangles when the enclosed volume is negative; true if it did. Triangles must agree with
/// their neighbours (mesh::topology: oriented).
inline bool orient_outward(mesh::Surface& s) {
  if (mesh::enclosed_volume(s) >= 0) return false;
  s.cells.row(1).swap(s.cells.row(2));
  return true;
}

}  // namespace tunica::meshing
