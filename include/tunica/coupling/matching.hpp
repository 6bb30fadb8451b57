// SPDX-License-Identifier: MIT
// Transfer between interfaces whose nodes coincide: a permutation, and no search tree. [PEREZ08, 6.1]
#pragma once

#include "tunica/core/error.hpp"
#include "tunica/core/text.hpp"
#include "tunica/core/types.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

namespace tunica::coupling {

/// Displacement and force between nodes that are the same points in two numberings.
class Matching {
 public:
  /// The two numberings are the same.
  Matching() = default;

  /// Pairs the nodes by their reference positions (3 x n each, [m]). MeshError with the place of
  /// the first node that has no partner within the tolerance [m].
  Matching(const Points<3>& fluid, const Points<3>& structure, double tolerance) {
    const auto n = static_cast<std::size_t>(structure.cols());
    if (fluid.cols() != structure.cols())
      throw MeshError("the interfaces do not match: " + std::to_string(fluid.cols()) + " fluid nodes, " +
                      std::to_string(n) + " structure nodes");
    std::vector<Index> by_x(n);
    std::iota(by_x.begin(), by_x.end(), Index{0});
    std::sort(by_x.begin(), by_x.end(), [&](Index a, Index b) {
      return structure(0, a) != structure(0, b) ? structure(0, a) < structure(0, b) : a < b;
    });
    std::vector<char> taken(n, 0);
    structure_of_.resize(n);
    for (Index f = 0; f < static_cast<Index>(n); ++f) {
      const Vec3 x = fluid.col(f);
      auto at = std::lower_bound(by_x.begin(), by_x.end(), x[0] - tolerance,
                                 [&](Index s, double bound) { return structure(0, s) < bound; });
      while (at != by_x.end() && structure(0, *at) <= x[0] + tolerance &&
             (taken[static_cast<std::size_t>(*at)] != 0 || (structure.col(*at) - x).norm() > tolerance))
        ++at;
      if (at == by_x.end() || structure(0, *at) > x[0] + tolerance)
        throw MeshError("the interfaces do not match: no structure node at " + place(x));
      structure_of_[static_cast<std::size_t>(f)] = *at;
      taken[static_cast<std::size_t>(*at)] = 1;
    }
  }

  /// Displacement of the structure's nodes -> of the fluid's, both 3 x n [m].
  [[nodiscard]] Points<3> to_fluid(const Points<3>& structure) const {
    if (structure_of_.empty()) return structure;
    Points<3> fluid(3, structure.cols());
    for (std::size_t f = 0; f < structure_of_.size(); ++f)
      fluid.col(static_cast<Eigen::Index>(f)) = structure.col(structure_of_[f]);
    return fluid;
  }

  /// Nodal forces on the fluid's nodes -> on the structure's, both 3 x n [N].
  [[nodiscard]] Points<3> to_structure(const Points<3>& fluid) const {
    if (structure_of_.empty()) return fluid;
    Points<3> structure(3, fluid.cols());
    for (std::size_t f = 0; f < structure_of_.size(); ++f)
      structure.col(structure_of_[f]) = fluid.col(static_cast<Eigen::Index>(f));
    return structure;
  }

 private:
  std::vector<Index> structure_of_;  // structure node of each fluid node; empty: the same numbering
};

}  // namespace tunica::coupling
