// SPDX-License-Identifier: MIT
// Transfer between interfaces that do not match, by an octree search and the shape functions of the
// structure's faces; forces by the transpose, so that work is conserved. [PEREZ08, 6.1; FARHAT98]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/types.hpp"
#include "tunica/coupling/closest_point.hpp"
#include "tunica/mesh/patch_nodes.hpp"
#include "tunica/search/octree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace tunica::coupling {

struct OctreeOptions {
  double largest_gap = 0.5;  // [-] of the faces' mean diagonal; farther apart they are not one interface
};

/// u_f = H u_s, f_s = H^T f_f. A row of H holds the shape functions of the structure's face at the
/// point nearest to a fluid node, computed once, on the reference shape; rows sum to 1, so the sum
/// of the forces and the work f.u are the same on both sides to round-off.
template <class Face>
class Octree {
 public:
  /// Nodes of both meshes in their own numbering, 3 x n [m], and the faces of the two sides of the
  /// interface. MeshError with the place of the first fluid node that is too far from the structure.
  template <class FluidFace>
  Octree(const Points<3>& fluid_nodes, const mesh::Patch<FluidFace>& fluid_wall,
         const Points<3>& structure_nodes, const mesh::Patch<Face>& structure_wall,
         OctreeOptions options = {}) {
    const auto from = mesh::patch_nodes(structure_wall), to = mesh::patch_nodes(fluid_wall);
    structure_count_ = static_cast<Index>(from.size());
    const auto faces = static_cast<Index>(structure_wall.faces.cols());
    if (faces == 0) throw MeshError("transfer: the structure's side of the interface has no faces");
    const auto corners = [&](Index face) {
      FaceNodes<Face> x;
      for (int c = 0; c < Face::nodes; ++c) x.col(c) = structure_nodes.col(structure_wall.faces(c, face));
      return x;
    };
    std::vector<Box> boxes(static_cast<std::size_t>(faces));
    double diagonal = 0;  // [m]
    for (Index f = 0; f < faces; ++f) {
      Box& box = boxes[static_cast<std::size_t>(f)];
      const FaceNodes<Face> x = corners(f);
      for (int c = 0; c < Face::nodes; ++c) box.extend(Vec3(x.col(c)));
      diagonal += box.diagonal() / faces;
    }
    const search::Octree tree(boxes);
    slots_.resize(Face::nodes, static_cast<Eigen::Index>(to.size()));
    weights_.resize(Face::nodes, static_cast<Eigen::Index>(to.size()));
    for (std::size_t i = 0; i < to.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const Vec3 x = fluid_nodes.col(to[i]);
      const auto near =
          tree.nearest(x, [&](Index f) { return closest_point(Face{}, corners(f), x).squared_distance; });
      const auto point = closest_point(Face{}, corners(near.item), x);
      const double gap = std::sqrt(point.squared_distance);
      if (!(gap <= options.largest_gap * diagonal))
        throw MeshError("transfer: the fluid's wall node at " + place(x) + " lies " + seven_digits(gap) +
                        " away from the structure");
      if (gap > gap_) gap_ = gap, farthest_ = x;
      weights_.col(column) = point.weights;
      for (int c = 0; c < Face::nodes; ++c) {
        const auto at = std::lower_bound(from.begin(), from.end(), structure_wall.faces(c, near.item));
        slots_(c, column) = static_cast<Index>(at - from.begin());
      }
    }
  }

  /// H u: displacement of the structure's interface nodes (3 x n, ascending) -> of the fluid's [m].
  [[nodiscard]] Points<3> to_fluid(const Points<3>& structure) const {
    Points<3> fluid = Points<3>::Zero(3, slots_.cols());
    for (Eigen::Index f = 0; f < slots_.cols(); ++f)
      for (int c = 0; c < Face::nodes; ++c) fluid.col(f) += weights_(c, f) * structure.col(slots_(c, f));
    return fluid;
  }

  /// H^T f: nodal forces on the fluid's wall nodes (3 x n, ascending) -> on the structure's [N].
  [[nodiscard]] Points<3> to_structure(const Points<3>& fluid) const {
    Points<3> structure = Points<3>::Zero(3, structure_count_);
    for (Eigen::Index f = 0; f < slots_.cols(); ++f)
      for (int c = 0; c < Face::nodes; ++c) structure.col(slots_(c, f)) += weights_(c, f) * fluid.col(f);
    return structure;
  }

  /// The largest distance of a fluid node from the structure's surface [m]: what moments may err by,
  /// times the force.
  [[nodiscard]] double gap() const { return gap_; }
  /// The fluid node there [m].
  [[nodiscard]] const Vec3& farthest() const { return farthest_; }

 private:
  Index structure_count_ = 0;
  Connectivity<Face::nodes> slots_;                             // rows of the structure's displacement
  Eigen::Matrix<double, Face::nodes, Eigen::Dynamic> weights_;  // shape functions
  double gap_ = 0;                                              // [m]
  Vec3 farthest_ = Vec3::Zero();                                // [m]
};

}  // namespace tunica::coupling
