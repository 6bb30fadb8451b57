// SPDX-License-Identifier: MIT
// The boundary faces of structured meshes as patches: all nodes of a face lie on one named side.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace tunica::meshing {

/// The faces of cells whose nodes all satisfy on(node), oriented outward, in the order of the cells.
/// Right wherever no inner face has all its nodes on the side: the caller knows that.
template <mesh::Cell C, class On>
[[nodiscard]] mesh::Patch<typename C::Face> faces_on(const mesh::Mesh<C>& mesh, std::string name, On&& on) {
  using Face = typename C::Face;
  std::vector<Index> list;
  for (Index c = 0; c < mesh.cell_count(); ++c)
    for (const auto& face : C::faces)
      if (std::all_of(face.begin(), face.end(), [&](int k) { return on(mesh.cells(k, c)); }))
        for (const int k : face) list.push_back(mesh.cells(k, c));
  const auto count = static_cast<Eigen::Index>(list.size()) / Face::nodes;
  return {std::move(name), Eigen::Map<const Connectivity<Face::nodes>>(list.data(), Face::nodes, count)};
}

}  // namespace tunica::meshing
