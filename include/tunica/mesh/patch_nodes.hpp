// SPDX-License-Identifier: MIT
// The nodes of a patch, in ascending order: the numbering of everything that lives on an interface.
#pragma once

#include "tunica/mesh/mesh.hpp"

#include <algorithm>
#include <vector>

namespace tunica::mesh {

/// Node numbers of the faces, each once, ascending.
template <class Faces>
[[nodiscard]] std::vector<Index> nodes_of_faces(const Faces& faces) {
  std::vector<Index> nodes(faces.data(), faces.data() + faces.size());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

template <class Face>
[[nodiscard]] std::vector<Index> patch_nodes(const Patch<Face>& patch) {
  return nodes_of_faces(patch.faces);
}

}  // namespace tunica::mesh
