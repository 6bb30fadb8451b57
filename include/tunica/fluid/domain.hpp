// SPDX-License-Identifier: MIT
// The discretisation of one position of the nodes, as the parts of a step see it.
#pragma once

#include "tunica/fem/assembly.hpp"
#include "tunica/fem/p1_tets.hpp"
#include "tunica/fluid/conditions.hpp"
#include "tunica/fluid/element.hpp"

namespace tunica::fluid {

using Pattern = fem::Assembly<mesh::Tet4, 1>;

struct Domain {
  const Pattern& pattern;
  const Connectivity<4>& cells;
  const fem::P1Tets& tets;
  const Points<3>& position;            // 3 x nodes [m]
  const Eigen::VectorXd& inverse_mass;  // 1 / M_L: nodes [1/m3]
  const Conditions& conditions;
};

}  // namespace tunica::fluid
